//! `cargo xtask dist`: what is handed out to people without a compiler. The command with every feature in and a wheel,
//! each with its checksum and its bill of materials, for Linux on x86-64 with glibc from 2.28 on (Debian 10, RHEL 8,
//! Ubuntu 20.04), linked by zig, which knows old versions of glibc.

use std::fs;
use std::path::Path;

use crate::error::XtaskError;
use crate::process::{cargo, output, quiet_output, run};
use crate::python::NO_INTERPRETER;
use crate::sbom::{self, Product};
use crate::virtual_environment::{VirtualEnvironment, interpreter};
use crate::workspace::Workspace;

/// Where the files go, below Cargo's build folder.
const FOLDER: &str = "dist-files";

/// What they are built for, and the oldest glibc.
const TARGET: &str = "x86_64-unknown-linux-gnu";
const GLIBC: &str = "2.28";

/// The profile with link-time optimisation.
const PROFILE: &str = "dist";

/// The tools, from Python's package index.
const TOOLS: &str = "xtask/requirements-dist.txt";

/// Makes them all, after asking that every crate could be packaged.
pub(crate) fn make(workspace: &Workspace) -> Result<(), XtaskError> {
    let interpreter = interpreter().ok_or(XtaskError::Missing {
        what: "dist",
        reason: NO_INTERPRETER,
    })?;
    let folder = workspace.target.join(FOLDER);
    let failed = |path: &Path| {
        let path = path.to_owned();
        move |source| XtaskError::File { path, source }
    };
    if folder.exists() {
        fs::remove_dir_all(&folder).map_err(failed(&folder))?;
    }
    fs::create_dir_all(&folder).map_err(failed(&folder))?;
    let tools = VirtualEnvironment::with_requirements(workspace, &interpreter, "dist", Path::new(TOOLS))?;

    // Nothing is published, but whoever wants to build on a crate can have it as one.
    run(cargo(
        workspace,
        &["package", "--workspace", "--no-verify", "--allow-dirty", "--quiet"],
    ))?;

    let path = tools.path_before(&std::env::var_os("PATH").unwrap_or_default());
    let version = cargo_version(workspace)?;
    for (package, program, features) in [
        ("driftworld", "driftworld", &["--features", "full"][..]),
        ("driftworld-unity", "driftworld-unity", &[]),
    ] {
        let target = format!("{TARGET}.{GLIBC}");
        let mut build = cargo(
            workspace,
            &[
                "zigbuild",
                "--profile",
                PROFILE,
                "--package",
                package,
                "--target",
                &target,
            ],
        );
        build.args(features).env("PATH", &path);
        run(build)?;
        let built = workspace.target.join(TARGET).join(PROFILE).join(program);
        let name = format!("{program}-{version}-x86_64-linux");
        let to = folder.join(&name);
        fs::copy(&built, &to).map_err(failed(&built))?;
        let product = Product {
            package,
            features,
            target: TARGET,
        };
        with_bill(workspace, &tools, product, &to)?;
    }

    let mut wheel = tools.python(&[
        "-m",
        "maturin",
        "build",
        "--zig",
        "--profile",
        PROFILE,
        "--features",
        "full",
    ]);
    wheel
        .args([
            "--compatibility",
            "manylinux_2_28",
            "--target",
            TARGET,
            "--auditwheel",
            "check",
            "--out",
        ])
        .arg(&folder)
        .current_dir(workspace.root.join("python"))
        .env("PATH", &path);
    run(wheel)?;
    for entry in fs::read_dir(&folder).map_err(failed(&folder))? {
        let path = entry.map_err(failed(&folder))?.path();
        if path.extension().is_some_and(|ending| ending == "whl") {
            let product = Product {
                package: "driftworld-python",
                features: &["--features", "full"],
                target: TARGET,
            };
            with_bill(workspace, &tools, product, &path)?;
        }
    }
    println!("wrote {}", folder.display());
    Ok(())
}

/// Writes `FILE.cdx.json` beside a file, what is in it, judged by CycloneDX's schema; and the checksums of both.
fn with_bill(
    workspace: &Workspace,
    tools: &VirtualEnvironment,
    product: Product<'_>,
    path: &Path,
) -> Result<(), XtaskError> {
    let digest = checksum(tools, path)?;
    let bill = product.bill(workspace, &digest)?;
    let name = path.file_name().unwrap_or_default().to_string_lossy().into_owned();
    let to = path.with_file_name(format!("{name}.cdx.json"));
    fs::write(&to, format!("{bill:#}\n")).map_err(|source| XtaskError::File {
        path: to.clone(),
        source,
    })?;
    sbom::judge(tools, &to)?;
    checksum(tools, &to).map(drop)
}

/// Writes `FILE.sha256` beside a file, as `sha256sum --check` reads it; hands back the checksum.
fn checksum(tools: &VirtualEnvironment, path: &Path) -> Result<String, XtaskError> {
    let name = path.file_name().unwrap_or_default().to_string_lossy().into_owned();
    let mut digest = tools.python(&[
        "-c",
        "import hashlib, sys; print(hashlib.sha256(open(sys.argv[1], 'rb').read()).hexdigest())",
    ]);
    digest.arg(path);
    let digest = quiet_output(digest)?.trim().to_owned();
    let line = format!("{digest}  {name}\n");
    let to = path.with_file_name(format!("{name}.sha256"));
    fs::write(&to, &line).map_err(|source| XtaskError::File { path: to, source })?;
    print!("{line}");
    Ok(digest)
}

/// The version that all crates share.
fn cargo_version(workspace: &Workspace) -> Result<String, XtaskError> {
    let id = output(cargo(workspace, &["pkgid", "--package", "driftworld"]))?;
    Ok(id.trim().rsplit(['#', '@']).next().unwrap_or_default().to_owned())
}
