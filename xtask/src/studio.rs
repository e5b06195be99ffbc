//! `cargo xtask studio` builds the workbench page into `target/studio`, and the stage `studio` tests it.
//! `studio/build.mjs` bundles the page.

use std::env;
use std::fs;
use std::path::PathBuf;
use std::process::Command;
use std::thread;

use crate::process::{Result, Workspace, about, output, run, works};
use crate::python;
use crate::stage::{Outcome, missing};

const TARGET: &str = "wasm32-unknown-unknown";

/// Builds the page: compiles the simulator, installs the page's packages, and bundles both.
pub(crate) fn build(workspace: &Workspace) -> Result {
    tools(workspace).map_err(|missing_tools| missing_tools.join("; "))?;
    bundle(workspace)
}

/// Checks for the tools that build the page; the error lists the missing ones, each with advice.
fn tools(workspace: &Workspace) -> std::result::Result<(), Vec<String>> {
    let mut missing_tools = Vec::new();
    let version = "process.exit(Number(process.versions.node.split('.')[0]) >= 20 ? 0 : 1)";
    if !works(workspace.program("node".as_ref(), &["-e", version])) || !works(npm(workspace, &["--version"])) {
        missing_tools
            .push("found no Node.js 20 or later with npm, expected both (Debian: apt install nodejs npm)".to_owned());
    }
    if !has_target(workspace) && !works(workspace.program("rustup".as_ref(), &["target", "add", TARGET])) {
        missing_tools.push(format!(
            "found no standard library for {TARGET}, expected one (rustup target add {TARGET})"
        ));
    }
    if missing_tools.is_empty() {
        Ok(())
    } else {
        Err(missing_tools)
    }
}

fn has_target(workspace: &Workspace) -> bool {
    let sysroot = output(workspace.program("rustc".as_ref(), &["--print", "sysroot"]));
    sysroot.is_ok_and(|sysroot| PathBuf::from(sysroot.trim()).join("lib/rustlib").join(TARGET).is_dir())
}

fn bundle(workspace: &Workspace) -> Result {
    run(workspace.cargo(&[
        "build",
        "-p",
        "driftworld-wasm",
        "--lib",
        "--target",
        TARGET,
        "--profile",
        "wasm",
    ]))?;
    install(workspace)?;
    let mut bundle = workspace.program("node".as_ref(), &["studio/build.mjs"]);
    bundle.arg(workspace.target.join(TARGET).join("wasm/driftworld_wasm.wasm"));
    bundle.arg(workspace.target.join("studio"));
    run(bundle)
}

/// Installs the packages of `studio/package-lock.json`, unless they are up to date.
fn install(workspace: &Workspace) -> Result {
    let time = |path: &str| {
        let changed = workspace.root.join("studio").join(path).metadata();
        changed.and_then(|it| it.modified()).ok()
    };
    let (installed, locked) = (time("node_modules/.package-lock.json"), time("package-lock.json"));
    if installed.is_some() && installed >= locked {
        return Ok(());
    }
    run(npm(workspace, &["ci", "--no-audit", "--no-fund"]))
}

fn npm(workspace: &Workspace, arguments: &[&str]) -> Command {
    let mut npm = workspace.program(if cfg!(windows) { "npm.cmd" } else { "npm" }.as_ref(), arguments);
    npm.current_dir(workspace.root.join("studio"));
    npm
}

/// Builds the page, checks its types, and compares its simulator with the native one, in Node.js and, if installed, Chromium.
pub(crate) fn stage(workspace: &Workspace) -> Result<Outcome> {
    if let Err(missing_tools) = tools(workspace) {
        return missing("STUDIO", missing_tools.join("; "));
    }
    if let Err(reason) = install(workspace) {
        return missing(
            "STUDIO",
            format!("the packages of the page could not be installed: {reason}"),
        );
    }
    thread::scope(|scope| {
        // Linking the simulator uses only one core, so other work runs at the same time.
        let page = scope.spawn(|| bundle(workspace));
        // The native tests have already built most of these.
        run(workspace.cargo_everywhere(&["build", "--example", "answers", "--bin", "driftworld"]))?;
        run(npm(workspace, &["run", "--silent", "check"]))?;
        page.join().expect("bundling returns errors and does not panic")
    })?;
    let command = workspace.target.join("debug/driftworld");
    let page = workspace.target.join("studio");
    // Exports the page as its own documentation describes.
    let mut export = workspace.program(&command, &["studio", "--export"]);
    export.arg(workspace.target.join("studio-export"));
    run(export)?;
    let mut tests = workspace.program(
        "node".as_ref(),
        &["--test", "--test-concurrency=2", "--test-reporter=spec"],
    );
    tests
        .args(test_files(workspace)?)
        .env("CARGO_TARGET_DIR", &workspace.target)
        .env("DRIFTWORLD_PAGE", &page)
        .env("DRIFTWORLD_COMMAND", &command);
    match python::with_package(workspace) {
        Ok(interpreter) => tests.env("DRIFTWORLD_PYTHON", interpreter),
        Err(reason) => {
            println!("the page's Python programs are not run: {reason}");
            missing("PYTHON", reason)?;
            tests.env_remove("DRIFTWORLD_PYTHON")
        }
    };
    if workspace.is_full {
        tests.env("DRIFTWORLD_FULL", "1");
    }
    run(tests)?;
    Ok(Outcome::Passed(format!(
        "the page is {}",
        workspace.target.join("studio").display()
    )))
}

/// The test files, listed here because not every version of Node.js finds them in a folder.
fn test_files(workspace: &Workspace) -> Result<Vec<PathBuf>> {
    let folder = workspace.root.join("studio/test");
    let entries = fs::read_dir(&folder).map_err(about(&folder))?;
    let mut files: Vec<PathBuf> = entries.filter_map(|entry| Some(entry.ok()?.path())).collect();
    files.retain(|path| path.to_string_lossy().ends_with(".test.mjs"));
    files.sort();
    Ok(files)
}

/// Prints how to serve the page and how to embed it in a program.
pub(crate) fn print_location(workspace: &Workspace) {
    let folder = workspace.target.join("studio");
    let shown = folder.display();
    println!("the page is in {shown}; `driftworld studio`, built in the same target folder, serves it");
    if env::var_os("DRIFTWORLD_STUDIO").is_none() {
        println!("to embed it in a program: DRIFTWORLD_STUDIO='{shown}' cargo build --release");
    }
}
