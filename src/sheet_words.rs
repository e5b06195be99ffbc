//! Writes the captions of a contact sheet: each entry's world and camera, its differences from another variant, and notes for
//! all entries.

use driftworld_spec::{Element, Modality, Value, Variant};
use driftworld_text::whole;

use crate::contact_sheet::{Choice, Item, Options};
use crate::value_words::short;

/// How the worlds of a variant are named.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(crate) enum Worlds {
    /// By index.
    Numbered,
    /// By position in a scenario, whose world indices mean nothing to a reader.
    OfScenario,
    /// The last world of a drift.
    EndOfDrift,
}

/// The most frequent viewpoint; ties go to the first.
pub(crate) fn most_frequent(viewpoints: &[String]) -> Option<&String> {
    let count = |viewpoint: &String| viewpoints.iter().filter(|other| *other == viewpoint).count();
    viewpoints.iter().rev().max_by_key(|viewpoint| count(viewpoint))
}

/// "a", "a and b", "a, b and c".
fn listed<T: AsRef<str>>(words: &[T]) -> String {
    let words: Vec<&str> = words.iter().map(AsRef::as_ref).collect();
    match &words[..] {
        [before @ .., one, last] => [before, &[&format!("{one} and {last}")]].concat().join(", "),
        few => few.concat(),
    }
}

/// Notes for all entries: the variants whose values are in brackets, and the most frequent viewpoint.
pub(crate) fn footer(bases: &[String], viewpoints: &[String], most_common: Option<&String>) -> Option<String> {
    let mut notes = Vec::new();
    if !bases.is_empty() {
        let each = if bases.len() > 1 { "each " } else { "" };
        notes.push(format!(
            "In brackets: the values of {}, {each}the first of its task.",
            listed(bases)
        ));
    }
    if let Some(most_common) = most_common {
        let which = if viewpoints.iter().all(|viewpoint| viewpoint == most_common) {
            "Each cell"
        } else {
            "Other cells"
        };
        notes.push(format!("{which}: {most_common}."));
    }
    (!notes.is_empty()).then(|| notes.join(" "))
}

/// A note on what a picture shows instead of colours.
pub(crate) fn modality_words(modality: Modality) -> &'static str {
    match modality {
        Modality::Rgb => "",
        Modality::Depth => "Shown as depth: the agent sees no colours.",
        Modality::Segmentation => "Shown as reward categories: the agent sees no colours.",
        Modality::Class => "Shown as classes, one colour each: the agent sees no other colours.",
        Modality::Instance => "Shown as objects, one colour each: the agent sees no other colours.",
    }
}

/// Describes the world and the camera.
pub(crate) fn viewpoint(shown: &Item, choice: Choice, look: Options) -> String {
    let offset = choice.world % shown.count.max(1);
    let world = match (look.index, shown.worlds) {
        (Some(index), _) => format!("world {index}"),
        (None, Worlds::Numbered) => format!("world {}", shown.index + offset),
        (None, Worlds::OfScenario) => {
            let order = ["first", "second", "third", "fourth"];
            let word = order.get(offset as usize).copied().unwrap_or("fifth or later");
            format!("its {word} world in the scenario")
        }
        (None, Worlds::EndOfDrift) => "its last world in the scenario".to_owned(),
    };
    let side = if choice.turn < 0.0 { "left" } else { "right" };
    let turn = match choice.turn.abs() {
        0.0 => "the agent's view".to_owned(),
        180.0 => "the view behind the agent".to_owned(),
        degrees => format!("the view {degrees}° to the agent's {side}"),
    };
    format!("{world}, {turn}")
}

/// The values in which a variant differs from another, in full, with the other's in brackets.
pub(crate) fn differences(base: &Variant, variant: &Variant) -> String {
    let parameters = variant.task().parameters();
    let short = |name: &str, value: &Value| {
        let word = parameters.get(name).and_then(|parameter| parameter.name_of(value));
        word.map_or_else(|| short(value), str::to_owned)
    };
    let of_base = |name: &str| {
        base.value(name)
            .map_or_else(|| "none".to_owned(), |value| short(name, value))
    };
    let parts: Vec<String> = (variant.values().iter())
        .filter(|(name, value)| base.value(name) != Some(value))
        .map(|(name, value)| {
            let (own, other) = (short(name, value), of_base(name));
            let other = if own == other { "another".to_owned() } else { other };
            // A map's value may begin with the parameter's name: "map 2, 60 × 60 m".
            let own = own.strip_prefix(&format!("{name} ")).unwrap_or(&own);
            whole(&format!("{name} {own} ({other})"))
        })
        .collect();
    parts.join(", ") + if parts.is_empty() { "" } else { "." }
}

/// A note that two variants look the same in the pictures, with the elements that differ although the pictures do not show it.
pub(crate) fn same_looks(base: &Variant, variant: &Variant, [view, map]: [bool; 2]) -> String {
    let what = match (view, map) {
        (true, true) => "Looks the same, and so does the map",
        (true, false) => "Looks the same from here",
        (false, _) => return String::new(),
    };
    let parameters = variant.task().parameters();
    let differing = variant
        .values()
        .iter()
        .filter(|(name, value)| base.value(name) != Some(value));
    let mut elements: Vec<Element> = differing
        .filter_map(|(name, _)| parameters.get(name))
        .flat_map(|parameter| parameter.affects.iter().map(|element| element.coarse()))
        .collect();
    elements.sort_unstable();
    elements.dedup();
    let names: Vec<&str> = elements.iter().map(|element| element.name()).collect();
    match names.len() {
        0 => format!("{what}."),
        1 => format!("{what}: only {} differs.", names[0]),
        _ => format!("{what}: {} differ.", listed(&names)),
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::tasks;

    #[test]
    fn lists_have_one_and() {
        assert_eq!(listed(&["a"]), "a");
        assert_eq!(listed(&["a", "b"]), "a and b");
        assert_eq!(listed(&["a", "b", "c", "d"]), "a, b, c and d");
    }

    /// Layouts are described in words, not as cut JSON.
    #[test]
    fn layouts_in_captions_are_not_cut() {
        let task = concat!(env!("CARGO_MANIFEST_DIR"), "/examples/worlds/maze.json");
        let task = tasks::task(task).expect("it is a task");
        let base = task.variant("medium").expect("it is declared");
        let found: Vec<String> = (task.all_variants().iter())
            .map(|variant| differences(&base, variant))
            .collect();
        assert!(found.contains(&whole("layout maze 4 × 4 (maze 8 × 8).")), "{found:?}");
        assert!(found.iter().all(|words| !words.contains(['{', '…'])), "{found:?}");
    }
}
