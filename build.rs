//! Embeds the page of the workbench in the program if `DRIFTWORLD_STUDIO` names the folder that `cargo xtask studio`
//! built.

use std::error::Error;
use std::fmt::Write;
use std::path::{Path, PathBuf};
use std::{env, fs};

fn main() -> Result<(), Box<dyn Error>> {
    println!("cargo::rerun-if-env-changed=DRIFTWORLD_STUDIO");
    println!("cargo::rerun-if-changed=build.rs");
    let mut files = Vec::new();
    if let Some(folder) = env::var_os("DRIFTWORLD_STUDIO").map(PathBuf::from) {
        let folder = folder.canonicalize().map_err(|error| {
            format!(
                "DRIFTWORLD_STUDIO: found a folder that cannot be opened ({error}), expected the whole path of the folder \
                 that `cargo xtask studio` built"
            )
        })?;
        let shown = folder
            .to_str()
            .ok_or("DRIFTWORLD_STUDIO: found a path that is not UTF-8")?;
        println!("cargo::rerun-if-changed={shown}");
        list(&folder, "", &mut files)?;
        files.sort();
    }
    let mut code = "&[\n".to_owned();
    for (name, path) in files {
        let path = path
            .to_str()
            .ok_or("DRIFTWORLD_STUDIO: found a path that is not UTF-8")?;
        writeln!(code, "    ({name:?}, include_bytes!({path:?})),")?;
    }
    code += "]\n";
    let out = PathBuf::from(env::var_os("OUT_DIR").ok_or("cargo sets OUT_DIR")?);
    Ok(fs::write(out.join("studio_files.rs"), code)?)
}

/// Lists the files of a folder and its subfolders with their paths relative to it.
fn list(folder: &Path, above: &str, files: &mut Vec<(String, PathBuf)>) -> Result<(), Box<dyn Error>> {
    for entry in fs::read_dir(folder)? {
        let entry = entry?;
        let name = format!("{above}{}", entry.file_name().to_string_lossy());
        if entry.file_type()?.is_dir() {
            list(&entry.path(), &format!("{name}/"), files)?;
        } else {
            files.push((name, entry.path()));
        }
    }
    Ok(())
}
