//! Meshes and colliders of objects, from built-in model files or libraries.

mod asset;
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

pub use asset::{Asset, ColliderKind, ColliderShape, Paint, Part};
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
pub(crate) use signs::needs_light_letters;

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

/// The built-in sign number `model` with text in light or dark letters, built on first use and cached.
pub(crate) fn sign(model: u32, text: &str, is_light: bool) -> Arc<Asset> {
    type Cache = HashMap<(u32, String, bool), Arc<Asset>>;
    static CACHE: LazyLock<Mutex<Cache>> = LazyLock::new(Mutex::default);
    // The cache stays valid after a panic: only finished assets are inserted.
    let mut cache = CACHE.lock().unwrap_or_else(PoisonError::into_inner);
    let key = (model, text.to_owned(), is_light);
    if let Some(asset) = cache.get(&key) {
        return Arc::clone(asset);
    }
    // Bounds the memory if new texts keep coming; assets in use stay alive.
    if cache.len() >= MAX_CACHED_SIGNS {
        cache.clear();
    }
    let bare = builtin::asset(Style::Plain, "sign", model).unwrap_or_else(builtin::placeholder);
    let asset = Arc::new(signs::sign(&bare, model, text, is_light));
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
