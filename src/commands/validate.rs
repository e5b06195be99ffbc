//! `driftworld validate`: every problem of a document with its place.

use std::path::PathBuf;

use crate::documents::{self, Checked, Kind};
use crate::scenarios::task_from;
use crate::spec::Problem;
use clap::Args;
use serde_json::{Value, json};

use super::{Failure, input, output};

/// Check task specs, worlds, scenarios and maps files, and name every problem with its place.
///
/// What a file is, is seen from its keys: "blocks" make a scenario, "scenario" one of L2Explorer's, "maps" a maps file, "name" a
/// task spec, anything else a world. The variants that a scenario names are checked against its tasks, where those can be found.
#[derive(Args)]
#[command(after_help = "Example:\n  driftworld validate examples/tasks\n  driftworld validate --l2explorer map.json")]
pub(crate) struct Validate {
    /// Files, or folders of .json files.
    #[arg(required = true, value_name = "FILE")]
    files: Vec<PathBuf>,
    /// Read worlds as L2Explorer wrote them, with warnings.
    #[arg(long)]
    l2explorer: bool,
    /// Print the result as JSON.
    #[arg(long)]
    json: bool,
}

/// What was found in one file.
struct Verdict {
    path: PathBuf,
    checked: Checked,
}

impl Validate {
    pub(crate) fn run(self) -> Result<(), Failure> {
        let files = files(&self.files)?;
        let verdicts = files
            .into_iter()
            .map(|path| self.check(path))
            .collect::<Result<Vec<_>, _>>()?;
        if self.json {
            output::json(&verdicts.iter().map(Verdict::to_json).collect::<Vec<_>>())?;
        } else {
            verdicts.iter().try_for_each(Verdict::print)?;
        }
        let wrong = verdicts
            .iter()
            .filter(|verdict| verdict.checked.error.is_some())
            .count();
        if wrong == 0 {
            return Ok(());
        }
        let files = if verdicts.len() == 1 { "file" } else { "files" };
        Err(Failure::input(format!("{wrong} of {} {files} refused", verdicts.len())))
    }

    fn check(&self, path: PathBuf) -> Result<Verdict, Failure> {
        let text = input::text(&path)?;
        let name = path.display().to_string();
        let kind = match Kind::of(&text) {
            Kind::World if self.l2explorer => Kind::L2ExplorerWorld,
            kind => kind,
        };
        let checked = documents::check(&name, &text, kind, &mut |task| task_from(&path, task));
        Ok(Verdict { path, checked })
    }
}

/// The files named, and those of the folders named, sorted.
fn files(paths: &[PathBuf]) -> Result<Vec<PathBuf>, Failure> {
    let mut files = Vec::new();
    for path in paths {
        files.append(&mut input::json_files(path)?);
    }
    Ok(files)
}

impl Verdict {
    fn print(&self) -> Result<(), Failure> {
        self.checked
            .warnings
            .iter()
            .for_each(|warning| output::note(format!("warning: {warning}")));
        match &self.checked.error {
            None => output::line(format!("{}: a valid {}", self.path.display(), self.checked.kind.name())),
            Some(error) => {
                output::note(error.to_string());
                Ok(())
            }
        }
    }

    fn to_json(&self) -> Value {
        let problems = self.checked.error.as_ref().map(|error| {
            let listed: Vec<Value> = error.problems().iter().map(problem_json).collect();
            if listed.is_empty() {
                vec![json!({ "code": error.code(), "message": error.to_string() })]
            } else {
                listed
            }
        });
        json!({
            "file": self.path, "kind": self.checked.kind.name(), "valid": self.checked.error.is_none(),
            "problems": problems.unwrap_or_default(), "warnings": self.checked.warnings,
        })
    }
}

fn problem_json(problem: &Problem) -> Value {
    json!({
        "code": problem.code, "pointer": problem.pointer, "line": problem.line, "column": problem.column,
        "found": problem.found, "expected": problem.expected, "advice": problem.advice,
    })
}
