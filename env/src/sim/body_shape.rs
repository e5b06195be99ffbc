//! Converts objects' colliders to shapes of the physics engine.

use rapier3d::prelude::*;

use crate::assets::ColliderShape;
use crate::scene::Item;

/// The shape of an object's collider, and its pose in the object's frame: on the ground, facing +y.
pub(super) fn body_shape(item: &Item) -> (SharedShape, Pose) {
    let scale = item.scale;
    let scaled = |metres: f32| (metres * scale).max(0.005);
    let (shape, height, tilt) = match &item.body.collider {
        ColliderShape::Box { half } => {
            let [x, y, z] = half.map(scaled);
            (SharedShape::cuboid(x, y, z), z, 0.0)
        }
        ColliderShape::Ball { radius } => (SharedShape::ball(scaled(*radius)), scaled(*radius), 0.0),
        ColliderShape::Cylinder { radius, half_height } => {
            // The engine's cylinders lie along y.
            let (radius, half) = (scaled(*radius), scaled(*half_height));
            (SharedShape::cylinder(half, radius), half, std::f32::consts::FRAC_PI_2)
        }
        ColliderShape::Capsule { radius, half_height } => {
            let (radius, half) = (scaled(*radius), (half_height * scale).max(0.0));
            (SharedShape::capsule_z(half, radius), half + radius, 0.0)
        }
        ColliderShape::Hull { points } => {
            let corners: Vec<Vector> = points
                .iter()
                .map(|point| Vector::new(point[0], point[1], point[2]) * scale)
                .collect();
            if let Some(shape) = SharedShape::convex_hull(&corners) {
                (shape, 0.0, 0.0)
            } else {
                // Coplanar points have no volume, so they get their bounding cylinder.
                let (radius, half) = (scaled(item.body.collider.radius()), scaled(item.body.height / 2.0));
                (SharedShape::cylinder(half, radius), half, std::f32::consts::FRAC_PI_2)
            }
        }
    };
    let from_ground = Pose::new(Vector::new(0.0, 0.0, height), Vector::new(tilt, 0.0, 0.0));
    (shape, from_ground)
}

/// Whether a body's shape depends on its heading, which is false for round ones.
pub(super) fn shows_heading(shape: &SharedShape) -> bool {
    matches!(shape.shape_type(), ShapeType::Cuboid | ShapeType::ConvexPolyhedron)
}

/// The axis-aligned bounding box of a shape. For cylinders and hulls, the engine computes six support points. A formula and a
/// single pass over the corners are faster.
pub(super) fn bounding_box(shape: &dyn Shape, pose: &Pose) -> Aabb {
    match shape.as_typed_shape() {
        TypedShape::Cylinder(cylinder) => {
            let [x, axis, z] = [Vector::X, Vector::Y, Vector::Z].map(|side| pose.rotation * side);
            let half = axis.abs() * cylinder.half_height + (x * x + z * z).map(f32::sqrt) * cylinder.radius;
            Aabb::new(pose.translation - half, pose.translation + half)
        }
        TypedShape::ConvexPolyhedron(hull) => {
            let corners = hull.points().iter().map(|corner| pose.rotation * *corner);
            let [low, high] = corners.fold([Vector::INFINITY, Vector::NEG_INFINITY], |[low, high], corner| {
                [low.min(corner), high.max(corner)]
            });
            Aabb::new(pose.translation + low, pose.translation + high)
        }
        _ => shape.compute_aabb(pose),
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use proptest::prelude::*;

    proptest! {
        #![proptest_config(ProptestConfig::with_cases(crate::tier::quick_or_full(24, 256)))]

        #[test]
        fn bounding_box_matches_the_engine(
            at in prop::array::uniform3(-300.0_f32..300.0), heading in -7.0_f32..7.0, tilt in -2.0_f32..2.0,
            [radius, half] in [0.005_f32..9.0, 0.005_f32..9.0],
            corners in prop::collection::vec(prop::array::uniform3(-9.0_f32..9.0), 4..24),
        ) {
            let corners: Vec<Vector> = corners.into_iter().map(Vector::from).collect();
            let turned = Pose::new(Vector::from(at), Vector::new(0.0, 0.0, heading));
            let upright = Pose::new(Vector::from(at), Vector::new(std::f32::consts::FRAC_PI_2, 0.0, 0.0));
            let tilted = Pose::new(Vector::from(at), Vector::new(tilt, heading, 0.3));
            let shapes = [Some(SharedShape::cylinder(half, radius)), SharedShape::convex_hull(&corners), Some(SharedShape::ball(radius))];
            for shape in shapes.into_iter().flatten() {
                for pose in [turned, upright, tilted] {
                    let (ours, engines) = (bounding_box(&*shape, &pose), shape.compute_aabb(&pose));
                    for (ours, engines) in [(ours.mins, engines.mins), (ours.maxs, engines.maxs)] {
                        prop_assert!((ours - engines).abs().max_element() < 2e-4, "{} instead of {}", ours, engines);
                    }
                }
            }
        }
    }
}
