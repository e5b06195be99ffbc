//! [`Catalogue`]: which models a world can refer to, those of libraries in front of the built-in ones. How either is made is
//! in `library` and `builtin.rs`.

use std::collections::BTreeMap;
use std::sync::Arc;

use driftworld_spec::Model;

use super::library::Library;
use super::{Asset, asset};

/// The models that worlds may refer to by class and model: the built-in ones, and in front of them those of libraries.
///
/// Cloning one is cheap: clones share their assets.
///
/// # Example
/// ```
/// use driftworld_env::{Catalogue, Environment};
/// use driftworld_spec::{Model, World};
/// let catalogue = Catalogue::default();
/// assert!(catalogue.asset("tree", &Model("7".into())).known);
/// assert!(!catalogue.asset("dragon", &Model("1".into())).known, "a placeholder");
/// let environment = Environment::with_catalogue(World::default(), catalogue)?;
/// # Ok::<(), driftworld_env::EnvError>(())
/// ```
#[derive(Clone, Debug, Default)]
pub struct Catalogue {
    /// By class and model as [`key`] writes them.
    models: Arc<BTreeMap<(String, String), Arc<Asset>>>,
}

impl Catalogue {
    /// The catalogue with a library in front: where it has a class and model that were known before, its own holds.
    #[must_use]
    pub fn with_library(mut self, library: &Library) -> Self {
        let models = Arc::make_mut(&mut self.models);
        for model in library.models() {
            models.insert(key(&model.class, &model.name), Arc::new(model.asset()));
        }
        self
    }

    /// The asset of a class and model; what nobody knows is a placeholder.
    ///
    /// Capitals do not matter, and a model that is a number may be written in any way that says the same number.
    pub fn asset(&self, class: &str, model: &Model) -> Arc<Asset> {
        // Most catalogues hold nothing but built-in models, and then no key is made.
        if self.models.is_empty() {
            return asset(class, model);
        }
        let found = self.models.get(&key(class, &model.0));
        found.map_or_else(|| asset(class, model), Arc::clone)
    }
}

/// What class and model are found by.
pub(super) fn key(class: &str, model: &str) -> (String, String) {
    let model = model.trim();
    let model = match model.parse::<u32>() {
        Ok(number) => number.to_string(),
        Err(_) => model.to_lowercase(),
    };
    (class.trim().to_lowercase(), model)
}
