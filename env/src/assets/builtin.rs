//! The built-in classes: their model files and their numbers in class segmentation.

use std::sync::{Arc, LazyLock, OnceLock};

use driftworld_spec::{Model, Style};

use super::{Asset, model_file};

/// The models of a class in a style, parsed on first use: names and assets, ordered by number.
struct Models {
    class: &'static str,
    file: &'static str,
    read: OnceLock<Vec<(String, Arc<Asset>)>>,
}

/// An array of classes; each file name is the class's name with this suffix.
macro_rules! models {
    ($ending:literal: $($class:ident)+) => {
        [$(Models {
            class: stringify!($class),
            file: include_str!(concat!("../../assets/models/", stringify!($class), $ending)),
            read: OnceLock::new(),
        }),+]
    };
}

/// All classes, ordered by their numbers in class segmentation, which must not change: first those of the original environment
/// in alphabetical order, then ours. Append new ones; the next is number 30, which is the last possible one.
static PLAIN: [Models; 29] = models!(".gltf":
    bag barrel bed bench building car castleruin chair cube fence geometric icosphere mushroom nature pot roadblock rock
    shelf shrub streetsign table tent tree
    door key switch animal sign furniture
);

/// The classes that look different in the natural style. Their models have the same number, names and bodies as in the plain
/// style.
static NATURAL: [Models; 5] = models!("_natural.gltf": car mushroom rock shrub tree);

/// The placeholder for unknown classes: a conspicuous striped bollard.
static UNKNOWN: [Models; 1] = models!(".gltf": unknown);

impl Models {
    fn read(&self) -> &[(String, Arc<Asset>)] {
        self.read.get_or_init(|| model_file::read(self.file))
    }
}

/// A class's models in a style; `None` if the class is not built in, or looks the same as in the plain style.
fn find(style: Style, class: &str) -> Option<&'static [(String, Arc<Asset>)]> {
    let all = match style {
        Style::Plain => PLAIN.as_slice(),
        Style::Natural => &NATURAL,
    };
    all.iter().find(|models| models.class == class).map(Models::read)
}

/// The names of the built-in classes, ordered by their numbers in class segmentation.
pub(crate) fn class_names<'a>() -> impl Iterator<Item = &'a str> {
    PLAIN.iter().map(|models| models.class)
}

/// The number of a built-in class in class segmentation.
pub(crate) fn class_number(class: &str) -> Option<u16> {
    let index = class_names().position(|name| name == class)?;
    u16::try_from(index + 1).ok()
}

/// The names of a class's models, ordered by number.
pub(crate) fn model_names(class: &str) -> impl Iterator<Item = &'static str> + use<> {
    let models = find(Style::Plain, class).unwrap_or_default();
    models.iter().map(|(name, _)| name.as_str())
}

/// The number of a model of a class, from its name or its number as a string, ignoring case. `None` if there is no such model.
pub(crate) fn number(class: &str, model: &Model) -> Option<u32> {
    let name = model.0.trim();
    let by_name = model_names(class).position(|own| own.eq_ignore_ascii_case(name));
    let number = by_name.map(|index| index as u32 + 1).or_else(|| model.number())?;
    (1..=model_names(class).count() as u32)
        .contains(&number)
        .then_some(number)
}

/// The built-in model with this number in a style, if there is one.
pub(crate) fn asset(style: Style, class: &str, number: u32) -> Option<Arc<Asset>> {
    let models = find(style, class).or_else(|| find(Style::Plain, class))?;
    let (_, asset) = models.get((number as usize).checked_sub(1)?)?;
    Some(Arc::clone(asset))
}

/// The asset of unknown classes.
pub(crate) fn placeholder() -> Arc<Asset> {
    static PLACEHOLDER: LazyLock<Arc<Asset>> = LazyLock::new(|| {
        let (_, asset) = &UNKNOWN[0].read()[0];
        Arc::new(Asset {
            known: false,
            ..Asset::clone(asset)
        })
    });
    Arc::clone(&PLACEHOLDER)
}

#[cfg(test)]
mod tests {
    use super::*;

    /// A checksum over the exact bits of all shapes, colours and colliders.
    fn checksum(models: &[(String, Arc<Asset>)]) -> String {
        let mut bytes = Vec::new();
        for (name, asset) in models {
            let body = format!("{name} {:?} {} {}", asset.collider, asset.height, asset.radius);
            bytes.extend(body.bytes());
            for level in &asset.levels {
                bytes.extend(level.error.to_le_bytes());
                for material in &level.materials {
                    bytes.extend(format!("{:?}", material.paint).bytes());
                    for block in &material.blocks {
                        let numbers = block.corners.iter().chain(&block.normal).chain([&block.offset]);
                        bytes.extend(numbers.flatten().flat_map(|number| number.to_le_bytes()));
                    }
                }
            }
        }
        format!("{:08x}", crc32fast::hash(&bytes))
    }

    /// Stored images and trajectories depend on these models.
    #[test]
    fn built_in_models_match_their_checksums() {
        let all = |models: &[Models]| {
            let lines = models
                .iter()
                .map(|models| format!("{} {}\n", models.class, checksum(models.read())));
            lines.collect::<String>()
        };
        let [plain, unknown, natural] = [all(&PLAIN), all(&UNKNOWN), all(&NATURAL)];
        insta::assert_snapshot!(format!("plain\n{plain}{unknown}natural\n{natural}"));
    }

    #[test]
    fn natural_models_are_named_like_the_plain_ones() {
        for models in &NATURAL {
            let names = models.read().iter().map(|(name, _)| name.as_str());
            assert!(names.eq(model_names(models.class)), "{}", models.class);
        }
    }
}
