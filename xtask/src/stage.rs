//! The stages of `cargo xtask test`: their names, their order, and running them one after the other. What a stage
//! checks stands in its own file, or is one Cargo command below.

use std::time::Instant;

use crate::error::XtaskError;
use crate::outcome::Outcome;
use crate::process::{AS_TESTED, cargo, run};
use crate::workspace::Workspace;
use crate::{book, deny, documents, examples, layers, protocol, python, rebuilds, runner, schemas, size, tidy, unity};

/// One step of `cargo xtask test`.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(crate) enum Stage {
    Fmt,
    Layers,
    Tidy,
    Size,
    Clippy,
    Tests,
    Doctests,
    Docs,
    Examples,
    Schemas,
    Wheel,
    Gpu,
    Benches,
    Documents,
    Protocol,
    Python,
    Learners,
    Unity,
    Deny,
    Rebuilds,
}

impl Stage {
    /// First the quick ones, of these the quickest first; then those that want a graphics driver, several Pythons or
    /// packages of gigabytes.
    pub(crate) const ALL: [Self; 20] = [
        Self::Fmt,
        Self::Layers,
        Self::Tidy,
        Self::Size,
        Self::Clippy,
        Self::Tests,
        Self::Doctests,
        Self::Docs,
        Self::Examples,
        Self::Schemas,
        Self::Wheel,
        Self::Gpu,
        Self::Benches,
        Self::Documents,
        Self::Protocol,
        Self::Python,
        Self::Learners,
        Self::Unity,
        Self::Deny,
        Self::Rebuilds,
    ];

    /// What a change has to pass: the stages up to the wheel, in minutes.
    pub(crate) fn quick() -> &'static [Self] {
        let last = Self::ALL.iter().position(|stage| *stage == Self::Wheel);
        &Self::ALL[..=last.expect("the wheel is one of all stages")]
    }

    /// The word after `--only`.
    pub(crate) fn name(self) -> &'static str {
        match self {
            Self::Fmt => "fmt",
            Self::Layers => "layers",
            Self::Tidy => "tidy",
            Self::Size => "size",
            Self::Clippy => "clippy",
            Self::Tests => "tests",
            Self::Gpu => "gpu",
            Self::Doctests => "doctests",
            Self::Docs => "docs",
            Self::Examples => "examples",
            Self::Benches => "benches",
            Self::Schemas => "schemas",
            Self::Wheel => "wheel",
            Self::Documents => "documents",
            Self::Protocol => "protocol",
            Self::Python => "python",
            Self::Learners => "learners",
            Self::Unity => "unity",
            Self::Deny => "deny",
            Self::Rebuilds => "rebuilds",
        }
    }

    /// What holds when the stage passes.
    pub(crate) fn about(self) -> &'static str {
        match self {
            Self::Fmt => "every file is formatted by rustfmt",
            Self::Layers => "crates import only what their floor allows, and versions live in the root Cargo.toml",
            Self::Tidy => "files open with their purpose, carry telling names, and link to what exists",
            Self::Size => "no room has more lines of code than SIZE.md allows",
            Self::Clippy => "no compiler or clippy warning in any target, with all features",
            Self::Tests => "unit, integration, property and golden tests pass",
            Self::Gpu => {
                "with the feature gpu, a graphics card draws what the processor draws; skipped without an adapter"
            }
            Self::Doctests => "every example in a doc comment runs",
            Self::Docs => {
                "the documentation builds without a warning, the book of docs/ too, and every link of it leads somewhere"
            }
            Self::Examples => "every program in examples/ ends well in an empty folder",
            Self::Benches => "every bench runs once",
            Self::Schemas => "schemas/*.json and docs/reference/*.md equal what the Rust types generate",
            Self::Documents => "a second validator, in Python, judges tests/documents by the schemas as ours does",
            Self::Wheel => "`pip install ./python` does what the README says",
            Self::Protocol => "unity/src/protocol.rs equals what unity/proto/*.proto make",
            Self::Python => {
                "the Python package is linted and typed, and its tests pass on the newest and the oldest Gymnasium"
            }
            Self::Learners => "the Python tests that need torch, Stable-Baselines3, Minari and Ray pass",
            Self::Unity => {
                "Python clients of ML-Agents, old and new, drive driftworld-unity as they drive a Unity build"
            }
            Self::Deny => {
                "licences, advisories and sources of dependencies are as deny.toml allows; advisories as far as their database can be reached"
            }
            Self::Rebuilds => "no crate of others was built twice under one profile",
        }
    }

    /// The stage of that name, if there is one.
    pub(crate) fn from_name(name: &str) -> Option<Self> {
        Self::ALL.into_iter().find(|stage| stage.name() == name)
    }

    fn run(self, workspace: &Workspace) -> Result<Outcome, XtaskError> {
        let passed = |arguments: &[&str]| run(cargo(workspace, arguments)).map(|()| Outcome::Passed);
        match self {
            Self::Fmt => passed(&["fmt", "--all", "--check"]),
            Self::Layers => layers::stage().map(Outcome::PassedWith),
            Self::Tidy => tidy::stage(workspace).map(Outcome::PassedWith),
            Self::Size => size::check(workspace).map(Outcome::PassedWith),
            Self::Clippy => passed(&[
                "clippy",
                "--workspace",
                "--all-targets",
                "--all-features",
                "--",
                "-D",
                "warnings",
            ]),
            Self::Tests => runner::stage(workspace).map(Outcome::PassedWith),
            // The whole workspace, so that dependencies keep the features they were built with for the stage before.
            Self::Gpu => {
                let only = ["--lib", "--test", "parity"];
                let arguments = [&["test", "--workspace", "--features", "full"], &only[..]].concat();
                passed(&arguments)
            }
            Self::Doctests => passed(&[&["test", "--doc"], &AS_TESTED[..]].concat()),
            Self::Docs => {
                let mut command = cargo(workspace, &["doc", "--workspace", "--no-deps", "--all-features"]);
                command.env("RUSTDOCFLAGS", "-D warnings");
                run(command)?;
                book::build(workspace).map(Outcome::PassedWith)
            }
            Self::Examples => examples::stage(workspace).map(Outcome::PassedWith),
            Self::Benches => passed(&[&["test", "--bench", "*", "--quiet"], &AS_TESTED[..]].concat()),
            Self::Schemas => schemas::check(workspace).map(|()| Outcome::Passed),
            Self::Documents => documents::stage(workspace),
            Self::Wheel => python::wheel(workspace),
            Self::Protocol => protocol::check(workspace).map(|()| Outcome::Passed),
            Self::Python => python::stage(workspace),
            Self::Learners => python::learners(workspace),
            Self::Unity => unity::stage(workspace),
            Self::Deny => deny::stage(workspace),
            Self::Rebuilds => rebuilds::stage(workspace),
        }
    }
}

/// Runs the stages in the given order, stops at the first that fails, and closes with a table of what each did.
pub(crate) fn run_all(workspace: &Workspace, stages: &[Stage]) -> Result<(), XtaskError> {
    let start = Instant::now();
    let mut table = Vec::new();
    let mut in_part = Vec::new();
    for (index, stage) in stages.iter().enumerate() {
        println!("\n{}/{} {}: {}", index + 1, stages.len(), stage.name(), stage.about());
        let stage_start = Instant::now();
        let outcome = stage.run(workspace);
        let seconds = stage_start.elapsed().as_secs_f64();
        let ending = match outcome {
            Ok(Outcome::Passed) => "passed".to_owned(),
            Ok(Outcome::PassedWith(note)) => format!("passed  {note}"),
            Ok(Outcome::Partly(note)) => {
                in_part.push(stage.name());
                format!("passed in part: {note}")
            }
            Ok(Outcome::Skipped(reason)) => format!("skipped: {reason}"),
            Err(source) => {
                return Err(XtaskError::Stage {
                    stage: stage.name(),
                    seconds,
                    source: Box::new(source),
                });
            }
        };
        let place = format!("{}/{}", index + 1, stages.len());
        println!("{place} {} … {seconds:.0} s, {ending}", stage.name());
        table.push(format!("  {:<9} {seconds:>7.1} s  {ending}", stage.name()));
    }
    println!("\n{}", table.join("\n"));
    println!(
        "xtask: {} in {:.1} s",
        verdict(stages.len(), &in_part),
        start.elapsed().as_secs_f64()
    );
    Ok(())
}

fn verdict(count: usize, in_part: &[&str]) -> String {
    match (count, in_part) {
        (1, []) => "the stage passed".into(),
        (1, _) => "the stage passed in part".into(),
        (count, []) => format!("all {count} stages passed"),
        (count, in_part) => format!("all {count} stages passed, in part only: {}", in_part.join(", ")),
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn names_are_unique_and_lead_back_to_their_stage() {
        for stage in Stage::ALL {
            assert_eq!(Stage::from_name(stage.name()), Some(stage));
        }
        assert_eq!(Stage::from_name("bake"), None);
    }

    #[test]
    fn what_passed_in_part_is_not_called_passed() {
        assert_eq!(verdict(1, &[]), "the stage passed");
        assert_eq!(verdict(1, &["deny"]), "the stage passed in part");
        assert_eq!(verdict(3, &[]), "all 3 stages passed");
        assert_eq!(verdict(3, &["deny"]), "all 3 stages passed, in part only: deny");
    }

    #[test]
    fn a_failure_ends_with_the_command_that_reruns_it() {
        let source = Box::new(XtaskError::Findings { count: 3 });
        let message = XtaskError::Stage {
            stage: "layers",
            seconds: 0.25,
            source,
        }
        .to_string();
        assert!(message.starts_with("stage `layers` failed after"), "{message}");
        assert!(message.contains("3 findings"), "{message}");
        assert!(
            message.ends_with("rerun it alone: cargo xtask test --only layers"),
            "{message}"
        );
    }
}
