//! Reads scenario files, ours and L2Explorer's, and finds the tasks and world files that they name.

use std::borrow::Cow;
use std::collections::BTreeMap;
use std::path::{Path, PathBuf};
use std::sync::Arc;

use driftworld_curriculum::{CurriculumError, FoundWorld, Plan, Sources, Undrawable};
use driftworld_spec::{Scenario, SpecError, TaskSpec, World, nearest};
use driftworld_text::ShownPath;

use crate::contents::Contents;
use crate::documents::{self, DocumentError, Kind};
use crate::tasks::{self, TaskError};
use crate::worlds;

/// Maximum number of files read in search of a world file with a name similar to the missing one's.
const MAX_READ: usize = 8;

/// Receives warnings.
pub type Warn<'a> = &'a mut dyn FnMut(String);

/// A scenario, with the path from which its tasks and world files are resolved.
#[derive(Clone, Debug)]
pub struct ScenarioFile {
    /// The scenario.
    pub scenario: Scenario,
    path: PathBuf,
    /// Whether the file, and therefore its world files, are in L2Explorer's format.
    pub original: bool,
}

impl ScenarioFile {
    /// Reads a scenario file in our format or in L2Explorer's.
    ///
    /// # Errors
    /// [`DocumentError`] if it cannot be read or is invalid.
    pub fn read(path: &Path, warn: Warn) -> Result<Self, DocumentError> {
        Ok(Self::from_text(
            path,
            &documents::text_of(path, &[Contents::Scenario])?,
            warn,
        )?)
    }

    /// Parses a scenario's text; paths in it are resolved as if it were at `path`.
    ///
    /// # Errors
    /// [`SpecError`] with all faults.
    pub fn from_text(path: &Path, text: &str, warn: Warn) -> Result<Self, SpecError> {
        let name = documents::name_of(path);
        let original = is_original(text);
        let scenario = if original {
            let (scenario, warnings) = Scenario::from_l2explorer(&name, text)?;
            for warning in &warnings {
                warn(warning.to_string());
            }
            scenario
        } else {
            // Check against the tasks that can be found, so that all of their missing variants are reported at once.
            Scenario::from_json_with(&name, text, |task| task_from(path, task).ok())?
        };
        Ok(Self {
            scenario,
            path: path.to_owned(),
            original,
        })
    }

    /// Replaces the scenario, as if it were in the same file.
    #[must_use]
    pub fn with_scenario(&self, scenario: &Scenario) -> Self {
        Self {
            scenario: scenario.clone(),
            ..self.clone()
        }
    }

    /// Whether a file is a scenario, in either format.
    pub fn is_one(path: &Path) -> bool {
        let text = documents::text(path).unwrap_or_default();
        Contents::of_text(&text) == Some(Contents::Scenario)
    }

    /// Plans the scenario with everything that it names. A missing world file is an error unless the file with the most similar
    /// name `may_stand_in` for it.
    ///
    /// # Errors
    /// As [`Plan::with_undrawable`].
    pub fn plan(&self, may_stand_in: bool, undrawable: Undrawable, warn: Warn) -> Result<Plan, CurriculumError> {
        self.plan_named(may_stand_in, undrawable, warn).map(|(plan, _)| plan)
    }

    /// Like [`Self::plan`], but also returns the tasks and world files found, by their names in the scenario.
    ///
    /// # Errors
    /// As [`Plan::with_undrawable`].
    pub fn plan_named(
        &self,
        may_stand_in: bool,
        undrawable: Undrawable,
        warn: Warn,
    ) -> Result<(Plan, Named), CurriculumError> {
        let mut named = Named::default();
        let (tasks, worlds) = (&mut named.tasks, &mut named.worlds);
        let mut sources = Sources {
            task: &mut |name| {
                let task = task_from(&self.path, name).map_err(|error| error.to_string())?;
                tasks.insert(name.to_owned(), Arc::clone(&task));
                Ok(task)
            },
            world: &mut |path| {
                let found = self.world(path, may_stand_in, warn)?;
                worlds.insert(path.to_owned(), found.clone());
                Ok(found)
            },
        };
        let plan = Plan::with_undrawable(&self.scenario, &mut sources, undrawable)?;
        Ok((plan, named))
    }

    /// The world file that a regime names, relative to the scenario's folder, or else directly beside the scenario.
    fn world(&self, named: &str, may_stand_in: bool, warn: Warn) -> Result<FoundWorld, String> {
        let folder = self.path.parent().unwrap_or(Path::new(""));
        let named = Path::new(named);
        let beside = named.file_name().map_or_else(PathBuf::new, |name| folder.join(name));
        let expected = folder.join(named);
        let found = |path: &Path, note| {
            let world = self.read_world(path)?;
            Ok(FoundWorld { world, note })
        };
        if expected.is_file() {
            return found(&expected, None);
        }
        if beside.is_file() {
            warn(format!(
                "{}: no such file; using {} beside the scenario",
                expected.shown(),
                beside.shown()
            ));
            return found(&beside, None);
        }
        let searched = if expected == beside {
            expected.shown().to_string()
        } else {
            format!("{} and {}", expected.shown(), beside.shown())
        };
        let stand_in = self.nearest(&[&expected, &beside]);
        if let Some(file) = stand_in.as_ref().filter(|_| may_stand_in) {
            let used = file.file_name().unwrap_or_default().to_string_lossy().into_owned();
            let note = format!("not there; {used} stood in for it");
            warn(format!("{}: {note}", named.shown()));
            return found(file, Some(note));
        }
        let option = if self.original {
            "omit --no-stand-in"
        } else {
            "add --stand-in"
        };
        let advice = stand_in.map_or_else(String::new, |file| format!("; or {option} to use {}", file.shown()));
        Err(format!(
            "found no file {:?}, looked for {searched}, expected a world file; create it{advice}",
            named.display().to_string()
        ))
    }

    /// The world file with the most similar name in the folders that were searched.
    fn nearest(&self, wanted: &[&PathBuf]) -> Option<PathBuf> {
        wanted.iter().find_map(|wanted| {
            let name = wanted.file_name()?.to_string_lossy().into_owned();
            let folder = Some(documents::folder_of(wanted)).filter(|folder| folder.is_dir())?;
            let mut files = worlds::json_files(folder).unwrap_or_default();
            // Only files with similar names are read: a folder may contain anything.
            for _ in 0..MAX_READ {
                let names = files
                    .iter()
                    .map(|file| file.file_name().unwrap_or_default().to_string_lossy());
                let names: Vec<String> = names.map(Cow::into_owned).collect();
                let near = nearest(&name, &names)?;
                let file = files.remove(names.iter().position(|name| *name == near)?);
                if self.read_world(&file).is_ok() {
                    return Some(file);
                }
            }
            None
        })
    }

    fn read_world(&self, path: &Path) -> Result<World, String> {
        let name = path.display().to_string();
        let text = documents::text_of(path, &[Contents::World]).map_err(|error| error.to_string())?;
        let theirs = || World::from_l2explorer(&name, &text).map(|(world, _)| world);
        if self.original {
            return theirs().map_err(|error| error.to_string());
        }
        World::from_json(&name, &text).or_else(|ours| theirs().map_err(|_| ours.to_string()))
    }
}

/// The tasks and world files that a scenario names. With them it can be planned again even if the files change.
#[derive(Clone, Debug, Default)]
pub struct Named {
    /// Its tasks.
    pub tasks: BTreeMap<String, Arc<TaskSpec>>,
    /// Its world files.
    pub worlds: BTreeMap<String, FoundWorld>,
}

impl Named {
    /// Plans the scenario with these tasks and world files.
    ///
    /// # Errors
    /// As [`Plan::with_undrawable`], and if a task or world file is missing.
    pub fn plan(&self, scenario: &Scenario, undrawable: Undrawable) -> Result<Plan, CurriculumError> {
        let missing = |name: &str| format!("found {name:?}, expected a task that the scenario was read with");
        let mut sources = Sources {
            task: &mut |name| self.tasks.get(name).cloned().ok_or_else(|| missing(name)),
            world: &mut |path| self.worlds.get(path).cloned().ok_or_else(|| missing(path)),
        };
        Plan::with_undrawable(scenario, &mut sources, undrawable)
    }
}

/// The task that a scenario names: a built-in one, a file relative to the scenario's folder, or one relative to the working
/// folder.
///
/// # Errors
/// [`TaskError`] if there is none, or the document is invalid.
pub fn task_from(scenario: &Path, name: &str) -> Result<Arc<TaskSpec>, TaskError> {
    let there = scenario.parent().unwrap_or(Path::new("")).join(name);
    if tasks::text_by_name(name).is_none()
        && there.is_file()
        && let Some(path) = there.to_str()
    {
        return tasks::task(path);
    }
    tasks::task(name)
}

/// The plan of a scenario without world files, whose tasks are built in or given by paths from the working folder.
///
/// # Errors
/// As [`Plan::with_undrawable`].
pub fn plan(scenario: &Scenario, undrawable: Undrawable) -> Result<Plan, CurriculumError> {
    let mut sources = Sources {
        task: &mut |name| tasks::task(name).map_err(|error| error.to_string()),
        world: &mut |path| {
            Err(format!(
                "found the world file {path:?}, expected only variants of tasks"
            ))
        },
    };
    Plan::with_undrawable(scenario, &mut sources, undrawable)
}

/// Whether a text is a scenario in L2Explorer's format.
pub fn is_original(text: &str) -> bool {
    Kind::of(text) == Kind::L2ExplorerScenario
}
