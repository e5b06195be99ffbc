//! The developer commands: `cargo xtask test`, its individual stages, and the generators of committed files.
#![expect(
    clippy::print_stdout,
    clippy::print_stderr,
    reason = "a command prints to its terminal"
)]

mod examples;
mod fences;
mod process;
mod python;
mod rooms;
mod runner;
mod schemas;
mod size;
mod sources;
mod stage;
mod stages;
mod studio;
mod unity;
mod unreached;

use std::env;
use std::path::PathBuf;
use std::process::ExitCode;

use process::{Result, Workspace, metadata};
use stage::Stage;
use stages::STAGES;

const USAGE: &str = "\
Usage:
  cargo xtask test                  what every change must pass: the quick stages in order, up to the first failure
  cargo xtask test --all            all stages, with all features and tests at full size: CI runs this
  cargo xtask test --only STAGE     one stage (may be repeated, and combined with --all)
  cargo xtask test --list           the stages and what each checks
  cargo xtask STAGE                 the same as `test --only STAGE`, except for the three below
  cargo xtask schemas               rewrite schemas/*.json and docs/reference/*.md from the Rust types
  cargo xtask size                  update the line counts in SIZE.md
  cargo xtask studio                build the workbench page into target/studio (needs Node.js and a rustup target)

CONTRIBUTING.md has the commands for benches, fuzzing, sanitizers, pictures and releases.";

fn main() -> ExitCode {
    let arguments: Vec<String> = env::args().skip(1).collect();
    let words: Vec<&str> = arguments.iter().map(String::as_str).collect();
    let done = match words[..] {
        ["-h" | "--help" | "help"] => {
            println!("{USAGE}");
            Ok(())
        }
        ["test", "--list"] => {
            stages::list();
            Ok(())
        }
        ["schemas"] => workspace(false).and_then(|workspace| schemas::rewrite(&workspace)),
        ["size"] => workspace(false).and_then(|workspace| size::rewrite(&workspace)),
        ["studio"] => workspace(false).and_then(|workspace| {
            studio::build(&workspace)?;
            studio::print_location(&workspace);
            Ok(())
        }),
        _ => match parse(&words) {
            Ok((stages, is_full)) => workspace(is_full).and_then(|workspace| stages::run_all(&workspace, &stages)),
            Err(complaint) => {
                eprintln!("xtask: {complaint}\n\n{USAGE}");
                return ExitCode::from(2);
            }
        },
    };
    if let Err(error) = done {
        eprintln!("xtask: {error}");
        return ExitCode::FAILURE;
    }
    ExitCode::SUCCESS
}

/// The stages named by the arguments, and whether `--all` is given.
fn parse(words: &[&str]) -> Result<(Vec<&'static Stage>, bool)> {
    let named = |name: &str| {
        let known = || STAGES.map(|stage| stage.name).join(", ");
        let stage = STAGES.iter().find(|stage| stage.name == name);
        stage.ok_or_else(|| format!("found unknown stage `{name}`, expected one of {}", known()))
    };
    let mut words = match words {
        [] => return Err("found no command".into()),
        ["test", rest @ ..] => rest.iter(),
        [name] => return Ok((vec![named(name)?], false)),
        [name, ..] => return Err(format!("found arguments after `{name}`, which takes none")),
    };
    let (mut only, mut is_full) = (Vec::new(), false);
    while let Some(word) = words.next() {
        match *word {
            "--all" => is_full = true,
            "--only" => only.push(named(
                words.next().ok_or("found `--only` without the name of a stage")?,
            )?),
            other => return Err(format!("found unknown argument `{other}`")),
        }
    }
    if only.is_empty() {
        only = STAGES.iter().filter(|stage| is_full || stage.is_quick).collect();
    }
    Ok((only, is_full))
}

fn workspace(is_full: bool) -> Result<Workspace> {
    let metadata = metadata()?;
    let folder = |key: &str| PathBuf::from(metadata[key].as_str().unwrap_or_default());
    Ok(Workspace {
        root: folder("workspace_root"),
        target: folder("target_directory"),
        is_full,
    })
}

#[cfg(test)]
mod tests {
    use super::*;

    fn check(words: &str, expected: std::result::Result<(&[&str], bool), &str>) {
        let words: Vec<&str> = words.split_whitespace().collect();
        let found =
            parse(&words).map(|(stages, is_full)| (stages.iter().map(|stage| stage.name).collect::<Vec<_>>(), is_full));
        match (&found, expected) {
            (Err(complaint), Err(part)) => assert!(complaint.contains(part), "{words:?}: {complaint}"),
            _ => assert_eq!(
                found,
                expected
                    .map(|(names, is_full)| (names.to_vec(), is_full))
                    .map_err(str::to_owned)
            ),
        }
    }

    #[test]
    fn stages_are_requested_alone_or_together() {
        let (all, quick): (Vec<_>, Vec<_>) = (
            STAGES.iter().map(|stage| stage.name).collect(),
            STAGES
                .iter()
                .filter(|stage| stage.is_quick)
                .map(|stage| stage.name)
                .collect(),
        );
        check("test", Ok((&quick, false)));
        check("test --all", Ok((&all, true)));
        check("fmt", Ok((&["fmt"], false)));
        check("test --only fmt --only deny", Ok((&["fmt", "deny"], false)));
        check("test --all --only tests", Ok((&["tests"], true)));
    }

    #[test]
    fn unknown_words_are_named() {
        check("", Err("no command"));
        check("bake", Err("unknown stage `bake`, expected one of fmt, clippy"));
        check("fmt now", Err("arguments after `fmt`"));
        check("test --every", Err("unknown argument `--every`"));
        check("test --only", Err("without the name"));
    }
}
