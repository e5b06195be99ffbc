//! `driftworld validate`: every problem of a document with its place.

use std::path::PathBuf;

use crate::spec::maps::MapLibrary;
use crate::spec::{Problem, Scenario, SpecError, TaskSpec, World};
use clap::Args;
use serde_json::{Value, json};

use super::scenario_file::task_from;
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
    kind: &'static str,
    warnings: Vec<String>,
    error: Option<SpecError>,
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
        let wrong = verdicts.iter().filter(|verdict| verdict.error.is_some()).count();
        if wrong == 0 {
            return Ok(());
        }
        let files = if verdicts.len() == 1 { "file" } else { "files" };
        Err(Failure::input(format!("{wrong} of {} {files} refused", verdicts.len())))
    }

    fn check(&self, path: PathBuf) -> Result<Verdict, Failure> {
        let text = input::text(&path)?;
        let name = path.display().to_string();
        let mut warnings = Vec::new();
        let (kind, error) = match kind_of(&text) {
            "task spec" => ("task spec", TaskSpec::from_json(&name, &text).err()),
            "L2Explorer scenario" => match Scenario::from_l2explorer(&name, &text) {
                Ok((_, found)) => {
                    warnings = found.iter().map(ToString::to_string).collect();
                    ("L2Explorer scenario", None)
                }
                Err(error) => ("L2Explorer scenario", Some(error)),
            },
            "scenario" => {
                let read = Scenario::from_json_with(&name, &text, |called| {
                    let unchecked = |error| format!("{name}: the variants of {called} are not checked: {error}");
                    task_from(&path, called)
                        .map_err(|error| warnings.push(unchecked(error)))
                        .ok()
                });
                ("scenario", read.err())
            }
            "maps file" => ("maps file", MapLibrary::from_json(&name, &text).err()),
            _ if self.l2explorer => match World::from_l2explorer(&name, &text) {
                Ok((_, found)) => {
                    warnings = found.iter().map(ToString::to_string).collect();
                    ("L2Explorer world", None)
                }
                Err(error) => ("L2Explorer world", Some(error)),
            },
            _ => ("world", World::from_json(&name, &text).err()),
        };
        Ok(Verdict {
            path,
            kind,
            warnings,
            error,
        })
    }
}

fn kind_of(text: &str) -> &'static str {
    let json: Value = serde_json::from_str(text).unwrap_or_default();
    if json.get("blocks").is_some() {
        "scenario"
    } else if Scenario::is_l2explorer(&json) {
        "L2Explorer scenario"
    } else if json.get("maps").is_some() {
        "maps file"
    } else if json.get("name").is_some() || json.get("parameters").is_some() || json.get("groups").is_some() {
        "task spec"
    } else {
        "world"
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
        self.warnings
            .iter()
            .for_each(|warning| output::note(format!("warning: {warning}")));
        match &self.error {
            None => output::line(format!("{}: a valid {}", self.path.display(), self.kind)),
            Some(error) => {
                output::note(error.to_string());
                Ok(())
            }
        }
    }

    fn to_json(&self) -> Value {
        let problems = self.error.as_ref().map(|error| {
            let listed: Vec<Value> = error.problems().iter().map(problem_json).collect();
            if listed.is_empty() {
                vec![json!({ "code": error.code(), "message": error.to_string() })]
            } else {
                listed
            }
        });
        json!({
            "file": self.path, "kind": self.kind, "valid": self.error.is_none(),
            "problems": problems.unwrap_or_default(), "warnings": self.warnings,
        })
    }
}

fn problem_json(problem: &Problem) -> Value {
    json!({
        "code": problem.code, "pointer": problem.pointer, "line": problem.line, "column": problem.column,
        "found": problem.found, "expected": problem.expected, "advice": problem.advice,
    })
}
