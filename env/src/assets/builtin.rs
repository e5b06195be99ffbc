//! Which classes are built in, how many models each has, and who makes them.

use driftworld_spec::Model;

use super::animals::{self, ANIMALS};
use super::furnishings::{self, FURNISHINGS};
use super::signs::{self, Lettering, SIGNS};
use super::{Asset, Builder, Mesh, furniture, nature, structures, things, trees};

/// Every class of the original with its number of models, in alphabetical order.
pub(crate) const CLASSES: &[(&str, u32)] = &[
    ("bag", 6),
    ("barrel", 5),
    ("bed", 1),
    ("bench", 3),
    ("building", 3),
    ("car", 1),
    ("castleruin", 7),
    ("chair", 4),
    ("cube", 1),
    ("fence", 31),
    ("geometric", 3),
    ("icosphere", 1),
    ("mushroom", 6),
    ("nature", 1),
    ("pot", 4),
    ("roadblock", 1),
    ("rock", 44),
    ("shelf", 1),
    ("shrub", 11),
    ("streetsign", 1),
    ("table", 3),
    ("tent", 3),
    ("tree", 49),
];

/// Classes of ours, in the order in which they came: a new one goes behind the others, up to the seventh.
pub(crate) const OWN_CLASSES: &[(&str, u32)] = &[
    ("door", 2),
    ("key", 1),
    ("switch", 1),
    ("animal", ANIMALS.len() as u32),
    ("sign", SIGNS.len() as u32),
    ("furniture", FURNISHINGS.len() as u32),
];

/// The models that have names, by their class; their numbers are their places in the list, from 1 on.
const NAMED: &[(&str, &[&str])] = &[("animal", &ANIMALS), ("sign", &SIGNS), ("furniture", &FURNISHINGS)];

/// All built-in classes with their numbers of models, in the order of their numbers in class segmentation.
pub(crate) fn classes() -> impl Iterator<Item = (&'static str, u32)> {
    CLASSES.iter().chain(OWN_CLASSES).copied()
}

/// The number of a built-in class in class segmentation. Those of the original have 1 to 23, in alphabetical order; ours have
/// the next numbers up to 30, in the order of their list: what was stored stays right.
pub(crate) fn class_number(class: &str) -> Option<u16> {
    let originals = CLASSES.binary_search_by_key(&class, |(name, _)| name).ok();
    let own = || OWN_CLASSES.iter().position(|(name, _)| *name == class);
    let place = originals.or_else(|| Some(CLASSES.len() + own()?))?;
    u16::try_from(place + 1).ok()
}

/// How many models a class has, if it is known.
pub(crate) fn models(class: &str) -> Option<u32> {
    classes().find(|(name, _)| *name == class).map(|(_, models)| models)
}

/// Whether a class is built in and has a model of this number.
pub(crate) fn has(class: &str, number: u32) -> bool {
    models(class).is_some_and(|models| (1..=models).contains(&number))
}

/// The number that a model of a class has, by its name or as it is written; capitals do not matter.
pub(crate) fn number(class: &str, model: &Model) -> Option<u32> {
    let name = model.0.trim();
    let named = names(class).iter().position(|own| own.eq_ignore_ascii_case(name));
    named.map(|place| place as u32 + 1).or_else(|| model.number())
}

/// The models of a class in the order of their numbers, by their names or else by their numbers.
pub(crate) fn model_names(class: &str) -> impl Iterator<Item = String> {
    let names = names(class);
    let name = |number: u32| {
        let own = names.get(number as usize - 1);
        own.map_or_else(|| number.to_string(), |name| (*name).to_owned())
    };
    (1..=models(class).unwrap_or(0)).map(name)
}

fn names(class: &str) -> &'static [&'static str] {
    let found = NAMED.iter().find(|(named, _)| *named == class);
    found.map_or(&[], |(_, names)| names)
}

/// Makes an asset; what is not known is the placeholder.
pub(crate) fn make(class: &str, model: u32) -> Asset {
    match class {
        "tree" => trees::tree(model),
        "rock" => nature::rock(model),
        "shrub" => nature::shrub(model),
        "nature" => nature::stump(),
        "mushroom" => nature::mushroom(model),
        "geometric" | "cube" | "icosphere" => geometric(class, model),
        "bag" => furniture::bag(model),
        "barrel" => furniture::barrel(model),
        "bed" => furniture::bed(),
        "bench" => furniture::bench(model),
        "chair" => furniture::chair(model),
        "pot" => furniture::pot(model),
        "shelf" => furniture::shelf(),
        "table" => furniture::table(model),
        "building" => structures::building(model),
        "car" => structures::car(),
        "castleruin" => structures::castle_ruin(model),
        "fence" => structures::fence(model),
        "roadblock" => structures::roadblock(),
        "streetsign" => structures::street_sign(),
        "tent" => structures::tent(model),
        "door" => things::door(model),
        "key" => things::key(),
        "switch" => things::switch(),
        "animal" => animals::animal(model),
        "sign" => signs::sign(model, "", Lettering::Dark),
        "furniture" => furnishings::furnishing(model),
        _ => placeholder(),
    }
}

/// Cube, ball and cylinder of about 1 m: what a user puts where only colour matters.
fn geometric(class: &str, model: u32) -> Asset {
    let grey = [0.62, 0.62, 0.66];
    match (class, model) {
        ("icosphere", _) => Builder::default().main(grey, Mesh::ball(0.5, 0.5, 9, 5)).round(0.5),
        ("geometric", 2) => Builder::default().main(grey, Mesh::ball(0.5, 0.5, 16, 10)).round(0.5),
        ("geometric", 3) => Builder::default()
            .main(grey, Mesh::cylinder(0.45, 0.0, 1.0, 16))
            .round(0.45),
        _ => Builder::default()
            .main(grey, Mesh::cuboid([0.9, 0.9, 0.9], 0.0))
            .boxed(),
    }
}

/// Something to stumble over where the class is not known: a striped bollard.
fn placeholder() -> Asset {
    let stripe = |low: f32| Mesh::cylinder(0.25, low, low + 0.2, 8);
    let asset = Builder::default()
        .fixed([0.95, 0.2, 0.75], stripe(0.0).with(&stripe(0.4)).with(&stripe(0.8)))
        .fixed([0.12, 0.1, 0.12], stripe(0.2).with(&stripe(0.6)))
        .round(0.25);
    Asset { known: false, ..asset }
}
