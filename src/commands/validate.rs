//! `driftworld validate`: every problem of a document with its place.

use std::path::{Path, PathBuf};

use crate::contents::Contents;
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

/// What is judged; anything else that shows what it is, is refused as such.
const DOCUMENTS: [Contents; 4] = [Contents::Task, Contents::World, Contents::Scenario, Contents::Maps];

/// What was found in one file.
struct Verdict {
    path: PathBuf,
    /// What the document came to, or why there is none.
    found: Result<Checked, Failure>,
}

impl Validate {
    pub(crate) fn run(self) -> Result<(), Failure> {
        let verdicts: Vec<Verdict> = self.files.iter().flat_map(|path| self.judge(path)).collect();
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

    /// The verdicts on a file, or on the files of a folder; also on what cannot be read, so that no file goes without.
    fn judge(&self, path: &Path) -> Vec<Verdict> {
        let files = match Contents::of_folder(path) {
            // What lies in a log is no document of ours, and `logs validate` judges it.
            Some(Contents::Log) => Ok(vec![path.to_owned()]),
            _ => input::json_files(path),
        };
        match files {
            Ok(files) => files.into_iter().map(|path| self.verdict(path)).collect(),
            Err(failure) => vec![Verdict {
                path: path.to_owned(),
                found: Err(failure),
            }],
        }
    }

    fn verdict(&self, path: PathBuf) -> Verdict {
        let found = self.check(&path);
        Verdict { path, found }
    }

    fn check(&self, path: &Path) -> Result<Checked, Failure> {
        let text = documents::text_of(path, &DOCUMENTS)?;
        let name = path.display().to_string();
        let kind = match Kind::of(&text) {
            Kind::World if self.l2explorer => Kind::L2ExplorerWorld,
            kind => kind,
        };
        Ok(documents::check(&name, &text, kind, &mut |task| task_from(path, task)))
    }
}

impl Verdict {
    fn is_valid(&self) -> bool {
        self.found.as_ref().is_ok_and(|checked| checked.error.is_none())
    }

    fn print(&self) -> Result<(), Failure> {
        let checked = match &self.found {
            Ok(checked) => checked,
            Err(failure) => {
                output::note(failure.text());
                return Ok(());
            }
        };
        checked
            .warnings
            .iter()
            .for_each(|warning| output::note(format!("warning: {warning}")));
        match &checked.error {
            None => output::line(format!("{}: a valid {}", self.path.display(), checked.kind.name())),
            Some(error) => {
                output::note(error.to_string());
                Ok(())
            }
        }
    }

    fn to_json(&self) -> Value {
        let checked = match &self.found {
            Ok(checked) => checked,
            Err(failure) => {
                let problem = json!({ "code": "document/unreadable", "message": failure.text() });
                return json!({ "file": self.path, "kind": null, "valid": false, "problems": [problem], "warnings": [] });
            }
        };
        let problems = checked.error.as_ref().map(|error| {
            let listed: Vec<Value> = error.problems().iter().map(problem_json).collect();
            if listed.is_empty() {
                vec![json!({ "code": error.code(), "message": error.to_string() })]
            } else {
                listed
            }
        });
        json!({
            "file": self.path, "kind": checked.kind.name(), "valid": checked.error.is_none(),
            "problems": problems.unwrap_or_default(), "warnings": checked.warnings,
        })
    }
}

fn problem_json(problem: &Problem) -> Value {
    json!({
        "code": problem.code, "pointer": problem.pointer, "line": problem.line, "column": problem.column,
        "found": problem.found, "expected": problem.expected, "advice": problem.advice,
    })
}
