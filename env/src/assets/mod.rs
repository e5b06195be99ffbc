//! Meshes and colliders of objects, from built-in model files or libraries.

mod blocks;
mod builtin;
mod catalogue;
#[cfg(feature = "gltf")]
mod import;
mod letters;
mod library;
mod mesh;
mod model_file;
mod signs;

use std::borrow::Cow;
use std::collections::HashMap;
use std::sync::{Arc, LazyLock, Mutex, PoisonError};

use driftworld_spec::{Model, Style};
use serde::Deserialize;

pub(crate) use blocks::{BLOCK, Block, Material};
pub use catalogue::{Catalogue, FIRST_LIBRARY_CLASS, UNKNOWN_CLASS};
#[cfg(feature = "gltf")]
pub use import::{
    ImportOptions, ImportSize, ImportWarning, Imported, MAX_IMPORT_BYTES, MAX_IMPORT_DEPTH, MAX_IMPORT_NODES,
    MAX_TEXTURE_SIDE, ReadBeside,
};
pub use library::{
    Library, LibraryModel, MAX_LIBRARY_MODELS, MAX_MODEL_LEVELS, MAX_MODEL_PARTS, MAX_MODEL_REACH, MAX_MODEL_TRIANGLES,
    MAX_MODEL_VERTICES, MAX_NAME_BYTES,
};
pub use mesh::Mesh;
pub(crate) use signs::Lettering;

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
    levels: Vec<Level>,
}

/// One level of detail of an asset, ready to be drawn.
#[derive(Clone, Debug)]
struct Level {
    /// Largest distance of the surface from the full model's, in metres at scale 1.
    error: f32,
    num_triangles: usize,
    materials: Vec<Material>,
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

    /// Number of triangles of each level of detail, and its largest error in metres at scale 1: from the full model to the coarsest.
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
    /// An upright cylinder with a half ball at each end, standing on the lower one.
    Capsule {
        /// Radius.
        radius: f32,
        /// Half of the height between the centres of the half balls.
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

/// The built-in asset of a class and model, built once and shared. Unknown ones get a placeholder.
pub fn asset(class: &str, model: &Model) -> Arc<Asset> {
    asset_in(Style::Plain, class, model)
}

/// The built-in asset of a class and model in a style. The collider is the same in all styles, so that a style changes only the
/// look.
pub fn asset_in(style: Style, class: &str, model: &Model) -> Arc<Asset> {
    let class = lowercase(class);
    let found = builtin::number(&class, model).and_then(|number| builtin::asset(style, &class, number));
    found.unwrap_or_else(builtin::placeholder)
}

/// Lowercases a class name; copies only if needed.
pub(crate) fn lowercase(class: &str) -> Cow<'_, str> {
    let is_ascii_lowercase = |byte: u8| byte.is_ascii() && !byte.is_ascii_uppercase();
    if class.bytes().all(is_ascii_lowercase) {
        Cow::Borrowed(class)
    } else {
        Cow::Owned(class.to_lowercase())
    }
}

/// The built-in sign number `model` with text, built on first use and cached.
pub(crate) fn sign(model: u32, text: &str, lettering: Lettering) -> Arc<Asset> {
    type Cache = HashMap<(u32, String, Lettering), Arc<Asset>>;
    static CACHE: LazyLock<Mutex<Cache>> = LazyLock::new(Mutex::default);
    // The cache stays valid after a panic: only finished assets are inserted.
    let mut cache = CACHE.lock().unwrap_or_else(PoisonError::into_inner);
    let key = (model, text.to_owned(), lettering);
    if let Some(asset) = cache.get(&key) {
        return Arc::clone(asset);
    }
    // Bounds the memory if new texts keep coming; assets in use stay alive.
    if cache.len() >= MAX_CACHED_SIGNS {
        cache.clear();
    }
    let bare = builtin::asset(Style::Plain, "sign", model).unwrap_or_else(builtin::placeholder);
    let asset = Arc::new(signs::sign(&bare, model, text, lettering));
    cache.insert(key, Arc::clone(&asset));
    asset
}

/// Maximum number of signs in the cache.
const MAX_CACHED_SIGNS: usize = 256;

/// The built-in classes, each with its number of models, ordered by number in class segmentation.
pub fn classes() -> impl Iterator<Item = (&'static str, u32)> {
    builtin::class_names().map(|class| (class, builtin::model_names(class).count() as u32))
}

/// The models of a built-in class, ordered by number: their names if they have any, otherwise their numbers. Empty if the class
/// is not built in.
///
/// # Example
/// ```
/// use driftworld_env::{asset, model_names};
/// use driftworld_spec::Model;
/// assert_eq!(model_names("table").collect::<Vec<_>>(), ["1", "2", "3"]);
/// let animals: Vec<String> = model_names("animal").collect();
/// assert_eq!((animals[0].as_str(), animals[6].as_str()), ("rabbit", "wolf"));
/// // Worlds may use names or numbers.
/// assert_eq!(asset("animal", &Model("7".into())).height, asset("animal", &Model("wolf".into())).height);
/// ```
pub fn model_names(class: &str) -> impl Iterator<Item = String> {
    builtin::model_names(class).map(str::to_owned)
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
