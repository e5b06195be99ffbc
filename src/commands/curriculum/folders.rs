//! Writes scenarios into folders: each into a file named after it, without replacing existing files.

use std::path::{Path, PathBuf};

use driftworld_text::ShownPath;

use crate::commands::output;
use crate::spec::Scenario;
use crate::{Failure, overwrite};

/// Refuses standard output and files as the folder of several scenarios.
pub(super) fn refuse_no_folder(path: &Path) -> Result<(), Failure> {
    if path.as_os_str() == "-" {
        return Err(Failure::usage(
            "--output: found no folder, expected one for several scenarios",
        ));
    }
    if path.is_file() || path.extension().is_some_and(|end| end == "json") {
        return Err(Failure::usage(format!(
            "--output: found the file {}, expected a folder: several scenarios are written, each into a file of its own",
            path.shown()
        )));
    }
    Ok(())
}

/// Refuses standard output as a folder.
pub(super) fn refuse_standard_output(option: &str, folder: Option<&Path>) -> Result<(), Failure> {
    if folder.is_some_and(output::is_stdout) {
        return Err(Failure::usage(format!(
            "{option}: found standard output, expected a folder: several scenarios are written"
        )));
    }
    Ok(())
}

/// Refuses to replace existing files in the scenarios' folders.
pub(super) fn refuse_existing(into: &[(Option<&PathBuf>, &Vec<Scenario>)]) -> Result<(), Failure> {
    let folders = into
        .iter()
        .filter_map(|(folder, scenarios)| folder.zip(Some(*scenarios)));
    let mut files = folders.flat_map(|(folder, scenarios)| scenarios.iter().map(|scenario| file_of(folder, scenario)));
    let advice = "name another folder, or replace its scenarios with --force";
    let found = files.find(|path| path.is_file());
    found.map_or(Ok(()), |path| Err(overwrite::exists(&path, advice)))
}

/// Writes scenarios into a folder, if there is one, each into a file named after it; reports each file with `what` it holds.
pub(super) fn write_each(
    folder: Option<&PathBuf>,
    scenarios: &[Scenario],
    what: impl Fn(&Scenario) -> String,
) -> Result<(), Failure> {
    let Some(folder) = folder else { return Ok(()) };
    for scenario in scenarios {
        let path = file_of(folder, scenario);
        output::write(&path, scenario.to_json_pretty().as_bytes())?;
        output::wrote(&path, what(scenario));
    }
    Ok(())
}

/// The file of a scenario in a folder.
fn file_of(folder: &Path, scenario: &Scenario) -> PathBuf {
    folder.join(format!("{}.json", scenario.name))
}
