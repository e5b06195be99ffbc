//! Fits a simple collider to a model.

use std::f32::consts::PI;

use super::surface::Surface;
use crate::assets::{ColliderKind, ColliderShape};

/// Only the part of a model below this height, in metres, determines its collider's width: agents cannot bump into a tree's
/// crown.
const MAX_WIDTH_HEIGHT: f32 = 2.0;

/// Minimum half size of a collider in metres, so that flat sheets have one.
const MIN_HALF_SIZE: f32 = 0.01;

/// Extents of a model around its vertical axis.
struct Extent {
    half: [f32; 2],
    radius: f32,
    height: f32,
}

impl ColliderKind {
    pub(super) fn fit(self, surface: &Surface) -> ColliderShape {
        let extent = Extent::of(surface);
        let (radius, half_height) = (extent.radius, extent.height / 2.0);
        match self {
            Self::Auto if extent.is_round(surface) => ColliderShape::Ball { radius: half_height },
            Self::Auto => {
                let [x, y] = extent.half;
                let kind = if PI * radius * radius < 4.0 * x * y {
                    Self::Cylinder
                } else {
                    Self::Box
                };
                kind.fit(surface)
            }
            Self::Box => ColliderShape::Box {
                half: [extent.half[0], extent.half[1], half_height],
            },
            Self::Ball => ColliderShape::Ball { radius: half_height },
            Self::Cylinder => ColliderShape::Cylinder { radius, half_height },
            Self::Capsule => {
                let radius = radius.min(half_height);
                let half_height = (half_height - radius).max(MIN_HALF_SIZE);
                ColliderShape::Capsule { radius, half_height }
            }
            Self::Hull => hull(surface).unwrap_or_else(|| Self::Box.fit(surface)),
        }
    }
}

impl Extent {
    fn of(surface: &Surface) -> Self {
        let mut extent = Self {
            half: [MIN_HALF_SIZE; 2],
            radius: MIN_HALF_SIZE,
            height: 2.0 * MIN_HALF_SIZE,
        };
        for face in &surface.faces {
            let corners = face.corners.map(|corner| surface.corners[corner as usize]);
            for k in 0..3 {
                let (a, b) = (corners[k], corners[(k + 1) % 3]);
                extent.height = extent.height.max(a[2]);
                if a[2] <= MAX_WIDTH_HEIGHT {
                    extent.include([a[0], a[1]]);
                }
                // Where an edge crosses the height limit.
                if (a[2] <= MAX_WIDTH_HEIGHT) != (b[2] <= MAX_WIDTH_HEIGHT) {
                    let share = (MAX_WIDTH_HEIGHT - a[2]) / (b[2] - a[2]);
                    extent.include([0, 1].map(|axis| a[axis] + (b[axis] - a[axis]) * share));
                }
            }
        }
        extent
    }

    fn include(&mut self, [x, y]: [f32; 2]) {
        self.half = [self.half[0].max(x.abs()), self.half[1].max(y.abs())];
        self.radius = self.radius.max((x * x + y * y).sqrt());
    }

    /// Whether the model is about as wide and deep as it is high, with no corner far outside the ball of that height.
    fn is_round(&self, surface: &Surface) -> bool {
        let ball = self.height / 2.0;
        let near = |metres: f32| (metres - ball).abs() < 0.1 * ball;
        let inside = |[x, y, z]: [f32; 3]| x * x + y * y + (z - ball) * (z - ball) < 1.1 * ball * ball;
        let corners = || surface.faces.iter().flat_map(|face| face.corners);
        near(self.half[0]) && near(self.half[1]) && corners().all(|corner| inside(surface.corners[corner as usize]))
    }
}

/// The farthest corners in 64 evenly spread directions; `None` if they are nearly coplanar.
fn hull(surface: &Surface) -> Option<ColliderShape> {
    /// The golden angle between neighbours on the spiral, in radians.
    const GOLDEN_ANGLE: f32 = 2.399_963_2;
    const DIRECTIONS: usize = super::super::library::MAX_HULL_POINTS;
    let mut chosen: Vec<u32> = Vec::new();
    let mut thinnest = f32::INFINITY;
    for k in 0..DIRECTIONS {
        let z = 1.0 - (2.0 * k as f32 + 1.0) / DIRECTIONS as f32;
        let (across, angle) = ((1.0 - z * z).sqrt(), GOLDEN_ANGLE * k as f32);
        let direction = [across * libm::cosf(angle), across * libm::sinf(angle), z];
        let along = |corner: u32| -> f32 {
            let at = surface.corners[corner as usize];
            (0..3).map(|axis| at[axis] * direction[axis]).sum()
        };
        let corners = || surface.faces.iter().flat_map(|face| face.corners);
        let furthest = corners().max_by(|a, b| along(*a).total_cmp(&along(*b)))?;
        let nearest = corners().min_by(|a, b| along(*a).total_cmp(&along(*b)))?;
        thinnest = thinnest.min(along(furthest) - along(nearest));
        chosen.push(furthest);
    }
    let mut points: Vec<[f32; 3]> = chosen.iter().map(|corner| surface.corners[*corner as usize]).collect();
    points.sort_by(|a, b| {
        a[0].total_cmp(&b[0])
            .then(a[1].total_cmp(&b[1]))
            .then(a[2].total_cmp(&b[2]))
    });
    points.dedup();
    (thinnest > MIN_HALF_SIZE && points.len() >= 4).then_some(ColliderShape::Hull { points })
}

#[cfg(test)]
mod tests {
    use super::super::surface::Face;
    use super::*;
    use crate::assets::Mesh;

    fn surface(mesh: &Mesh) -> Surface {
        let faces = mesh.triangles.iter().map(|corners| Face {
            corners: *corners,
            material: None,
            two_sided: false,
            color: [0.5; 3],
        });
        let mut surface = Surface::default();
        surface.corners.clone_from(&mesh.corners);
        surface.faces.extend(faces);
        surface
    }

    #[track_caller]
    fn check(mesh: &Mesh, kind: ColliderKind, expected: &str) {
        let found = format!("{:.2?}", kind.fit(&surface(mesh)));
        assert_eq!(found, expected);
    }

    #[test]
    fn collider_follows_the_models_shape() {
        let auto = ColliderKind::Auto;
        check(
            &Mesh::cuboid([1.0, 2.0, 3.0], 0.0),
            auto,
            "Box { half: [0.50, 1.00, 1.50] }",
        );
        check(
            &Mesh::cylinder(0.5, 0.0, 3.0, 24),
            auto,
            "Cylinder { radius: 0.50, half_height: 1.50 }",
        );
        check(&Mesh::ball(0.5, 0.5, 16, 12), auto, "Ball { radius: 0.50 }");
        check(
            &Mesh::cylinder(0.5, 0.0, 3.0, 24),
            ColliderKind::Capsule,
            "Capsule { radius: 0.50, half_height: 1.00 }",
        );
    }

    #[test]
    fn crown_above_the_head_does_not_widen_the_collider() {
        let tree = Mesh::cylinder(0.2, 0.0, 3.0, 12).with(&Mesh::ball(2.0, 5.0, 12, 8));
        check(
            &tree,
            ColliderKind::Auto,
            "Cylinder { radius: 0.20, half_height: 3.50 }",
        );
    }

    #[test]
    fn hull_of_a_box_has_its_corners_and_a_sheet_has_no_hull() {
        let ColliderShape::Hull { points } = ColliderKind::Hull.fit(&surface(&Mesh::cuboid([1.0, 1.0, 1.0], 0.0)))
        else {
            panic!("a box has a hull");
        };
        assert_eq!(points.len(), 8);
        let sheet = Mesh {
            corners: vec![[-1.0, 0.0, 0.0], [1.0, 0.0, 0.0], [0.0, 0.0, 1.0]],
            triangles: vec![[0, 1, 2]],
        };
        check(&sheet, ColliderKind::Hull, "Box { half: [1.00, 0.01, 0.50] }");
    }
}
