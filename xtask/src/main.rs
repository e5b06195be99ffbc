//! The developer commands: `cargo xtask test`, each of its stages alone, `cargo xtask schemas`.
//!
//! This file reads the arguments and sets the exit status; what a stage does stands in the file named after it.
#![expect(
    clippy::print_stdout,
    clippy::print_stderr,
    reason = "a command line speaks through its terminal"
)]

mod advisories;
mod book;
mod deny;
mod documents;
mod error;
mod examples;
mod finding;
mod layers;
mod lock;
mod metadata;
mod outcome;
mod process;
mod protocol;
mod python;
mod rebuilds;
mod runner;
mod schemas;
mod size;
mod sources;
mod stage;
mod tidy;
mod unity;
mod unreached;
mod virtual_environment;
mod workspace;

use std::process::ExitCode;

use stage::Stage;
use workspace::Workspace;

const USAGE: &str = "\
Usage:
  cargo xtask test                  what a change has to pass: the quick stages, in order, up to the first that fails
  cargo xtask test --all            these, and those that want a graphics driver, several Pythons or large packages
  cargo xtask test --only STAGE     one stage (may be given several times)
  cargo xtask test --list           the stages and what each holds
  cargo xtask STAGE                 the same as `test --only STAGE`, but for `schemas`, `protocol` and `size`
  cargo xtask schemas               rewrite schemas/*.json and docs/reference/*.md from the Rust types
  cargo xtask size                  write the counts of lines of code in SIZE.md anew
  cargo xtask docs                  the documentation of the crates, and the book of docs/ as target/book/index.html
  cargo xtask protocol              rewrite unity/src/protocol.rs from unity/proto/*.proto
  cargo xtask advisories            check advisories, and write xtask/advisories-checked.txt";

/// What the arguments ask for.
#[derive(Debug, PartialEq)]
enum Request {
    Help,
    List,
    Run(Vec<Stage>),
    RewriteSchemas,
    RewriteProtocol,
    RewriteSize,
    Advisories,
}

fn main() -> ExitCode {
    let arguments: Vec<String> = std::env::args().skip(1).collect();
    match parse(&arguments) {
        Ok(request) => execute(request),
        Err(complaint) => {
            eprintln!("xtask: {complaint}\n\n{USAGE}");
            ExitCode::from(2)
        }
    }
}

/// Turns the arguments (without the program's name) into a request, or says which of them it does not know.
fn parse(arguments: &[String]) -> Result<Request, String> {
    let words: Vec<&str> = arguments.iter().map(String::as_str).collect();
    match words.as_slice() {
        [] => Err("found no command".into()),
        ["-h" | "--help" | "help", ..] => Ok(Request::Help),
        ["schemas"] => Ok(Request::RewriteSchemas),
        ["protocol"] => Ok(Request::RewriteProtocol),
        ["size"] => Ok(Request::RewriteSize),
        ["advisories"] => Ok(Request::Advisories),
        ["test", "--list"] => Ok(Request::List),
        ["test"] => Ok(Request::Run(Stage::quick().to_vec())),
        ["test", "--all"] => Ok(Request::Run(Stage::ALL.to_vec())),
        ["test", rest @ ..] => parse_only(rest).map(Request::Run),
        [name] => parse_stage(name).map(|stage| Request::Run(vec![stage])),
        [name, extra, ..] => match Stage::from_name(name) {
            Some(_) => Err(format!("found `{extra}` after `{name}`, which takes no arguments")),
            None => Err(format!("found unknown command `{name}`")),
        },
    }
}

fn parse_only(words: &[&str]) -> Result<Vec<Stage>, String> {
    let mut stages = Vec::new();
    let mut words = words.iter();
    while let Some(word) = words.next() {
        match (*word, words.next()) {
            ("--only", Some(name)) => stages.push(parse_stage(name)?),
            ("--only", None) => return Err("found `--only` without the name of a stage".into()),
            (other, _) => return Err(format!("found unknown argument `{other}`")),
        }
    }
    Ok(stages)
}

fn parse_stage(name: &str) -> Result<Stage, String> {
    let known = || Stage::ALL.map(Stage::name).join(", ");
    Stage::from_name(name).ok_or_else(|| format!("found unknown stage `{name}`, expected one of {}", known()))
}

fn execute(request: Request) -> ExitCode {
    let outcome = match request {
        Request::Help => {
            println!("{USAGE}");
            return ExitCode::SUCCESS;
        }
        Request::List => {
            for stage in Stage::ALL {
                let tier = if Stage::quick().contains(&stage) {
                    ""
                } else {
                    " (--all)"
                };
                println!("{:<9} {}{tier}", stage.name(), stage.about());
            }
            return ExitCode::SUCCESS;
        }
        Request::Run(stages) => Workspace::load().and_then(|workspace| stage::run_all(&workspace, &stages)),
        Request::RewriteSchemas => Workspace::load().and_then(|workspace| schemas::rewrite(&workspace)),
        Request::RewriteProtocol => Workspace::load().and_then(|workspace| protocol::rewrite(&workspace)),
        Request::RewriteSize => Workspace::load().and_then(|workspace| size::rewrite(&workspace)),
        Request::Advisories => Workspace::load().and_then(|workspace| deny::write_down(&workspace)),
    };
    match outcome {
        Ok(()) => ExitCode::SUCCESS,
        Err(error) => {
            eprintln!("xtask: {error}");
            ExitCode::FAILURE
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn check(words: &str, expected: &Result<Request, &str>) {
        let arguments: Vec<String> = words.split_whitespace().map(String::from).collect();
        let found = parse(&arguments);
        match (&found, expected) {
            (Err(complaint), Err(part)) => assert!(complaint.contains(part), "{words}: {complaint}"),
            _ => assert_eq!(found.as_ref().ok(), expected.as_ref().ok(), "{words}: {found:?}"),
        }
    }

    #[test]
    fn every_stage_can_be_asked_for_alone() {
        for stage in Stage::ALL {
            check(&format!("test --only {}", stage.name()), &Ok(Request::Run(vec![stage])));
            let bare = match stage {
                Stage::Schemas => Request::RewriteSchemas,
                Stage::Protocol => Request::RewriteProtocol,
                Stage::Size => Request::RewriteSize,
                _ => Request::Run(vec![stage]),
            };
            check(stage.name(), &Ok(bare));
        }
        check(
            "test --only fmt --only deny",
            &Ok(Request::Run(vec![Stage::Fmt, Stage::Deny])),
        );
        check("test", &Ok(Request::Run(Stage::quick().to_vec())));
        check("test --all", &Ok(Request::Run(Stage::ALL.to_vec())));
        check("test --list", &Ok(Request::List));
        check("--help", &Ok(Request::Help));
    }

    #[test]
    fn what_is_not_known_is_named() {
        check("", &Err("no command"));
        check("bake", &Err("unknown stage `bake`, expected one of fmt, layers"));
        check("bake bread", &Err("unknown command `bake`"));
        check("fmt now", &Err("`now` after `fmt`"));
        check("test --every", &Err("unknown argument `--every`"));
        check("test --only", &Err("without the name"));
        check("test --only bake", &Err("unknown stage `bake`"));
        check("test --list --only fmt", &Err("unknown argument `--list`"));
    }
}
