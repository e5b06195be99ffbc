//! [`Library`]: a collection of imported models, ready to be drawn.

mod bytes;
mod model;
mod reader;

#[cfg(any(feature = "gltf", test))]
pub(crate) use model::Detail;
pub use model::LibraryModel;
pub(crate) use model::MAX_HULL_POINTS;

use std::collections::BTreeSet;

use crate::EnvError;

/// Maximum number of models in a library.
pub const MAX_LIBRARY_MODELS: usize = 10_000;

/// Maximum number of corners of a model, over all parts.
pub const MAX_MODEL_VERTICES: usize = 1_000_000;

/// Maximum number of triangles of a model; two-sided ones count twice.
pub const MAX_MODEL_TRIANGLES: usize = 1_000_000;

/// Maximum number of colours of a model.
pub const MAX_MODEL_PARTS: usize = 256;

/// Maximum number of levels of detail of a model, including the full one.
pub const MAX_MODEL_LEVELS: usize = 4;

/// Maximum distance of a model's corners from its origin, along each axis in metres.
pub const MAX_MODEL_REACH: f32 = 1000.0;

/// Maximum length of a class or model name, in bytes of UTF-8.
pub const MAX_NAME_BYTES: usize = 200;

/// Models that worlds may refer to by class and name, in addition to the built-in ones; see [`Catalogue`](crate::Catalogue).
#[derive(Clone, Debug, Default, PartialEq)]
pub struct Library {
    models: Vec<LibraryModel>,
    /// Normalised class and name of each model.
    keys: BTreeSet<(String, String)>,
}

impl Library {
    /// Adds a model.
    ///
    /// # Errors
    /// [`EnvError::BadModel`] if the library already has a model with that class and name, or already has
    /// [`MAX_LIBRARY_MODELS`] models.
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
            return refuse(&found, "fewer; start another library");
        }
        if !self.keys.insert(key(&model.class, &model.name)) {
            let expected = "each class and model once; choose another class or model name";
            return refuse("one that the library already has", expected);
        }
        self.models.push(model);
        Ok(())
    }

    /// The models in insertion order.
    pub fn models(&self) -> &[LibraryModel] {
        &self.models
    }
}

/// Normalises class and model for lookup.
pub(super) fn key(class: &str, model: &str) -> (String, String) {
    let model = model.trim();
    let model = match model.parse::<u32>() {
        Ok(number) => number.to_string(),
        Err(_) => model.to_lowercase(),
    };
    (class.trim().to_lowercase(), model)
}
