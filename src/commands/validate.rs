//! `driftworld validate`: lists every problem of a document with its location.

use std::path::{Path, PathBuf};
use std::sync::Arc;

use crate::contents::Contents;
use crate::curriculum::{Trial, Tried, Undrawable, try_expert, try_worlds};
use crate::documents::{self, Checked, Kind};
use crate::elements::{ElementsOutcome, ElementsRequest, elements_of};
use crate::scenarios::{ScenarioFile, task_from};
use crate::spec::{Classes, SpecError, TaskSpec};
use crate::{remarks, tasks};
use clap::Args;
use driftworld_text::{ShownPath, printable};
use rayon::prelude::*;
use serde_json::{Value, json};

use super::assets::LibraryChoice;
use crate::{Failure, trials, worlds};

use super::output;

/// Check task specs, worlds, scenarios and maps files.
///
/// Reports every problem with its line and column. The keys of a file tell its kind: "blocks" for a scenario,
/// "scenario" for one of L2Explorer's, "maps" for a maps file, "name" for a task spec, anything else for a world. The
/// variants of a scenario are checked against its tasks if those can be found.
///
/// --worlds also draws worlds: of every variant of a task, and of every regime of a scenario. Along a drift, the
/// variants are checked one by one. A task or scenario fails if one of its worlds cannot be drawn.
///
/// The planner tries the first 100 of a task's worlds. If it does not reach a success that exists, a warning names the
/// worlds: the way may be blocked, too hard for the planner, or not worth taking.
///
/// --elements also tests which elements of the decision process the variants of a task change, as `driftworld elements`
/// does; for a scenario, all variants of its tasks. A file fails if the result contradicts the `affects` of a
/// parameter. A parameter that made no difference is a warning.
///
/// Oddities in a task's worlds are warnings: a zone outside the arena, a switch without a door, a key behind its own
/// door. The first world of each variant is checked, or with --worlds all that are drawn, at most 100.
#[derive(Args)]
#[command(after_help = "Examples:
  driftworld validate examples/tasks
  driftworld validate my_task.json scenario.json --worlds 100
  driftworld validate my_task.json --elements
  driftworld validate --l2explorer map.json")]
pub(crate) struct Validate {
    /// Files to check, or folders of .json files.
    #[arg(required = true, value_name = "FILE")]
    files: Vec<PathBuf>,
    /// Read worlds in L2Explorer's format, with warnings.
    #[arg(long)]
    l2explorer: bool,
    /// Also draw this many worlds of each variant and regime, and report failures.
    #[arg(long, default_value_t = 0, value_name = "N", value_parser = clap::value_parser!(u32).range(0..=1_000_000))]
    worlds: u32,
    /// Also test which elements of the decision process variants change, and fail if one contradicts `affects`.
    #[arg(long)]
    elements: bool,
    /// Maximum number of steps of an episode with --elements; more steps reveal later differences.
    #[arg(long, requires = "elements", default_value_t = 100, value_name = "N", value_parser = clap::value_parser!(u32).range(1..=100_000))]
    steps: u32,
    /// Seed for worlds of a task's variants. Scenarios have their own.
    #[arg(long, default_value_t = 0, allow_negative_numbers = true, value_parser = crate::numbers::seed)]
    seed: u64,
    #[command(flatten)]
    libraries: LibraryChoice,
    /// Print the result as JSON.
    #[arg(long)]
    json: bool,
}

/// The kinds of documents that are checked. Other recognised kinds are refused.
const DOCUMENTS: [Contents; 4] = [Contents::Task, Contents::World, Contents::Scenario, Contents::Maps];

/// Maximum number of worlds per variant that the planner tries.
const MAX_TRIED_WORLDS: u64 = 100;

/// The result for one file.
struct Verdict {
    path: PathBuf,
    /// The checked document, or why there is none.
    found: Result<Found, Failure>,
}

/// The result for a document that could be read.
struct Found {
    checked: Checked,
    /// A problem not reported in `checked.error`, with its code.
    failure: Option<(&'static str, String)>,
    trials: Vec<Trial>,
    /// Remarks on the worlds of a task or on a world, as sentences.
    remarks: Vec<String>,
    /// The measured effects of variants of the task, or of a scenario's tasks, if requested.
    elements: Vec<ElementsOutcome>,
}

impl Validate {
    pub(crate) fn run(self) -> Result<(), Failure> {
        output::run_to_end_for_exit_code();
        let classes = tasks::classes(&self.libraries.catalogue()?);
        let verdicts: Vec<Verdict> = self.files.iter().flat_map(|path| self.judge(path, &classes)).collect();
        if self.json {
            output::json(&verdicts.iter().map(Verdict::to_json).collect::<Vec<_>>())?;
        } else {
            verdicts.iter().try_for_each(Verdict::print)?;
        }
        let wrong = verdicts.iter().filter(|verdict| !verdict.is_valid()).count();
        if wrong == 0 {
            return Ok(());
        }
        let files = if verdicts.len() == 1 { "file" } else { "files" };
        Err(Failure::input(format!("{wrong} of {} {files} refused", verdicts.len())))
    }

    /// The verdicts on a file, or on the files of a folder, including unreadable ones.
    fn judge(&self, path: &Path, classes: &Classes) -> Vec<Verdict> {
        let files = match Contents::of_folder(path) {
            // `logs validate` checks the files inside a log.
            Some(Contents::Log) => Ok(vec![path.to_owned()]),
            _ => worlds::json_files(path),
        };
        match files {
            Ok(files) => files.into_iter().map(|path| self.verdict(path, classes)).collect(),
            Err(failure) => vec![Verdict {
                path: path.to_owned(),
                found: Err(failure),
            }],
        }
    }

    fn verdict(&self, path: PathBuf, classes: &Classes) -> Verdict {
        let found = self.check(&path, classes);
        Verdict { path, found }
    }

    fn check(&self, path: &Path, classes: &Classes) -> Result<Found, Failure> {
        let text = documents::text_of(path, &DOCUMENTS)?;
        let name = printable(&documents::name_of(path)).into_owned();
        let kind = match Kind::of(&text) {
            Kind::World if self.l2explorer => Kind::L2ExplorerWorld,
            kind => kind,
        };
        let checked = documents::check(&name, &text, kind, &mut |task| task_from(path, task), classes);
        let mut failure = checked
            .same_log_name
            .as_ref()
            .map(|error| (error.code(), format!("{name}: {error}")));
        if let (None, Some(missing)) = (&failure, checked.missing_tasks.first()) {
            failure = Some(("document/no-task", missing.clone()));
        }
        let mut trials = Vec::new();
        if self.worlds > 0 && checked.error.is_none() && failure.is_none() {
            match self.try_worlds(path, &text, checked.kind, classes) {
                Ok(found) => trials = found,
                Err((code, why)) => failure = Some((code, format!("{name}: {why}"))),
            }
        }
        let mut remarks = Vec::new();
        let is_sound = checked.error.is_none() && failure.is_none();
        if is_sound && checked.kind == Kind::Task {
            let task = TaskSpec::from_json(&name, &text)?;
            remarks = remarks::of_task(&task, self.seed, u64::from(self.worlds));
        } else if is_sound && checked.kind == Kind::World {
            remarks.extend(documents::start_inside(&name, &text, &self.libraries.catalogue()?));
        }
        let mut elements = Vec::new();
        let is_drawn = trials.iter().all(|trial| trial.num_failed() == 0);
        if self.elements && is_sound && is_drawn {
            match self.try_elements(path, &name, &text, checked.kind) {
                Ok(found) => elements = found,
                Err(why) => failure = Some(("document/elements", format!("{name}: {}", why.for_command()))),
            }
        }
        Ok(Found {
            checked,
            failure,
            trials,
            remarks,
            elements,
        })
    }

    /// Measures what the variants of a valid task change, or those of each task in a scenario.
    fn try_elements(&self, path: &Path, name: &str, text: &str, kind: Kind) -> Result<Vec<ElementsOutcome>, Failure> {
        let tasks = match kind {
            Kind::Task => vec![TaskSpec::from_json(name, text)?],
            Kind::Scenario => {
                let warn = &mut |_| {};
                let file = ScenarioFile::from_text(path, text, warn)?;
                let plan = file.plan(false, Undrawable::Skipped, warn)?;
                plan.tasks().values().map(Arc::clone).collect()
            }
            // L2Explorer's scenarios, worlds and maps make no claims about elements.
            Kind::L2ExplorerScenario | Kind::World | Kind::Maps | Kind::L2ExplorerWorld => Vec::new(),
        };
        let outcomes = tasks.iter().map(|task| {
            let request = ElementsRequest {
                seed: self.seed,
                steps: self.steps,
                libraries: self.libraries.paths().to_vec(),
                // The task's own name: a file name may contain `#`, but all variants are to be tested.
                ..ElementsRequest::of(task.name())
            };
            elements_of(task, &request)
        });
        outcomes.collect()
    }

    /// Draws some worlds of a valid document.
    ///
    /// # Errors
    /// If the document cannot be read or planned; returns the code and the text of the error.
    fn try_worlds(
        &self,
        path: &Path,
        text: &str,
        kind: Kind,
        classes: &Classes,
    ) -> Result<Vec<Trial>, (&'static str, String)> {
        let name = path.shown().to_string();
        match kind {
            Kind::Task => {
                let task = TaskSpec::from_json(&name, text).map_err(|error| (error.code(), error.to_string()))?;
                let variants = task.all_variants();
                let catalogue = self
                    .libraries
                    .catalogue()
                    .map_err(|failure| ("document/unreadable", failure.for_command()))?;
                let worlds = u64::from(self.worlds);
                let tried = variants.par_iter().map(|variant| {
                    let mut trial = try_worlds(variant, self.seed, worlds);
                    trial.expert = Some(try_expert(variant, self.seed, worlds.min(MAX_TRIED_WORLDS), &catalogue));
                    trial
                });
                Ok(tried.collect())
            }
            Kind::Scenario | Kind::L2ExplorerScenario => {
                // Warnings were already given when the document was checked.
                let warn = &mut |_| {};
                let file =
                    ScenarioFile::from_text(path, text, warn).map_err(|error| (error.code(), error.to_string()))?;
                let plan = file.plan(file.original, Undrawable::Skipped, warn);
                let plan = plan.map_err(|error| (error.code(), error.to_string()))?;
                for (task, spec) in plan.tasks() {
                    tasks::check_classes(task, spec, classes).map_err(|error| (error.code(), error.to_string()))?;
                }
                Ok(plan.try_worlds(self.worlds, &mut Tried::default()))
            }
            Kind::World | Kind::Maps | Kind::L2ExplorerWorld => Ok(Vec::new()),
        }
    }
}

impl Found {
    fn is_valid(&self) -> bool {
        let is_drawn = self.trials.iter().all(|trial| trial.num_failed() == 0);
        self.checked.error.is_none() && self.failure.is_none() && is_drawn && self.is_sound()
    }

    /// Whether no experiment contradicts the document.
    fn is_sound(&self) -> bool {
        self.elements.iter().all(ElementsOutcome::is_sound)
    }

    /// Warnings from worlds and experiments, as sentences.
    fn cautions(&self, file: &Path) -> Vec<String> {
        let idle = self.elements.iter().flat_map(ElementsOutcome::warnings);
        let all = self.remarks.iter().cloned().chain(idle);
        all.chain(self.trials.iter().filter_map(|trial| trials::unfinished(trial, file)))
            .collect()
    }
}

impl Verdict {
    fn is_valid(&self) -> bool {
        self.found.as_ref().is_ok_and(Found::is_valid)
    }

    fn print(&self) -> Result<(), Failure> {
        let found = match &self.found {
            Ok(found) => found,
            Err(failure) => {
                output::note(failure.for_command());
                return Ok(());
            }
        };
        let checked = &found.checked;
        checked
            .warnings
            .iter()
            .for_each(|warning| output::note(format!("warning: {warning}")));
        let wrong = checked.error.as_ref().map(ToString::to_string);
        if let Some(wrong) = wrong.or_else(|| found.failure.as_ref().map(|(_, text)| text.clone())) {
            output::note(wrong);
            return Ok(());
        }
        let (path, kind) = (
            printable(&documents::name_of(&self.path)).into_owned(),
            checked.kind.name(),
        );
        for warning in &found.cautions(&self.path) {
            output::warning(format!("{path}: {warning}"));
        }
        if !found.is_sound() {
            let found = found.elements.iter().flat_map(ElementsOutcome::contradictions);
            found.for_each(|contradiction| output::note(format!("{path}: {contradiction}")));
            return Ok(());
        }
        match trials::summary(&found.trials) {
            Some(summary) => output::note(format!("{path}: a {kind} of which {summary}")),
            None => output::line(format!("{path}: a valid {kind}"))?,
        }
        if found.trials.is_empty() {
            return Ok(());
        }
        output::line(trials::shown(&found.trials))
    }

    fn to_json(&self) -> Value {
        let found = match &self.found {
            Ok(found) => found,
            Err(failure) => {
                let problem = json!({ "code": "document/unreadable", "message": failure.for_command() });
                return json!({ "file": self.path, "kind": null, "valid": false, "problems": [problem], "warnings": [] });
            }
        };
        let checked = &found.checked;
        let failure = found
            .failure
            .iter()
            .map(|(code, text)| json!({ "code": code, "message": text }));
        let problems = checked.error.as_ref().map(|error| {
            let listed: Vec<Value> = error.problems().iter().map(|problem| json!(problem)).collect();
            if listed.is_empty() {
                vec![json!({ "code": error.code(), "message": error.to_string() })]
            } else {
                listed
            }
        });
        let mut report = json!({
            "file": self.path, "kind": checked.kind.name(), "valid": found.is_valid(),
            "problems": problems.unwrap_or_else(|| failure.collect()), "warnings": checked.warnings,
        });
        if checked.error.as_ref().is_some_and(SpecError::has_more) {
            report["more_problems"] = json!(true);
        }
        if !found.trials.is_empty() {
            report["worlds"] = json!(found.trials);
        }
        if let Some(warnings) = report["warnings"].as_array_mut() {
            warnings.extend(found.cautions(&self.path).into_iter().map(Value::from));
        }
        if !found.elements.is_empty() {
            let contradiction = |message: &str| json!({ "code": "task/elements", "message": message });
            if let Some(problems) = report["problems"].as_array_mut() {
                let all = found.elements.iter().flat_map(ElementsOutcome::contradictions);
                problems.extend(all.map(contradiction));
            }
            report["elements"] = match (checked.kind, found.elements.as_slice()) {
                (Kind::Task, [own]) => json!(own),
                (_, all) => json!(all),
            };
        }
        report
    }
}
