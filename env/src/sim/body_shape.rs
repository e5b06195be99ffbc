//! Objects' bodies as shapes of the physics engine. What they cover of the ground is in `outline.rs`.

use rapier3d::prelude::*;

use crate::assets::ColliderShape;
use crate::scene::Item;

/// The shape of an object's body, and where it is in the object's frame: on the ground, facing +y.
pub(super) fn body_shape(item: &Item) -> (SharedShape, Pose) {
    let scale = item.scale;
    let least = |metres: f32| (metres * scale).max(0.005);
    let (shape, height, tilt) = match &item.body.collider {
        ColliderShape::Box { half } => {
            let [x, y, z] = half.map(least);
            (SharedShape::cuboid(x, y, z), z, 0.0)
        }
        ColliderShape::Ball { radius } => (SharedShape::ball(least(*radius)), least(*radius), 0.0),
        ColliderShape::Cylinder { radius, half_height } => {
            // The engine's cylinders lie along y.
            let (radius, half) = (least(*radius), least(*half_height));
            (SharedShape::cylinder(half, radius), half, std::f32::consts::FRAC_PI_2)
        }
        ColliderShape::Capsule { radius, half_height } => {
            let (radius, half) = (least(*radius), (half_height * scale).max(0.0));
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
                // Points in one plane hold nothing: the cylinder around them.
                let (radius, half) = (least(item.body.collider.radius()), least(item.body.height / 2.0));
                (SharedShape::cylinder(half, radius), half, std::f32::consts::FRAC_PI_2)
            }
        }
    };
    let from_ground = Pose::new(Vector::new(0.0, 0.0, height), Vector::new(tilt, 0.0, 0.0));
    (shape, from_ground)
}

/// Whether a body shows where it faces: round ones do not.
pub(super) fn shows_heading(shape: &SharedShape) -> bool {
    matches!(shape.shape_type(), ShapeType::Cuboid | ShapeType::ConvexPolyhedron)
}
