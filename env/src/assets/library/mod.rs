//! [`Library`]: models made elsewhere, ready to be drawn. How they are written down is in `bytes.rs`; how they are made
//! from glTF files is in `import`.

mod bytes;
mod model;
mod reader;

#[cfg(any(feature = "gltf", test))]
pub(crate) use model::Detail;
pub use model::LibraryModel;
pub(crate) use model::MAX_HULL_POINTS;

use std::collections::BTreeSet;

use crate::EnvError;
use crate::assets::catalogue::key;

/// The most models of a library.
pub const MAX_LIBRARY_MODELS: usize = 10_000;

/// The most corners of a model, all parts together.
pub const MAX_MODEL_VERTICES: usize = 1_000_000;

/// The most triangles of a model, both sides of two-sided ones counted.
pub const MAX_MODEL_TRIANGLES: usize = 1_000_000;

/// The most colours of a model.
pub const MAX_MODEL_PARTS: usize = 256;

/// The most levels of detail of a model, the full one among them.
pub const MAX_MODEL_LEVELS: usize = 4;

/// The furthest that a model may reach from its origin, along each axis in metres.
pub const MAX_MODEL_REACH: f32 = 1000.0;

/// The most letters of a class or of a model's name, in bytes of UTF-8.
pub const MAX_NAME_BYTES: usize = 200;

/// Models that worlds may refer to by class and name, beside the built-in ones; see [`Catalogue`](crate::Catalogue).
#[derive(Clone, Debug, Default, PartialEq)]
pub struct Library {
    models: Vec<LibraryModel>,
    /// Class and name of each model, as they are looked up.
    keys: BTreeSet<(String, String)>,
}

impl Library {
    /// Adds a model.
    ///
    /// # Errors
    /// [`EnvError::BadModel`] if the library has a model of that class and name, or [`MAX_LIBRARY_MODELS`] of them.
    pub fn insert(&mut self, model: LibraryModel) -> Result<(), EnvError> {
        let refuse = |found: &str, expected: &str| {
            Err(EnvError::BadModel {
                place: format!("class {:?}, model {:?}", model.class, model.name),
                found: found.to_owned(),
                expected: expected.to_owned(),
            })
        };
        if self.models.len() >= MAX_LIBRARY_MODELS {
            let found = format!("a library of {MAX_LIBRARY_MODELS} models");
            return refuse(&found, "fewer; begin another library");
        }
        if !self.keys.insert(key(&model.class, &model.name)) {
            let expected = "each class and model once; give another class or model";
            return refuse("one in the library already", expected);
        }
        self.models.push(model);
        Ok(())
    }

    /// The models in the order they were added in.
    pub fn models(&self) -> &[LibraryModel] {
        &self.models
    }
}
