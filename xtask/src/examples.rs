//! The stage `examples`: builds and runs every program in `examples/`, each in an empty folder. Shows a program's output only if it
//! fails.

use std::fs;
use std::time::Instant;

use crate::process::{Result, Workspace, about, ended, run};
use crate::stage::Outcome;

/// Runs all examples; the outcome's note is their number.
pub(crate) fn stage(workspace: &Workspace) -> Result<Outcome> {
    let folder = workspace.root.join("examples");
    let entries = fs::read_dir(&folder).map_err(about(&folder))?;
    let paths = entries.filter_map(|entry| Some(entry.ok()?.path()));
    let sources = paths.filter(|path| path.extension().is_some_and(|extension| extension == "rs"));
    let mut names: Vec<String> = sources
        .filter_map(|path| Some(path.file_stem()?.to_str()?.to_owned()))
        .collect();
    names.sort();
    // `cargo run` would build them again, with the features of their package alone.
    run(workspace.cargo_everywhere(&["build", "--bins", "--examples"]))?;
    for name in &names {
        let start = Instant::now();
        let scratch = workspace.target.join("xtask-examples").join(name);
        if scratch.exists() {
            fs::remove_dir_all(&scratch).map_err(about(&scratch))?;
        }
        fs::create_dir_all(&scratch).map_err(about(&scratch))?;
        let mut example = workspace.program(&workspace.target.join("debug/examples").join(name), &[]);
        let done = example.current_dir(&scratch).output();
        if let Ok(done) = &done
            && !done.status.success()
        {
            eprintln!(
                "{}{}",
                String::from_utf8_lossy(&done.stdout),
                String::from_utf8_lossy(&done.stderr)
            );
        }
        ended(&example, done.map(|done| done.status))?;
        println!("  {name} succeeded in {:.1} s", start.elapsed().as_secs_f64());
    }
    Ok(Outcome::Passed(format!("{} examples run", names.len())))
}
