//! The stages of `cargo xtask test`: their names, order and execution.

use std::process::Command;
use std::thread;
use std::time::Instant;

use crate::process::{Result, Workspace, run, works};
use crate::stage::{Outcome, Stage, missing};
use crate::{examples, fences, python, runner, schemas, size, studio, unity};

const fn quick(name: &'static str, about: &'static str, run: fn(&Workspace) -> Result<Outcome>) -> Stage {
    Stage {
        name,
        is_quick: true,
        about,
        run,
    }
}

const fn slow(name: &'static str, about: &'static str, run: fn(&Workspace) -> Result<Outcome>) -> Stage {
    Stage {
        is_quick: false,
        ..quick(name, about, run)
    }
}

/// In execution order. With `--all`, everything is built with the feature `full`, so `tests` also compares the renderers.
pub(crate) const STAGES: [Stage; 18] = [
    quick("fmt", "every file is formatted by rustfmt", fmt),
    quick("clippy", "no compiler or clippy warning in any target", clippy),
    quick(
        "fences",
        "crates import only allowed crates, pages name existing files, every public item is used",
        fences::stage,
    ),
    quick(
        "size",
        "no part of the code has more lines than SIZE.md allows",
        size::check,
    ),
    quick(
        "tests",
        "unit, integration, property and golden tests pass",
        runner::stage,
    ),
    quick("doctests", "every example in a doc comment runs", doctests),
    quick(
        "docs",
        "no page has a broken link; with --all, the crates' documentation builds without a warning",
        docs,
    ),
    quick(
        "examples",
        "every program in examples/ runs without error in an empty folder",
        examples::stage,
    ),
    quick(
        "schemas",
        "schemas/*.json and docs/reference/*.md equal what the Rust types generate",
        schemas::check,
    ),
    slow(
        "wheel",
        "`pip install ./python` does what the README says",
        python::wheel,
    ),
    slow("benches", "every bench runs once", benches),
    slow(
        "documents",
        "a second validator, in Python, checks tests/documents against the schemas with the same results as ours",
        python::documents,
    ),
    slow(
        "python",
        "the Python package passes linting, type checks, and its tests with the newest and the oldest Gymnasium",
        python::package,
    ),
    slow(
        "learners",
        "the Python tests that need torch, Stable-Baselines3, Minari and Ray pass",
        python::learners,
    ),
    slow(
        "unity",
        "Python clients of ML-Agents, old and new, drive driftworld-unity",
        unity::stage,
    ),
    slow(
        "studio",
        "the workbench page builds and type-checks, and its simulator gives the native one's answers, in a browser too",
        studio::stage,
    ),
    slow(
        "deny",
        "licences, sources, versions and advisories of dependencies are as deny.toml allows",
        deny,
    ),
    slow(
        "rebuilds",
        "no third-party crate was built twice under one profile",
        rebuilds,
    ),
];

fn passed(command: Command) -> Result<Outcome> {
    run(command).map(|()| Outcome::Passed(String::new()))
}

fn fmt(workspace: &Workspace) -> Result<Outcome> {
    passed(workspace.cargo(&["fmt", "--all", "--check"]))
}

fn clippy(workspace: &Workspace) -> Result<Outcome> {
    // Benches need additional crates.
    let targets: &[&str] = if workspace.is_full {
        &["clippy", "--all-targets"]
    } else {
        &["clippy", "--lib", "--bins", "--tests", "--examples"]
    };
    let mut command = workspace.cargo_everywhere(targets);
    command.args(["--", "-D", "warnings"]);
    passed(command)
}

fn doctests(workspace: &Workspace) -> Result<Outcome> {
    passed(workspace.cargo_everywhere(&["test", "--doc"]))
}

fn benches(workspace: &Workspace) -> Result<Outcome> {
    passed(workspace.cargo_everywhere(&["test", "--bench", "*", "--quiet"]))
}

/// `book/build.py` checks every link, and builds the book if mdBook is installed. Rustdoc runs only with `--all`.
fn docs(workspace: &Workspace) -> Result<Outcome> {
    if workspace.is_full {
        let mut command = workspace.cargo_everywhere(&["doc", "--no-deps"]);
        command.env("RUSTDOCFLAGS", "-D warnings");
        run(command)?;
    }
    let Some(python) = python::interpreter(python::ANY_VERSION) else {
        return Ok(Outcome::Partly(
            "no link was checked: found no Python 3.10 or later".into(),
        ));
    };
    run(workspace.program(&python, &["book/record.py", "--check"]))?;
    if works(workspace.program("mdbook".as_ref(), &["--version"])) {
        let mut build = workspace.program(&python, &["book/build.py"]);
        build.arg(workspace.target.join("book"));
        return run(build).map(|()| Outcome::Passed("the book is target/book/index.html".into()));
    }
    run(workspace.program(&python, &["book/build.py", "--check"]))?;
    let install = "cargo install mdbook@0.5.4 --locked --no-default-features --features search";
    Ok(Outcome::Passed(format!(
        "without mdBook ({install}), no book was built"
    )))
}

/// Advisories are checked if their database is reachable.
fn deny(workspace: &Workspace) -> Result<Outcome> {
    if !works(workspace.cargo(&["deny", "--version"])) {
        return missing(
            "DENY",
            "cargo-deny is not installed (cargo install cargo-deny --locked)".into(),
        );
    }
    let deny = |arguments: &[&str]| {
        let mut command = workspace.cargo(&["deny", "--workspace", "--all-features"]);
        // Fail instead of waiting for a password.
        command.args(arguments).env("GIT_TERMINAL_PROMPT", "0");
        command
    };
    run(deny(&["check", "bans", "licenses", "sources"]))?;
    if !works(deny(&["fetch", "db"])) {
        return Ok(Outcome::Partly(
            "advisories were not checked: their database cannot be reached".into(),
        ));
    }
    passed(deny(&["check", "advisories"]))
}

/// A reused build folder may contain old builds, so duplicates are a failure only if `DRIFTWORLD_REQUIRE_NO_REBUILDS` is set.
fn rebuilds(workspace: &Workspace) -> Result<Outcome> {
    let mut search = workspace.program("sh".as_ref(), &["scripts/rebuilds.sh"]);
    search.arg(&workspace.target);
    passed(search).or_else(|_| missing("NO_REBUILDS", "third-party crates were built twice, see above".into()))
}

/// Prints the stages.
pub(crate) fn list() {
    for stage in STAGES {
        let tier = if stage.is_quick { "" } else { " (--all)" };
        println!("{:<9} {}{tier}", stage.name, stage.about);
    }
}

/// Runs the stages in order, stops at the first failure, and prints a table.
pub(crate) fn run_all(workspace: &Workspace, stages: &[&Stage]) -> Result {
    thread::scope(|scope| {
        if stages.len() == STAGES.len() {
            // Installed while other stages run; the stage `learners` reports any failure.
            scope.spawn(|| python::learners_environment(workspace));
        }
        run_in_order(workspace, stages)
    })
}

fn run_in_order(workspace: &Workspace, stages: &[&Stage]) -> Result {
    let start = Instant::now();
    let mut table = Vec::new();
    let mut in_part = Vec::new();
    for (index, stage) in stages.iter().enumerate() {
        let name = stage.name;
        println!("\n{}/{} {name}: {}", index + 1, stages.len(), stage.about);
        let stage_start = Instant::now();
        let outcome = (stage.run)(workspace);
        let seconds = stage_start.elapsed().as_secs_f64();
        let ending = match outcome {
            Ok(Outcome::Passed(note)) => format!("passed  {note}"),
            Ok(Outcome::Partly(note)) => {
                in_part.push(name);
                format!("passed in part: {note}")
            }
            Ok(Outcome::Skipped(reason)) => format!("skipped: {reason}"),
            Err(error) => {
                let all = if workspace.is_full { "--all " } else { "" };
                return Err(format!(
                    "stage `{name}` failed after {seconds:.1} s: {error}; rerun it alone: cargo xtask test {all}--only {name}"
                ));
            }
        };
        println!("{}/{} {name} … {seconds:.0} s, {ending}", index + 1, stages.len());
        table.push(format!("  {name:<9} {seconds:>7.1} s  {ending}"));
    }
    let seconds = start.elapsed().as_secs_f64();
    println!(
        "\n{}\nxtask: {} in {seconds:.1} s",
        table.join("\n"),
        verdict(stages.len(), &in_part)
    );
    Ok(())
}

fn verdict(count: usize, in_part: &[&str]) -> String {
    let passed = if count == 1 {
        "the stage passed".to_owned()
    } else {
        format!("all {count} stages passed")
    };
    if in_part.is_empty() {
        passed
    } else {
        format!("{passed}, but only in part: {}", in_part.join(", "))
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use std::env;

    #[test]
    fn partial_pass_is_not_called_passed() {
        assert_eq!(verdict(1, &[]), "the stage passed");
        assert_eq!(verdict(3, &[]), "all 3 stages passed");
        assert_eq!(verdict(3, &["deny"]), "all 3 stages passed, but only in part: deny");
    }

    #[cfg(unix)]
    #[test]
    fn third_party_libraries_built_twice_are_found() {
        let folder = env::temp_dir().join(format!("xtask-rebuilds-{}", std::process::id()));
        let deps = folder.join("debug/deps");
        std::fs::create_dir_all(&deps).expect("the temporary folder is writable");
        let registry = "x.d: /home/user/.cargo/registry/src/index-0a1b";
        let write =
            |name: &str, text: &str| std::fs::write(deps.join(name), text).expect("its folder was created above");
        let search = || {
            let script = concat!(env!("CARGO_MANIFEST_DIR"), "/../scripts/rebuilds.sh");
            Command::new("sh")
                .arg(script)
                .arg(&folder)
                .output()
                .expect("every Unix has a shell")
        };
        // The third library was only checked; the fourth and fifth are our own.
        for (library, list, sources) in [
            ("liba-1.rlib", "a-1.d", format!("{registry}/a-1.0.0/src/lib.rs\n")),
            ("liba-3.so", "a-3.d", format!("{registry}/a-2.0.0/src/lib.rs\n")),
            ("liba-4.rmeta", "a-4.d", format!("{registry}/a-1.0.0/src/lib.rs\n")),
            ("libours-5.rlib", "ours-5.d", "x.d: ours/src/lib.rs\n".to_owned()),
            ("libours-6.rlib", "ours-6.d", "x.d: ours/src/lib.rs\n".to_owned()),
        ] {
            write(library, "");
            write(list, &sources);
        }
        assert!(search().status.success());
        write("liba-2.rlib", "");
        write("a-2.d", &format!("{registry}/a-1.0.0/src/lib.rs\n"));
        let found = search();
        std::fs::remove_dir_all(&folder).expect("it was created here");
        assert!(!found.status.success());
        let stderr = String::from_utf8_lossy(&found.stderr);
        assert!(
            stderr.contains("found a-1.0.0 more than once") && !stderr.contains("a-2.0.0") && !stderr.contains("ours"),
            "{stderr}"
        );
    }

    #[test]
    fn missing_tools_skip_unless_required() {
        assert!(
            matches!(missing("NOTHING_OF_OURS", "no room".into()), Ok(Outcome::Skipped(reason)) if reason == "no room")
        );
    }
}
