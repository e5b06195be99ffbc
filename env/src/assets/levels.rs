//! Levels of detail of what is made by code: the same thing made finely and coarsely, and how far the two are apart. Those of
//! libraries are simplified where they are imported.

use super::{Asset, Builder, ColliderShape, Part};
use crate::vector::{add, cross, dot, scaled, sub};

/// An asset of two forms of one thing; the coarse one is drawn where it is off by less than half a pixel. It has no body yet.
pub(crate) fn levelled(fine: Builder, coarse: Builder) -> Asset {
    let (fine, coarse) = (on_the_ground(fine), on_the_ground(coarse));
    let error = deviation(&fine, &coarse).max(deviation(&coarse, &fine));
    let collider = ColliderShape::Ball { radius: 0.01 };
    Asset::of_levels(vec![(0.0, fine), (error, coarse)], collider)
}

/// The parts, without what would be below the ground.
fn on_the_ground(built: Builder) -> Vec<Part> {
    let parts = built.into_parts().into_iter().map(|Part { mut mesh, paint, .. }| {
        mesh.corners
            .iter_mut()
            .for_each(|corner| corner[2] = corner[2].max(0.0));
        Part::new(mesh, paint)
    });
    parts.collect()
}

/// How far the corners of some parts, and the middles of their triangles, lie from the surface of others at most, in metres.
pub(crate) fn deviation(from: &[Part], to: &[Part]) -> f32 {
    let surface: Vec<[[f32; 3]; 3]> = to.iter().flat_map(triangles).collect();
    let points = from.iter().flat_map(triangles).flat_map(|[a, b, c]| {
        let middle = scaled(add(add(a, b), c), 1.0 / 3.0);
        [a, b, c, middle]
    });
    let squared = points.fold(0.0_f32, |most, point| {
        let nearest = surface.iter().fold(f32::INFINITY, |least, triangle| {
            // Once it is nearer than the farthest so far, the point decides nothing.
            if least <= most {
                least
            } else {
                least.min(squared_distance(point, *triangle))
            }
        });
        most.max(nearest)
    });
    squared.sqrt()
}

fn triangles(part: &Part) -> impl Iterator<Item = [[f32; 3]; 3]> {
    let corners = &part.mesh.corners;
    part.mesh
        .triangles
        .iter()
        .map(|triangle| triangle.map(|corner| corners[corner as usize]))
}

/// The square of a point's distance from a triangle: from its plane where the point is above it, else from its edges.
fn squared_distance(point: [f32; 3], [a, b, c]: [[f32; 3]; 3]) -> f32 {
    let normal = cross(sub(b, a), sub(c, a));
    let area = dot(normal, normal);
    let edges = [(a, b), (b, c), (c, a)];
    let is_above = |(from, to): (_, _)| dot(cross(sub(to, from), sub(point, from)), normal) >= 0.0;
    if area > 0.0 && edges.into_iter().all(is_above) {
        let height = dot(sub(point, a), normal);
        return height * height / area;
    }
    let from_edge = |(from, to): ([f32; 3], [f32; 3])| {
        let along = sub(to, from);
        let length = dot(along, along);
        let share = if length > 0.0 {
            (dot(sub(point, from), along) / length).clamp(0.0, 1.0)
        } else {
            0.0
        };
        let apart = sub(point, add(from, scaled(along, share)));
        dot(apart, apart)
    };
    edges.into_iter().map(from_edge).fold(f32::INFINITY, f32::min)
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::assets::{Mesh, Paint};

    fn part(mesh: Mesh) -> [Part; 1] {
        [Part::new(mesh, Paint::Fixed([0.5; 3]))]
    }

    #[test]
    fn distances_from_a_triangle_are_those_from_its_face_its_edges_and_its_corners() {
        let triangle = [[0.0, 0.0, 0.0], [2.0, 0.0, 0.0], [0.0, 2.0, 0.0]];
        for (point, expected) in [
            ([0.5, 0.5, 3.0], 9.0),
            ([0.5, 0.5, -3.0], 9.0),
            ([1.0, -2.0, 0.0], 4.0),
            ([2.0, 2.0, 0.0], 2.0),
            ([-3.0, -4.0, 0.0], 25.0),
        ] {
            let found = squared_distance(point, triangle);
            assert!((found - expected).abs() < 1e-5, "{point:?}: {found}");
        }
        let flat = [[0.0; 3], [1.0, 0.0, 0.0], [2.0, 0.0, 0.0]];
        assert_eq!(squared_distance([1.0, 3.0, 0.0], flat), 9.0);
    }

    #[test]
    fn a_box_in_a_box_is_as_far_off_as_its_corners() {
        let (small, large) = (part(Mesh::cuboid([1.0; 3], 0.5)), part(Mesh::cuboid([2.0; 3], 0.0)));
        assert_eq!(deviation(&small, &small), 0.0);
        // From a corner of the large box to the nearest of the small one; from any point of the small one to a face.
        assert!((deviation(&large, &small) - 0.75_f32.sqrt()).abs() < 1e-5);
        assert!((deviation(&small, &large) - 0.5).abs() < 1e-5);
    }
}
