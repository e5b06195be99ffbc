//! The `examples` stage: builds and runs every program in `examples/`, each in an empty folder of its own. What an
//! example prints is shown only when it fails.

use std::fs::{self, File};
use std::path::{Path, PathBuf};
use std::process::{Child, Command, ExitStatus, Stdio};
use std::thread;
use std::time::{Duration, Instant};

use crate::error::XtaskError;
use crate::process::AS_TESTED;
use crate::process::{cargo, not_started, run, shown, succeeded};
use crate::workspace::Workspace;

/// Long enough for an unoptimised build on a slow machine; an example that needs it bores its reader.
const LIMIT: Duration = Duration::from_mins(5);

/// Runs them all; returns how many there were.
pub(crate) fn stage(workspace: &Workspace) -> Result<String, XtaskError> {
    let names = workspace.examples();
    if names.is_empty() {
        return Err(XtaskError::NoExamples);
    }
    run(cargo(workspace, &[&["build", "--examples"], &AS_TESTED[..]].concat()))?;
    for name in &names {
        let start = Instant::now();
        run_example(workspace, name)?;
        println!("  {name} ended well in {:.1} s", start.elapsed().as_secs_f64());
    }
    Ok(format!(
        "{} run",
        if names.len() == 1 {
            "1 example".into()
        } else {
            format!("{} examples", names.len())
        }
    ))
}

fn run_example(workspace: &Workspace, name: &str) -> Result<(), XtaskError> {
    let scratch = workspace.target.join("xtask-examples").join(name);
    let log = scratch.with_extension("log");
    empty_folder(&scratch)?;
    let output = File::create(&log).map_err(|source| file_error(&log, source))?;
    let errors = output.try_clone().map_err(|source| file_error(&log, source))?;

    let program = format!("{name}{}", std::env::consts::EXE_SUFFIX);
    // As built above: `cargo run` would build it again, with the features of its package alone.
    let mut command = Command::new(workspace.target.join("debug").join("examples").join(program));
    command
        .current_dir(&scratch)
        .stdin(Stdio::null())
        .stdout(output)
        .stderr(errors);
    let child = command.spawn().map_err(|source| not_started(&command, source))?;
    let ended = wait(child, name, LIMIT).and_then(|status| succeeded(&shown(&command), status));
    if ended.is_err() {
        eprintln!("{}", String::from_utf8_lossy(&fs::read(&log).unwrap_or_default()));
    }
    ended
}

/// Waits for the child, and ends it when the limit has passed.
fn wait(mut child: Child, name: &str, limit: Duration) -> Result<ExitStatus, XtaskError> {
    let start = Instant::now();
    let failed = |source| file_error(Path::new(name), source);
    loop {
        if let Some(status) = child.try_wait().map_err(failed)? {
            return Ok(status);
        }
        if start.elapsed() > limit {
            child.kill().map_err(failed)?;
            child.wait().map_err(failed)?;
            return Err(XtaskError::ExampleTooSlow {
                name: name.to_owned(),
                limit_secs: limit.as_secs(),
            });
        }
        thread::sleep(Duration::from_millis(20));
    }
}

/// Makes the folder, without what an earlier run left in it.
fn empty_folder(folder: &Path) -> Result<(), XtaskError> {
    if folder.exists() {
        fs::remove_dir_all(folder).map_err(|source| file_error(folder, source))?;
    }
    fs::create_dir_all(folder).map_err(|source| file_error(folder, source))
}

fn file_error(path: &Path, source: std::io::Error) -> XtaskError {
    XtaskError::File {
        path: PathBuf::from(path),
        source,
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn an_example_that_does_not_end_is_ended() {
        let child = Command::new("sleep").arg("60").spawn().unwrap();
        let error = wait(child, "dreamer", Duration::ZERO).unwrap_err();
        assert!(
            error.to_string().contains("example `dreamer` still ran after 0 s"),
            "{error}"
        );
    }

    #[test]
    fn the_exit_status_is_the_examples_own() {
        let child = Command::new("sh").args(["-c", "exit 4"]).spawn().unwrap();
        assert_eq!(wait(child, "four", LIMIT).unwrap().code(), Some(4));
    }
}
