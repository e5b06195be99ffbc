//! [`Asset`]: the coloured meshes and the collider of one model, with its levels of detail.

use serde::Deserialize;

use super::blocks::Material;
use super::mesh::Mesh;
use crate::vector::{cross, dot, sub};

/// The look and the collider of one model, at scale 1.
#[derive(Clone, Debug)]
pub struct Asset {
    /// The coloured meshes.
    pub parts: Vec<Part>,
    /// The collider; it stands on the ground, centred above the object's coordinates.
    pub collider: ColliderShape,
    /// Height in metres.
    pub height: f32,
    /// Largest distance of any corner from the vertical axis in metres.
    pub radius: f32,
    /// Whether class and model are known; otherwise this is the placeholder.
    pub known: bool,
    /// Levels of detail, from the full model to the coarsest.
    pub(super) levels: Vec<Level>,
}

/// One level of detail of an asset, ready to be drawn.
#[derive(Clone, Debug)]
pub(super) struct Level {
    /// Largest distance of the surface from the full model's, in metres at scale 1.
    pub(super) error: f32,
    num_triangles: usize,
    pub(super) materials: Vec<Material>,
}

impl Asset {
    /// The coarsest level whose error is at most `error` metres at scale 1.
    pub(crate) fn level(&self, error: f32) -> &[Material] {
        let accurate = self.levels.iter().rev().find(|level| level.error <= error);
        accurate.or(self.levels.first()).map_or(&[], |level| &level.materials)
    }

    /// An asset with these levels of detail, each with its error in metres; the first is the full model.
    pub(crate) fn of_levels(levels: Vec<(f32, Vec<Part>)>, collider: ColliderShape) -> Self {
        let drawable = levels.iter().map(|(error, parts)| Level {
            error: *error,
            num_triangles: parts.iter().map(|part| part.mesh.triangles.len()).sum(),
            materials: parts.iter().map(Material::new).collect(),
        });
        let drawable = drawable.collect();
        let parts = levels.into_iter().next().map_or_else(Vec::new, |(_, parts)| parts);
        let corners = || parts.iter().flat_map(|part| &part.mesh.corners);
        Self {
            collider,
            height: corners().fold(0.01_f32, |max, corner| max.max(corner[2])),
            radius: reach(corners()).max(0.01),
            known: true,
            levels: drawable,
            parts,
        }
    }

    /// Number of triangles of each level of detail, and its largest error in metres at scale 1; the full model comes first.
    pub fn levels(&self) -> impl Iterator<Item = (usize, f32)> {
        self.levels.iter().map(|level| (level.num_triangles, level.error))
    }

    /// All levels from which [`Asset::level`] chooses.
    #[cfg(feature = "gpu")]
    pub(crate) fn materials_of_levels(&self) -> impl Iterator<Item = &[Material]> {
        self.levels.iter().map(|level| level.materials.as_slice())
    }

    /// Radius of the bounding ball around the middle of the asset's height, in metres at scale 1.
    pub(crate) fn ball_radius(&self) -> f32 {
        let half = self.height / 2.0;
        (self.radius * self.radius + half * half).sqrt()
    }
}

/// A mesh of one colour.
#[derive(Clone, Debug)]
pub struct Part {
    /// Its shape.
    pub mesh: Mesh,
    /// Its colour.
    pub paint: Paint,
    /// One normal of length 1 for each triangle.
    pub normals: Vec<[f32; 3]>,
}

/// A part's colour (sRGB).
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum Paint {
    /// The object's colour; this one if the object has none.
    Main([f32; 3]),
    /// Always this colour.
    Fixed([f32; 3]),
}

impl Part {
    pub(crate) fn new(mesh: Mesh, paint: Paint) -> Self {
        let normal = |triangle: &[u32; 3]| {
            let [a, b, c] = triangle.map(|corner| mesh.corners[corner as usize]);
            let upright = cross(sub(b, a), sub(c, a));
            let length = dot(upright, upright).sqrt();
            if length > 0.0 {
                upright.map(|part| part / length)
            } else {
                [0.0, 0.0, 1.0]
            }
        };
        let normals = mesh.triangles.iter().map(normal).collect();
        Self { mesh, paint, normals }
    }
}

/// Which collider an imported model gets.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Deserialize)]
#[serde(rename_all = "snake_case")]
pub enum ColliderKind {
    /// A ball for models that are round on all sides, otherwise the smaller of box and cylinder.
    #[default]
    Auto,
    /// The box around the part below 2 m, as high as the model.
    Box,
    /// A ball as high as the model.
    Ball,
    /// The upright cylinder around the part below 2 m, as high as the model.
    Cylinder,
    /// Like the cylinder, with round ends.
    Capsule,
    /// An approximate convex hull of the whole model, with at most 64 points.
    Hull,
}

/// The shape of a body, in metres at scale 1.
#[derive(Clone, Debug, PartialEq, Deserialize, strum::IntoStaticStr)]
#[serde(rename_all = "snake_case")]
#[strum(serialize_all = "lowercase")]
pub enum ColliderShape {
    /// A box with these half sides.
    Box {
        /// Half width, half depth, half height.
        half: [f32; 3],
    },
    /// A ball that rests on the ground.
    Ball {
        /// Radius.
        radius: f32,
    },
    /// An upright cylinder.
    Cylinder {
        /// Radius.
        radius: f32,
        /// Half of the height.
        half_height: f32,
    },
    /// An upright cylinder with a hemisphere at each end, standing on the lower one.
    Capsule {
        /// Radius.
        radius: f32,
        /// Half of the height between the centres of the hemispheres.
        half_height: f32,
    },
    /// The convex hull of these points, in the asset's frame.
    Hull {
        /// x, y, z of each point.
        points: Vec<[f32; 3]>,
    },
}

impl ColliderShape {
    /// Largest distance of the shape from its vertical axis in metres at scale 1.
    pub fn radius(&self) -> f32 {
        match self {
            Self::Box { half: [x, y, _] } => (x * x + y * y).sqrt(),
            Self::Ball { radius } | Self::Cylinder { radius, .. } | Self::Capsule { radius, .. } => *radius,
            Self::Hull { points } => reach(points.iter()),
        }
    }
}

/// Largest distance of points from the vertical axis.
fn reach<'a>(points: impl Iterator<Item = &'a [f32; 3]>) -> f32 {
    points.fold(0.0, |max, [x, y, _]| max.max((x * x + y * y).sqrt()))
}
