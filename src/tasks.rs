//! Resolves names of tasks: `PATH`, `PATH#variant`, or a built-in such as `find_objects#red`.

use std::path::Path;
use std::sync::Arc;

use crate::contents::Contents;
use crate::documents::{self, DocumentError};
use driftworld_env::Catalogue;
use driftworld_files::FileError;
use driftworld_spec::{Classes, DEFAULT_VARIANT, Problem, SpecError, TaskSpec, Variant, World, did_you_mean};
use driftworld_text::printable;

/// The built-in tasks: name and text. The files are in `examples/tasks/`.
pub const BUILT_IN: [(&str, &str); 6] = [
    ("find_objects", include_str!("../examples/tasks/find_objects.json")),
    ("get_to_goal", include_str!("../examples/tasks/get_to_goal.json")),
    ("select_object", include_str!("../examples/tasks/select_object.json")),
    ("moving_object", include_str!("../examples/tasks/moving_object.json")),
    ("scavenger_hunt", include_str!("../examples/tasks/scavenger_hunt.json")),
    ("blue_red_green", include_str!("../examples/tasks/blue_red_green.json")),
];

/// Expands to tasks with these names, and their texts.
macro_rules! families {
    ($($name:literal)*) => {
        &[$(($name, include_str!(concat!("../examples/worlds/", $name, ".json")))),*]
    };
}

/// A group of tasks: what they require, and the name and text of each.
pub type Group = (&'static str, &'static [(&'static str, &'static str)]);

/// More tasks, by what they require. The files are in `examples/worlds/`.
#[rustfmt::skip]
pub const FAMILIES: [Group; 8] = [
    ("navigation", families![
        "hallway" "one_room" "three_rooms" "four_rooms" "multi_room" "maze" "nav_maze" "way_home" "t_maze" "y_maze"
        "wall_gap" "sidewalk" "obstacle_course"
    ]),
    ("doors and keys", families![
        "unlock" "unlock_pickup" "door_key" "key_corridor" "locked_rooms" "red_blue_doors" "switches"
    ]),
    ("things", families![
        "collect_health" "foraging" "put_next" "pickup" "fetch" "go_to_object" "go_to_door" "sort_by_color"
        "push_box"
    ]),
    ("hazards", families!["dynamic_obstacles" "hunt" "lava_crossing" "thin_ice" "stealth"]),
    ("memory", families!["cue_t_maze" "hidden_goal" "match_to_sample" "sequence_recall" "water_maze"]),
    ("choice", families!["k_armed" "contextual_bandit" "delayed_reward" "reversal" "sign_reading"]),
    ("conflicts", families!["color_pays" "side_pays" "mirrored" "safe_zone"]),
    ("levels", families!["expedition" "hand_made"]),
];

/// Errors raised while resolving a task's name.
#[derive(Debug, thiserror::Error)]
#[non_exhaustive]
pub enum TaskError {
    /// Neither a built-in task nor a file has this name.
    #[error("{}", unknown(name))]
    Unknown {
        /// The name asked for.
        name: String,
    },
    /// The file exists, but cannot be read, is not a regular file, is too large, or is not text.
    #[error(transparent)]
    Unreadable(FileError),
    /// The file holds a different kind of document, or is a folder.
    #[error(transparent)]
    Document(DocumentError),
    /// The document is invalid, or has no such variant.
    #[error(transparent)]
    Spec(#[from] SpecError),
    /// The name matches several variants, as a family or a pattern, but one variant is needed.
    #[error(
        "{}: found a name that stands for {count} variants, expected one of them, such as {first}",
        printable(name)
    )]
    Several {
        /// The name asked for.
        name: String,
        /// The number of variants that it matches.
        count: usize,
        /// The first of them.
        first: String,
    },
}

/// The error message for an unknown name: for a missing file if the name is a path, else for a missing task.
fn unknown(name: &str) -> String {
    let has_ending = Path::new(name)
        .extension()
        .is_some_and(|ending| ending.eq_ignore_ascii_case("json"));
    if has_ending || name.contains(['/', '\\']) {
        return format!(
            "{}: found no such file, expected a task spec or the name of a built-in task",
            printable(name)
        );
    }
    format!(
        "found task {name:?}, expected the path of a task spec or {}",
        known_tasks(name)
    )
}

/// Lists the tasks that come with Driftworld, for the end of a message about a misspelt name.
pub(crate) fn known_tasks(misspelt: &str) -> String {
    let (paper, more) = (built_in_names().join(", "), names().count() - BUILT_IN.len());
    let near = did_you_mean(misspelt, names());
    format!("one of {paper} and {more} more, which `driftworld tasks` lists{near}")
}

/// The classes and models that a catalogue provides for objects. Messages about unknown ones explain how to give a library.
pub fn classes(catalogue: &Catalogue) -> Classes {
    catalogue
        .classes()
        .with_advice("name the library that contains it with --assets LIBRARY, or in Python with assets=LIBRARY")
}

/// Refuses a task with objects of an unknown class or model.
///
/// # Errors
/// [`SpecError::Document`] with every such object.
pub fn check_classes(name: &str, task: &TaskSpec, classes: &Classes) -> Result<(), SpecError> {
    fail_on(name, task.unknown_classes(classes))
}

/// Refuses a world with objects of an unknown class or model.
///
/// # Errors
/// [`SpecError::Document`] with every such object.
pub fn check_world(name: &str, world: &World, catalogue: &Catalogue) -> Result<(), SpecError> {
    fail_on(name, world.unknown_classes(&classes(catalogue)))
}

fn fail_on(name: &str, problems: Vec<Problem>) -> Result<(), SpecError> {
    if problems.is_empty() {
        return Ok(());
    }
    let name = name.to_owned();
    Err(SpecError::Document {
        name,
        problems,
        more: false,
    })
}

/// Refuses variants whose tasks have objects of an unknown class or model; checks each task once.
///
/// # Errors
/// As [`check_classes`].
pub fn check_variants<'a>(
    variants: impl IntoIterator<Item = &'a Variant>,
    catalogue: &Catalogue,
) -> Result<(), SpecError> {
    let classes = classes(catalogue);
    let mut checked: Vec<&Arc<TaskSpec>> = Vec::new();
    for task in variants.into_iter().map(Variant::task) {
        if !checked.iter().any(|known| Arc::ptr_eq(known, task)) {
            check_classes(task.name(), task, &classes)?;
            checked.push(task);
        }
    }
    Ok(())
}

/// The names of the built-in tasks.
pub fn built_in_names() -> Vec<&'static str> {
    BUILT_IN.iter().map(|(name, _)| *name).collect()
}

/// All tasks that come with Driftworld, by what they require.
pub fn groups() -> impl Iterator<Item = Group> {
    std::iter::once(("the paper's", &BUILT_IN[..])).chain(FAMILIES)
}

/// The text of the task with this name.
pub fn text_by_name(name: &str) -> Option<&'static str> {
    let mut known = groups().flat_map(|(_, tasks)| tasks);
    known.find(|(known, _)| *known == name).map(|(_, text)| *text)
}

/// The names of all tasks that come with Driftworld.
fn names() -> impl Iterator<Item = &'static str> {
    groups().flat_map(|(_, tasks)| tasks).map(|(name, _)| *name)
}

/// Splits a name into task and variant: `find_objects#red` is `("find_objects", Some("red"))`.
pub fn split(name: &str) -> (&str, Option<&str>) {
    match name.rsplit_once('#') {
        Some((task, variant)) => (task, Some(variant)),
        None => (name, None),
    }
}

/// The task with this name or path; a variant after `#` is ignored.
///
/// # Errors
/// [`TaskError`] if there is none, or the document is invalid.
pub fn task(name: &str) -> Result<Arc<TaskSpec>, TaskError> {
    let (task, _) = split(name);
    if let Some(text) = text_by_name(task) {
        return Ok(TaskSpec::from_json(&format!("{task}.json"), text)?);
    }
    let path = Path::new(task);
    let text = documents::text_of(path, &[Contents::Task]).map_err(|error| match error {
        DocumentError::File(error) if error.missing().is_some() => TaskError::Unknown { name: task.to_owned() },
        DocumentError::File(error) => TaskError::Unreadable(error),
        other => TaskError::Document(other),
    })?;
    Ok(TaskSpec::from_json(&documents::name_of(path), &text)?)
}

/// The variant with this name; without one after `#`, the variant with all defaults.
///
/// # Errors
/// [`TaskError`] if there is none, or the document is invalid.
pub fn variant(name: &str) -> Result<Variant, TaskError> {
    let own = split(name).1.unwrap_or(DEFAULT_VARIANT);
    let task = task(name)?;
    task.variant(own).map_err(|error| match variants_called(&task, own) {
        Ok(several) => TaskError::Several {
            name: name.to_owned(),
            count: several.len(),
            first: several
                .first()
                .map(|variant| variant.name().to_owned())
                .unwrap_or_default(),
        },
        Err(_) => error.into(),
    })
}

/// The variants that a name stands for: the one after `#`, the members of the family after `#`, those matching a pattern with
/// `*` after `#`, or all that the task declares.
///
/// # Errors
/// [`TaskError`] if there is none, or the document is invalid.
pub fn variants(name: &str) -> Result<Vec<Variant>, TaskError> {
    let task = task(name)?;
    match split(name).1 {
        None => Ok(task.all_variants()),
        Some(own) => Ok(variants_called(&task, own)?),
    }
}

/// The variants of a task that a name without the task stands for: a variant, a family, or a pattern such as `light-*`.
///
/// # Errors
/// [`SpecError::UnknownVariant`] if there is none.
pub fn variants_called(task: &Arc<TaskSpec>, name: &str) -> Result<Vec<Variant>, SpecError> {
    let members: Vec<&str> = if let Some(members) = task.family(name) {
        members
    } else {
        let fitting = || task.variant_names().into_iter().filter(|known| matches(name, known));
        if name.contains('*') && fitting().next().is_some() {
            fitting().collect()
        } else {
            vec![name]
        }
    };
    members.into_iter().map(|member| task.variant(member)).collect()
}

/// Whether a name matches a pattern, in which `*` stands for any characters.
fn matches(pattern: &str, name: &str) -> bool {
    match pattern.split_once('*') {
        None => pattern == name,
        Some((start, rest)) => name.strip_prefix(start).is_some_and(|behind| {
            let mut ends = behind.char_indices().map(|(at, _)| at).chain([behind.len()]);
            ends.any(|at| matches(rest, &behind[at..]))
        }),
    }
}

/// Whether a name is neither a path nor similar to the name of a built-in task.
fn is_word(name: &str) -> bool {
    !name.contains(['/', '\\', '.']) && did_you_mean(name, names()).is_empty()
}

/// Whether a file exists. A folder does not count: it may have the name of a variant.
fn is_document(path: &Path) -> bool {
    path.exists() && !path.is_dir()
}

/// Adds the task to names without one: after a name with a task, a variant, a family or a pattern may omit that task, as in
/// `find_objects#red dusk`.
pub(crate) fn with_tasks(names: &[String]) -> Vec<String> {
    let mut known: Vec<(String, Arc<TaskSpec>)> = Vec::new();
    let called = names.iter().map(|name| {
        let (of, own) = split(name);
        let is_task = own.is_some() || text_by_name(of).is_some() || is_document(Path::new(of));
        if !is_task && let Some((task, _)) = known.iter().rev().find(|(_, spec)| variants_called(spec, name).is_ok()) {
            return format!("{task}#{name}");
        }
        match task(of) {
            Ok(spec) => known.push((of.to_owned(), spec)),
            // After a task, treat an unknown word as a misspelt variant of it, unless it is a path or similar to a task's name.
            Err(TaskError::Unknown { .. }) if own.is_none() && is_word(name) => {
                if let Some((task, _)) = known.last() {
                    return format!("{task}#{name}");
                }
            }
            Err(_) => {}
        }
        name.clone()
    });
    called.collect()
}

/// The variants that a list of names stands for, in order and without duplicates, with the names of their tasks as given. After a
/// name with a task, others of the same task may omit it.
///
/// # Errors
/// As [`variants`].
pub fn variants_of(names: &[String]) -> Result<Vec<(String, Variant)>, TaskError> {
    let mut found: Vec<(String, Variant)> = Vec::new();
    for name in &with_tasks(names) {
        let (task, _) = split(name);
        for variant in variants(name)? {
            if !found
                .iter()
                .any(|(known, other)| known == task && other.name() == variant.name())
            {
                found.push((task.to_owned(), variant));
            }
        }
    }
    Ok(found)
}

/// The names of variants in tables: `TASK#VARIANT` with the task's own name, even if it was given by a path. If two names would be
/// equal, the tasks are named as given.
pub(crate) fn labels_of(variants: &[(String, Variant)]) -> Vec<String> {
    let ids: Vec<String> = variants.iter().map(|(_, variant)| variant.id()).collect();
    let is_unique = |id: &String| ids.iter().filter(|other| *other == id).count() == 1;
    let label = |((task, variant), id): (&(String, Variant), &String)| {
        if is_unique(id) {
            id.clone()
        } else {
            format!("{task}#{}", variant.name())
        }
    };
    variants.iter().zip(&ids).map(label).collect()
}

/// The name of a task given by its path or name; the path itself if there is no task.
pub(crate) fn name_of(called: &str) -> String {
    if BUILT_IN.iter().any(|(name, _)| *name == called) {
        return called.to_owned();
    }
    task(called).map_or_else(|_| called.to_owned(), |task| task.name().to_owned())
}

/// A variant's name in tables, however its task was given; a bare name is unchanged.
pub(crate) fn label_of(called: &str) -> String {
    match split(called) {
        (task, Some(variant)) => format!("{}#{variant}", name_of(task)),
        (_, None) => called.to_owned(),
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn every_built_in_task_loads_under_its_own_name() {
        for (name, _) in BUILT_IN {
            assert_eq!(task(name).unwrap().name(), name);
        }
    }

    #[test]
    fn misspelt_name_error_lists_the_tasks() {
        assert_eq!(
            variant("find_object#red").unwrap_err().to_string(),
            "found task \"find_object\", expected the path of a task spec or one of find_objects, get_to_goal, \
             select_object, moving_object, scavenger_hunt, blue_red_green and 50 more, which `driftworld tasks` lists; \
             did you mean \"find_objects\"?"
        );
        assert_eq!(
            variant("find_objects#rde").unwrap_err().to_string(),
            "find_objects: found variant \"rde\", expected one of blue, red, green, dusk, huddle, penalty, \
             spheres, clearing, wide, modest, poor, half, turned, interact, near, held, long_held, slim, slow, \
             stiff and 17 more; did you mean \"red\"?"
        );
        let several = variant("find_objects#any_*").unwrap_err().to_string();
        assert!(
            several.ends_with("expected one of them, such as any_light"),
            "{several}"
        );
    }

    #[test]
    fn missing_file_is_reported_for_a_path() {
        for name in ["nope.json", "no/where"] {
            let error = variant(name).unwrap_err().to_string();
            assert_eq!(
                error,
                format!("{name}: found no such file, expected a task spec or the name of a built-in task")
            );
        }
    }

    #[test]
    fn variants_match_patterns_and_may_omit_the_task() {
        let names = |names: &[&str]| -> Vec<String> {
            let names: Vec<String> = names.iter().map(|name| (*name).to_owned()).collect();
            let found = variants_of(&names).unwrap().into_iter();
            found
                .map(|(task, variant)| format!("{task}#{}", variant.name()))
                .collect()
        };
        assert_eq!(
            names(&["find_objects#red", "dusk", "get_to_goal#plain", "soft"]),
            [
                "find_objects#red",
                "find_objects#dusk",
                "get_to_goal#plain",
                "get_to_goal#soft"
            ]
        );
        assert_eq!(
            names(&["find_objects#*held"]),
            ["find_objects#held", "find_objects#long_held"]
        );
        // A folder is not a document, even if its name could be a variant's.
        assert!(!is_document(Path::new("docs")) && is_document(Path::new("Cargo.toml")));
        let unknown = variants_of(&["find_objects#red".to_owned(), "dsk".to_owned()]).unwrap_err();
        assert!(unknown.to_string().ends_with("did you mean \"dusk\"?"), "{unknown}");
        assert!(matches("a*c", "abcc") && !matches("a*c", "abcd") && matches("*", "") && !matches("a", "ab"));
    }
}
