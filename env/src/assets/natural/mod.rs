//! The natural looks of what has a plain one: trees of sixteen kinds, rocks, shrubs, a car. A model keeps its kind, its size and
//! its body; only what is drawn is another.

mod growth;
mod plants;
mod trees;
mod vehicles;

use super::Asset;

/// The natural look of a built-in model, without a body; none if it looks as in the plain style.
pub(crate) fn make(class: &str, model: u32) -> Option<Asset> {
    Some(match class {
        "tree" => trees::tree(model),
        "rock" => plants::rock(model),
        "shrub" => plants::shrub(model),
        "mushroom" => plants::mushroom(model),
        "car" => vehicles::car(),
        _ => return None,
    })
}
