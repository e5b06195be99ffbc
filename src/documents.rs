//! Reads documents from files and standard input, recognises their kind by their keys, and checks them.

use std::collections::BTreeMap;
use std::io::Read;
use std::path::Path;
use std::str::FromStr;
use std::sync::{Arc, Mutex, PoisonError};

use driftworld_curriculum::{CurriculumError, log_name};
use driftworld_env::{Catalogue, Environment, Obstacle, Warning};
use driftworld_files::FileError;
use driftworld_spec::maps::MapLibrary;
use driftworld_spec::{Classes, MAX_BYTES, Parameter, Role, Scenario, SpecError, TaskSpec, World, did_you_mean};
use driftworld_text::one_line;

use crate::contents::{Contents, OtherContents};
use crate::tasks::TaskError;
use crate::top_level::TopLevel;

/// Errors raised while reading a document from its file.
#[derive(Debug, thiserror::Error)]
#[non_exhaustive]
pub enum DocumentError {
    /// The file cannot be read, is not a regular file, is too large, or is not text.
    #[error(transparent)]
    File(#[from] FileError),
    /// Standard input cannot be read, is too long, or is not text.
    #[error("standard input: {0}")]
    StandardInput(String),
    /// The document is of the wrong kind.
    #[error(transparent)]
    OtherContents(#[from] OtherContents),
    /// The document is invalid.
    #[error(transparent)]
    Spec(#[from] SpecError),
}

/// The text of standard input once read; the outer option is `None` unless the command accepts standard input.
#[expect(clippy::option_option, reason = "outer: may be read; inner: was read")]
static STANDARD_INPUT: Mutex<Option<Option<Result<String, String>>>> = Mutex::new(None);

/// Makes `-` and `/dev/stdin` stand for standard input, which is read once and cached.
pub(crate) fn accept_standard_input() {
    *STANDARD_INPUT.lock().unwrap_or_else(PoisonError::into_inner) = Some(None);
}

/// Whether a path means standard input; always false unless the command accepts standard input.
pub(crate) fn is_standard_input(path: &Path) -> bool {
    let is_its_name = path == Path::new("-") || path == Path::new("/dev/stdin");
    is_its_name && STANDARD_INPUT.lock().unwrap_or_else(PoisonError::into_inner).is_some()
}

/// The name of a document in messages.
pub(crate) fn name_of(path: &Path) -> String {
    if is_standard_input(path) {
        "standard input".to_owned()
    } else {
        path.display().to_string()
    }
}

/// The folder of a file; the working folder for a bare file name.
pub(crate) fn folder_of(file: &Path) -> &Path {
    let folder = file.parent().filter(|folder| !folder.as_os_str().is_empty());
    folder.unwrap_or(Path::new("."))
}

/// The text of standard input, cached.
fn standard_input() -> Result<String, DocumentError> {
    let mut input = STANDARD_INPUT.lock().unwrap_or_else(PoisonError::into_inner);
    let read = || {
        let mut bytes = Vec::new();
        let mut stdin = std::io::stdin().lock().take(MAX_BYTES as u64 + 1);
        stdin
            .read_to_end(&mut bytes)
            .map_err(|error| format!("cannot be read: {error}"))?;
        if bytes.len() > MAX_BYTES {
            return Err(format!("found more than {MAX_BYTES} bytes, expected at most that many"));
        }
        let text = String::from_utf8(bytes).map_err(|error| {
            let at = error.utf8_error().valid_up_to();
            format!("found a byte that is not UTF-8 at {at}, expected text")
        })?;
        Ok(text.strip_prefix('\u{feff}').map_or(text.clone(), str::to_owned))
    };
    let text = input.get_or_insert_default().get_or_insert_with(read);
    text.clone().map_err(DocumentError::StandardInput)
}

/// The text of a file of at most [`MAX_BYTES`], without the byte order mark that some editors add. In the command, `-` is
/// standard input.
///
/// # Errors
/// [`DocumentError::File`], also if it is not a regular file; [`DocumentError::StandardInput`].
pub fn text(path: &Path) -> Result<String, DocumentError> {
    if is_standard_input(path) {
        return standard_input();
    }
    Ok(driftworld_files::text(path, MAX_BYTES as u64)?)
}

/// The text of a file that should be one of several kinds of documents.
///
/// # Errors
/// As [`text`], and [`DocumentError::OtherContents`] for a folder, and for a text of a different recognised kind.
pub fn text_of(path: &Path, wanted: &[Contents]) -> Result<String, DocumentError> {
    if let Some(other) = OtherContents::check(path, Contents::of_folder(path), wanted) {
        return Err(other.into());
    }
    let text = text(path)?;
    match OtherContents::check(path, Contents::of_text(&text), wanted) {
        Some(other) => Err(other.into()),
        None => Ok(text),
    }
}

/// The kind of a document.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Kind {
    /// A task spec.
    Task,
    /// A world.
    World,
    /// A scenario: the blocks of a curriculum.
    Scenario,
    /// Layouts.
    Maps,
    /// A world in L2Explorer's format.
    L2ExplorerWorld,
    /// A scenario in L2Explorer's format.
    L2ExplorerScenario,
}

impl Kind {
    /// Every kind, with its identifier for programs and its name in messages.
    const WORDS: [(Self, &'static str, &'static str); 6] = [
        (Self::Task, "task", "task spec"),
        (Self::World, "world", "world"),
        (Self::Scenario, "scenario", "scenario"),
        (Self::Maps, "maps", "maps file"),
        (Self::L2ExplorerWorld, "l2explorer-world", "L2Explorer world"),
        (Self::L2ExplorerScenario, "l2explorer-scenario", "L2Explorer scenario"),
    ];

    /// The kind of a text, recognised by its keys: `blocks` make a scenario, `scenario` one of L2Explorer's, `maps` a maps
    /// file, `name`, `parameters` or `groups` a task spec, anything else a world.
    pub fn of(text: &str) -> Self {
        let keys = TopLevel::of(text).unwrap_or_default();
        if keys.has("blocks") {
            Self::Scenario
        } else if keys.is_l2explorer_scenario() {
            Self::L2ExplorerScenario
        } else if keys.has("maps") {
            Self::Maps
        } else if keys.has_any(&["name", "parameters", "groups"]) {
            Self::Task
        } else {
            Self::World
        }
    }

    /// The kind's name in messages.
    pub fn name(self) -> &'static str {
        Self::WORDS[self as usize].2
    }

    /// The kind's identifier for programs.
    pub fn word(self) -> &'static str {
        Self::WORDS[self as usize].1
    }
}

impl FromStr for Kind {
    type Err = String;

    fn from_str(word: &str) -> Result<Self, String> {
        let known = Self::WORDS.into_iter().find(|(_, known, _)| *known == word);
        known.map(|(kind, ..)| kind).ok_or_else(|| {
            let words = Self::WORDS.map(|(_, word, _)| word);
            let near = did_you_mean(word, words);
            format!("kind: found {word:?}, expected one of {}{near}", words.join(", "))
        })
    }
}

/// The result of checking a document.
#[derive(Debug)]
pub struct Checked {
    /// The recognised kind.
    pub kind: Kind,
    /// Warnings.
    pub warnings: Vec<String>,
    /// The error; `None` if it is valid.
    pub error: Option<SpecError>,
    /// Two variants of an otherwise valid scenario that have the same name in logs.
    pub same_log_name: Option<CurriculumError>,
    /// Tasks of a scenario that were not found or not readable, as sentences; their variants were not checked.
    pub missing_tasks: Vec<String>,
}

/// Checks a document. `name` is its name in messages; `task` finds the tasks that a scenario names, whose variants are checked
/// if found; `classes` are those allowed for objects of tasks and of our worlds.
pub fn check(
    name: &str,
    text: &str,
    kind: Kind,
    task: &mut dyn FnMut(&str) -> Result<Arc<TaskSpec>, TaskError>,
    classes: &Classes,
) -> Checked {
    let mut warnings = Vec::new();
    let mut same_log_name = None;
    let mut missing_tasks = Vec::new();
    let error = match kind {
        Kind::Task => match TaskSpec::from_json_with(name, text, Some(classes)) {
            Ok(task) => {
                warnings.extend(alike_in_logs(name, &task));
                warnings.extend(without_elements(name, &task));
                None
            }
            Err(error) => Some(error),
        },
        Kind::World => take_warnings(
            World::from_json_with(name, text, Some(classes)).map(|world| {
                let odd = world.remarks(name, text);
                (world, odd)
            }),
            &mut warnings,
        ),
        Kind::Maps => MapLibrary::from_json(name, text).err(),
        Kind::Scenario => {
            let mut found: BTreeMap<String, Arc<TaskSpec>> = BTreeMap::new();
            let read = Scenario::from_json_with(name, text, |called| {
                let unchecked = |error| {
                    format!(
                        "{}: the variants of {} were not checked: {error}",
                        one_line(name),
                        one_line(called)
                    )
                };
                let task = task(called)
                    .map_err(|error| missing_tasks.push(unchecked(error)))
                    .ok()?;
                found.insert(called.to_owned(), Arc::clone(&task));
                Some(task)
            });
            match read {
                Ok(scenario) => {
                    same_log_name = driftworld_curriculum::same_log_name(&scenario, |called| task(called).ok());
                    // A run would refuse tasks with objects of unknown classes.
                    let mut tasks = found.iter();
                    tasks.find_map(|(called, task)| crate::tasks::check_classes(called, task, classes).err())
                }
                Err(error) => Some(error),
            }
        }
        Kind::L2ExplorerWorld => {
            let read = World::from_l2explorer(name, text);
            // L2Explorer accepts unknown classes, so here they only cause warnings.
            if let Ok((world, _)) = &read {
                let unknown = world.unknown_classes(classes).into_iter();
                let unknown =
                    unknown.map(|odd| format!("{name} ({}): {}; a placeholder is shown", odd.pointer, odd.found));
                warnings.extend(unknown);
            }
            take_warnings(read, &mut warnings)
        }
        Kind::L2ExplorerScenario => take_warnings(Scenario::from_l2explorer(name, text), &mut warnings),
    };
    Checked {
        kind,
        warnings,
        error,
        same_log_name,
        missing_tasks,
    }
}

/// Warns if the agent of a valid world starts inside a solid object. This needs the catalogue, which defines the object's body.
pub fn start_inside(name: &str, text: &str, catalogue: &Catalogue) -> Option<String> {
    let world = World::from_json(name, text).ok()?;
    let warnings = Environment::with_catalogue(world, catalogue.clone()).warnings();
    let is_in_object = |warning: &&Warning| {
        matches!(
            warning,
            Warning::StartsInside {
                obstacle: Obstacle::Object { .. }
            }
        )
    };
    let found = warnings.iter().find(is_in_object)?;
    Some(format!("{name}: {found}"))
}

/// Warnings about parameters that declare no effect.
fn without_elements(document: &str, task: &TaskSpec) -> Vec<String> {
    let none = |(_, parameter): &(&String, &Parameter)| parameter.role != Role::Fixed && parameter.affects.is_empty();
    let odd = task.parameters().iter().filter(none).map(|(name, _)| {
        format!(
            "{}: parameter {name} affects no element, expected some, such as [\"S\"]; no distance by elements counts it",
            one_line(document)
        )
    });
    odd.collect()
}

/// Warnings about variants of a task that cannot be in one scenario, because their names in logs are equal.
fn alike_in_logs(document: &str, task: &TaskSpec) -> Vec<String> {
    let mut known: BTreeMap<String, &str> = BTreeMap::new();
    let names = task.variant_names().into_iter();
    let alike = names.filter_map(|variant| {
        let name = log_name(task.name(), variant);
        let other = known.insert(name.clone(), variant)?;
        Some(format!(
            "{document}: the variants {other:?} and {variant:?} have the same name in logs, {name}, so no scenario \
             can have both; rename one"
        ))
    });
    alike.collect()
}

/// Returns the error of a document that was read; appends its warnings to `warnings`.
fn take_warnings<T, W: ToString>(
    read: Result<(T, Vec<W>), SpecError>,
    warnings: &mut Vec<String>,
) -> Option<SpecError> {
    match read {
        Ok((_, found)) => {
            warnings.extend(found.iter().map(ToString::to_string));
            None
        }
        Err(error) => Some(error),
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::tasks;

    #[test]
    fn kind_is_recognised_by_keys() {
        let check = |text: &str, expected: Kind| assert_eq!(Kind::of(text), expected, "{text}");
        check(r#"{ "blocks": [] }"#, Kind::Scenario);
        check(r#"{ "maps": [] }"#, Kind::Maps);
        check(r#"{ "name": "t" }"#, Kind::Task);
        check(r#"{ "objects": [] }"#, Kind::World);
        check("\u{feff}{ \"blocks\": [] }", Kind::Scenario);
        check("{", Kind::World);
    }

    #[test]
    fn every_kind_is_found_by_its_word() {
        for (kind, word, _) in Kind::WORDS {
            assert_eq!((kind.word(), word.parse()), (word, Ok(kind)));
        }
        let refused = "scenrio".parse::<Kind>().unwrap_err();
        assert!(refused.ends_with("did you mean \"scenario\"?"), "{refused}");
    }

    #[test]
    fn immobile_movers_and_objects_in_walls_cause_remarks() {
        let text = r#"{ "environment_params": { "predefined_map": 2 }, "objects": [
            { "class": "car", "coordinates": [0, 0], "motion_model": "predator" },
            { "class": "car", "coordinates": [0, 0], "motion_model": "patrol", "speed": 1 },
            { "class": "car", "coordinates": [-70, 60], "motion_model": "prey", "speed": 1 }] }"#;
        let found = check(
            "w.json",
            text,
            Kind::World,
            &mut tasks::task,
            &tasks::classes(&driftworld_env::Catalogue::default()),
        );
        assert!(found.error.is_none(), "{:?}", found.error);
        let [no_speed, no_way, walled] = found.warnings.as_slice() else {
            panic!("{:?}", found.warnings)
        };
        assert!(
            no_speed.starts_with("w.json:2:70 (/objects/0/motion_model)"),
            "{no_speed}"
        );
        assert!(no_way.contains("set \"waypoints\""), "{no_way}");
        assert!(walled.contains("inside region 1 of 12 of map 2 (village)"), "{walled}");
    }

    #[test]
    fn scenario_variants_are_checked_if_the_task_is_found() {
        let text = r#"{ "name": "s", "blocks": [{ "type": "learning", "regimes": [
            { "task": "find_objects", "variant": "rde", "count": 1 }, { "task": "nowhere", "variant": "x", "count": 1 }] }] }"#;
        let found = check("s.json", text, Kind::Scenario, &mut tasks::task, &Classes::default());
        let error = found.error.expect("there is no such variant").to_string();
        assert!(error.contains("did you mean \"red\"?"), "{error}");
        assert_eq!(found.missing_tasks.len(), 1, "{:?}", found.missing_tasks);
    }
}
