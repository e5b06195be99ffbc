//! [`Catalogue`]: which models a world can refer to, those of libraries in front of the built-in ones. How either is made is
//! in `library` and `builtin.rs`.

use std::collections::BTreeMap;
use std::sync::{Arc, OnceLock};

use driftworld_spec::Model;

use super::library::{Library, LibraryModel};
use super::{Asset, asset};

/// The models that worlds may refer to by class and model: the built-in ones, and in front of them those of libraries.
///
/// Cloning one is cheap: clones share their assets. A library's model becomes an asset, many times its size, when it is first
/// asked for.
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
    models: Arc<BTreeMap<(String, String), Arc<Entry>>>,
}

/// A library's model, and the asset that it becomes when somebody asks for it.
#[derive(Debug)]
struct Entry {
    model: LibraryModel,
    asset: OnceLock<Arc<Asset>>,
}

impl Entry {
    fn asset(&self) -> Arc<Asset> {
        Arc::clone(self.asset.get_or_init(|| Arc::new(self.model.asset())))
    }
}

impl Catalogue {
    /// The catalogue with a library in front: where it has a class and model that were known before, its own holds.
    #[must_use]
    pub fn with_library(mut self, library: &Library) -> Self {
        let models = Arc::make_mut(&mut self.models);
        for model in library.models() {
            let entry = Entry {
                model: model.clone(),
                asset: OnceLock::new(),
            };
            models.insert(key(&model.class, &model.name), Arc::new(entry));
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
        found.map_or_else(|| asset(class, model), |entry| entry.asset())
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

#[cfg(test)]
mod tests {
    use super::*;
    use crate::assets::library::Detail;
    use crate::assets::{ColliderShape, Mesh, Paint};

    fn model(class: &str) -> LibraryModel {
        let Mesh { corners, triangles } = Mesh::cuboid([1.0; 3], 0.0);
        let whole = Detail {
            error: 0.0,
            triangles: vec![triangles],
        };
        let collider = ColliderShape::Ball { radius: 1.0 };
        let paints = vec![Paint::Fixed([0.5; 3])];
        LibraryModel::checked(class.into(), "1".into(), collider, corners, paints, vec![whole])
            .expect("a cube is a sound model")
    }

    #[test]
    fn models_become_assets_when_they_are_asked_for_and_then_once() {
        let mut library = Library::default();
        for class in ["kiosk", "lamp"] {
            library.insert(model(class)).expect("there is room");
        }
        let catalogue = Catalogue::default().with_library(&library);
        let made = |catalogue: &Catalogue| {
            let entries = catalogue.models.values();
            entries.filter(|entry| entry.asset.get().is_some()).count()
        };
        assert_eq!(made(&catalogue), 0, "nobody asked yet");
        let number = Model("1".into());
        let first = catalogue.clone().asset("Lamp", &number);
        assert_eq!(made(&catalogue), 1, "the lamp, and no kiosk");
        assert!(
            Arc::ptr_eq(&first, &catalogue.asset("lamp", &number)),
            "clones share it"
        );
    }
}
