//! [`Catalogue`]: the models that worlds can refer to. Models of libraries take precedence over built-in ones.

use std::collections::BTreeMap;
use std::sync::{Arc, OnceLock};

use driftworld_spec::{Classes, Model, Models, Style};

use super::library::{Library, LibraryModel, key};
use super::{Asset, asset_in, builtin, needs_light_letters, sign};

/// The number in class segmentation shared by all classes that are not in the catalogue; they are drawn as placeholders.
pub const UNKNOWN_CLASS: u16 = 31;

/// The number in class segmentation of the first class of libraries.
pub const FIRST_LIBRARY_CLASS: u16 = 32;

/// The models that worlds may refer to by class and model: the built-in ones, overridden by those of libraries. Cloning is
/// cheap: clones share their assets. A library's model is expanded to an asset, many times its size, on first use.
///
/// # Example
/// ```
/// use driftworld_env::{Catalogue, Environment};
/// use driftworld_spec::{Model, World};
/// let catalogue = Catalogue::default();
/// assert!(catalogue.asset("tree", &Model("7".into())).known);
/// assert!(!catalogue.asset("dragon", &Model("1".into())).known, "a placeholder");
/// let environment = Environment::with_catalogue(World::default(), catalogue);
/// ```
#[derive(Clone, Debug, Default)]
pub struct Catalogue {
    /// By class and model, as [`key`] normalises them.
    models: Arc<BTreeMap<(String, String), Arc<Entry>>>,
    /// The classes that are not built in, sorted.
    own_classes: Arc<Vec<String>>,
}

/// A library's model, and its asset once it has been used.
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
    /// Adds a library; its models override known ones with the same class and name.
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
        let mut own: Vec<String> = models.keys().map(|(class, _)| class.clone()).collect();
        own.retain(|class| builtin::class_number(class).is_none());
        own.dedup();
        self.own_classes = Arc::new(own);
        self
    }

    /// The number of a class in class segmentation, the same in every world; ignores case. Built-in classes have numbers 1 to
    /// 29. Classes of libraries are numbered from [`FIRST_LIBRARY_CLASS`], sorted by name. Unknown classes have
    /// [`UNKNOWN_CLASS`]. A library's models of a built-in class have that class's number. 0 means no object.
    ///
    /// # Example
    /// ```
    /// use driftworld_env::{Catalogue, UNKNOWN_CLASS};
    /// let catalogue = Catalogue::default();
    /// assert_eq!((catalogue.class_number("barrel"), catalogue.class_number("Tree")), (2, 23));
    /// assert_eq!(catalogue.class_number("dragon"), UNKNOWN_CLASS);
    /// ```
    pub fn class_number(&self, class: &str) -> u16 {
        // Most names are already in the right case, so no copy is needed.
        if let Some(number) = self.find_number(class) {
            return number;
        }
        self.find_number(&class.trim().to_lowercase()).unwrap_or(UNKNOWN_CLASS)
    }

    fn find_number(&self, class: &str) -> Option<u16> {
        builtin::class_number(class).or_else(|| {
            let index = self.own_classes.binary_search_by(|own| own.as_str().cmp(class)).ok()?;
            Some(u16::try_from(index).map_or(u16::MAX, |index| index.saturating_add(FIRST_LIBRARY_CLASS)))
        })
    }

    /// All known classes with their numbers in class segmentation, ordered by number.
    pub fn class_numbers(&self) -> impl Iterator<Item = (&str, u16)> {
        builtin::class_names()
            .chain(self.own_classes.iter().map(String::as_str))
            .map(|class| (class, self.class_number(class)))
    }

    /// The classes with their models, for checking worlds: the built-in ones and those of its libraries.
    pub fn classes(&self) -> Classes {
        Classes::new(builtin::class_names().chain(self.models.keys().map(|(class, _)| class.as_str())))
            .with_models(self.clone())
    }

    /// The asset of a class and model; unknown ones get a placeholder.
    ///
    /// Ignores case; a model that is a number may be written in any way that parses to it.
    pub fn asset(&self, class: &str, model: &Model) -> Arc<Asset> {
        self.asset_in(Style::Plain, class, model)
    }

    /// The asset of a class and model in a style; its body is the same in every style. Models of libraries look the same in all
    /// styles.
    pub fn asset_in(&self, style: Style, class: &str, model: &Model) -> Arc<Asset> {
        // Most catalogues contain only built-in models, so no key is needed.
        if self.models.is_empty() {
            return asset_in(style, class, model);
        }
        let found = self.models.get(&key(class, &model.0));
        found.map_or_else(|| asset_in(style, class, model), |entry| entry.asset())
    }

    /// The asset of an object with text: a built-in sign shows it on its board, in lettering that is readable on the board's
    /// colour (sRGB; its own if absent). All other models ignore the text.
    pub fn asset_with_text(&self, class: &str, model: &Model, text: &str, color: Option<[f32; 3]>) -> Arc<Asset> {
        let is_built_in =
            class == "sign" && (self.models.is_empty() || !self.models.contains_key(&key(class, &model.0)));
        match builtin::number(class, model).filter(|_| is_built_in) {
            Some(number) => sign(number, text, color.is_some_and(needs_light_letters)),
            None => self.asset(class, model),
        }
    }
}

impl Models for Catalogue {
    fn has(&self, class: &str, model: &Model) -> bool {
        let key = key(class, &model.0);
        builtin::number(&key.0, model).is_some() || self.models.contains_key(&key)
    }

    fn names(&self, class: &str) -> Vec<String> {
        let own = self
            .models
            .keys()
            .filter(|(of, _)| of == class)
            .map(|(_, name)| name.clone());
        let mut names: Vec<String> = builtin::model_names(class).map(str::to_owned).collect();
        names.extend(own);
        names
    }
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
            .expect("a cube is a valid model")
    }

    /// Pinned: stored images use these numbers.
    #[test]
    fn numbers_of_built_in_classes_are_stable() {
        let numbers: Vec<String> = Catalogue::default()
            .class_numbers()
            .map(|(class, number)| format!("{number} {class}"))
            .collect();
        assert_eq!(
            numbers.join(", "),
            "1 bag, 2 barrel, 3 bed, 4 bench, 5 building, 6 car, 7 castleruin, 8 chair, 9 cube, 10 fence, 11 geometric, \
             12 icosphere, 13 mushroom, 14 nature, 15 pot, 16 roadblock, 17 rock, 18 shelf, 19 shrub, 20 streetsign, 21 table, \
             22 tent, 23 tree, 24 door, 25 key, 26 switch, 27 animal, 28 sign, 29 furniture"
        );
    }

    #[test]
    fn library_classes_are_numbered_by_name_in_any_load_order() {
        let library = |classes: &[&str]| {
            let mut library = Library::default();
            for class in classes {
                library.insert(model(class)).expect("there is room");
            }
            library
        };
        let (town, sea) = (library(&["lamp", "kiosk", "tree"]), library(&["buoy", "lamp"]));
        let numbers = |catalogue: Catalogue| {
            let of = |class: &str| catalogue.class_number(class);
            [of("buoy"), of("KIOSK"), of(" lamp"), of("tree"), of("dragon")]
        };
        let one_way = Catalogue::default().with_library(&town).with_library(&sea);
        let all: Vec<(String, u16)> = one_way
            .class_numbers()
            .map(|(class, number)| (class.to_owned(), number))
            .collect();
        assert_eq!(
            all[29..],
            [
                ("buoy".to_owned(), 32),
                ("kiosk".to_owned(), 33),
                ("lamp".to_owned(), 34)
            ]
        );
        assert_eq!(numbers(one_way), [32, 33, 34, 23, UNKNOWN_CLASS]);
        let other_way = Catalogue::default().with_library(&sea).with_library(&town);
        assert_eq!(numbers(other_way), [32, 33, 34, 23, UNKNOWN_CLASS]);
    }

    #[test]
    fn class_numbers_in_images_are_the_same_in_every_world() {
        let mut library = Library::default();
        for class in ["kiosk", "lamp"] {
            library.insert(model(class)).expect("there is room");
        }
        let catalogue = Catalogue::default().with_library(&library);
        let visible = |classes: &[&str]| {
            let objects = classes.iter().enumerate();
            let at =
                |(index, class): (usize, &&str)| driftworld_spec::Object::new(*class, [3.0 * index as f64 - 3.0, 8.0]);
            let mut world = driftworld_spec::WorldDraft::with_objects(objects.map(at).collect());
            world.agent_params.modalities = vec![driftworld_spec::Modality::Class];
            let world = world.check().expect("the world is valid");
            let mut environment = crate::Environment::with_catalogue(world, catalogue.clone());
            let mut seen = environment.observe().class.clone();
            seen.sort_unstable();
            seen.dedup();
            seen
        };
        assert_eq!(visible(&["barrel", "tree", "rock"]), [0, 2, 17, 23]);
        assert_eq!(visible(&["rock", "Barrel"]), [0, 2, 17]);
        assert_eq!(visible(&["dragon", "barrel"]), [0, 2, UNKNOWN_CLASS]);
        assert_eq!(visible(&["lamp", "barrel", "dragon"]), [0, 2, UNKNOWN_CLASS, 33]);
    }

    #[test]
    fn library_models_become_assets_once_on_first_use() {
        let mut library = Library::default();
        for class in ["kiosk", "lamp"] {
            library.insert(model(class)).expect("there is room");
        }
        let catalogue = Catalogue::default().with_library(&library);
        let num_loaded = |catalogue: &Catalogue| {
            let entries = catalogue.models.values();
            entries.filter(|entry| entry.asset.get().is_some()).count()
        };
        assert_eq!(num_loaded(&catalogue), 0, "no model has been used yet");
        let classes = catalogue.classes();
        assert!(
            ["kiosk", "Lamp", "tree", " Barrel"]
                .iter()
                .all(|class| classes.has(class))
        );
        assert!(!classes.has("bushh") && !Catalogue::default().classes().has("kiosk"));
        let number = Model("1".into());
        let first = catalogue.clone().asset("Lamp", &number);
        assert_eq!(num_loaded(&catalogue), 1, "only the lamp has been used");
        assert!(
            Arc::ptr_eq(&first, &catalogue.asset("lamp", &number)),
            "clones share the asset"
        );
    }
}
