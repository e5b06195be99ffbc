//! `cargo xtask dist`: wheels and archives of the programs for Linux on x86-64 and aarch64, with their checksums.
//!
//! zig links them, so that they run with glibc from 2.28 on, whatever this machine has. Nothing is uploaded.

use std::env;
use std::fs;
use std::path::Path;
use std::process::Command;

use crate::process::{Result, Workspace, about, output, run};
use crate::python::{ANY, Environment, NO_INTERPRETER, interpreter};

const TARGETS: [&str; 2] = ["x86_64-unknown-linux-gnu", "aarch64-unknown-linux-gnu"];
/// The oldest glibc that they run with, and the name that wheels have for it.
const GLIBC: (&str, &str) = ("2.28", "manylinux_2_28");

/// Builds for the targets, or for all if none is named, into `dist/` of the build folder.
pub(crate) fn make(workspace: &Workspace, named: &[&str]) -> Result {
    let targets = chosen(named)?;
    for target in &targets {
        let library = output(workspace.program("rustc".as_ref(), &["--print", "target-libdir", "--target", target]))?;
        if !Path::new(library.trim()).exists() {
            return Err(format!(
                "{target}: found no standard library of Rust, expected it installed; run `rustup target add {target}`"
            ));
        }
    }
    let tools = Environment::with(
        workspace,
        &interpreter(ANY).ok_or(NO_INTERPRETER)?,
        "dist",
        &["xtask/dist.txt"],
    )?;
    let folder = workspace.target.join("dist");
    fs::create_dir_all(&folder).map_err(about(&folder))?;
    let out = folder.to_str().ok_or("the build folder's path is not UTF-8")?;
    for target in &targets {
        wheel(workspace, &tools, target, out)?;
    }
    for target in targets {
        archive(workspace, &tools, target, out)?;
    }
    let sums = "set -e; cd \"$0\"; sha256sum *.whl *.tar.gz > SHA256SUMS; ls -l; cat SHA256SUMS";
    run(workspace.program("sh".as_ref(), &["-c", sums, out]))
}

fn chosen(named: &[&str]) -> Result<Vec<&'static str>> {
    if named.is_empty() {
        return Ok(TARGETS.to_vec());
    }
    let known = |name: &&str| TARGETS.into_iter().find(|target| target == name);
    let unknown = |name: &str| format!("found target `{name}`, expected one of {}", TARGETS.join(", "));
    named
        .iter()
        .map(|name| known(name).ok_or_else(|| unknown(name)))
        .collect()
}

/// One for Python 3.10 and later, with every feature and the command.
fn wheel(workspace: &Workspace, tools: &Environment, target: &str, out: &str) -> Result {
    let mut build = tools.python(
        workspace,
        &["-m", "maturin", "build", "--manifest-path", "python/Cargo.toml"],
    );
    build.args([
        "--profile",
        "dist",
        "--features",
        "full",
        "--zig",
        "--compatibility",
        GLIBC.1,
    ]);
    build.args(["--target", target, "--out", out]);
    with_tools(workspace, build)
}

/// The command and the server for clients of Unity, with the licences.
fn archive(workspace: &Workspace, tools: &Environment, target: &str, out: &str) -> Result {
    for package in [&["driftworld", "--features", "full"][..], &["driftworld-unity"]] {
        let mut build = tools.tool(
            workspace,
            "cargo-zigbuild",
            &["zigbuild", "--profile", "dist", "--target"],
        );
        build
            .arg(format!("{target}.{}", GLIBC.0))
            .arg("--package")
            .args(package);
        with_tools(workspace, build)?;
    }
    let version = env!("CARGO_PKG_VERSION");
    let name = format!(
        "driftworld-{version}-{}-linux",
        target.split('-').next().unwrap_or(target)
    );
    let pack = "set -e; rm -rf \"$2/$3\"; mkdir \"$2/$3\"; cp \"$1/driftworld\" \"$1/driftworld-unity\" README.md LICENSE-* CITATION.cff \"$2/$3\"; \
                tar -C \"$2\" --sort=name --owner=0 --group=0 --numeric-owner --mtime=@0 -czf \"$2/$3.tar.gz\" \"$3\"; rm -r \"$2/$3\"";
    let built = workspace.target.join(target).join("dist");
    let mut tar = workspace.program("sh".as_ref(), &["-c", pack, "sh"]);
    tar.arg(built).args([out, &name]);
    run(tar)
}

/// Runs a build that finds zig first in PATH.
fn with_tools(workspace: &Workspace, mut build: Command) -> Result {
    let tools = workspace.target.join("python/dist/bin");
    let rest = env::var_os("PATH").unwrap_or_default();
    let path = env::join_paths([tools].into_iter().chain(env::split_paths(&rest)));
    build.env("PATH", path.map_err(|error| error.to_string())?);
    build.env("CARGO_TARGET_DIR", &workspace.target);
    run(build)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn no_name_means_all_targets_and_an_unknown_one_is_refused() {
        assert_eq!(chosen(&[]).unwrap(), TARGETS);
        assert_eq!(chosen(&[TARGETS[1]]).unwrap(), [TARGETS[1]]);
        let error = chosen(&["riscv64gc-unknown-linux-gnu"]).unwrap_err();
        assert!(
            error.contains("expected one of x86_64-unknown-linux-gnu, aarch64"),
            "{error}"
        );
    }
}
