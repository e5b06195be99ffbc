//! `--ste-store-mode`: logs kept as the experts of their tasks. How they are kept is the library's.

use std::path::{Path, PathBuf};

use crate::metrics::{SteStoreMode, store_ste};

use crate::commands::{Failure, output};

/// Keeps the logs in the folder.
///
/// Where several logs of one task replace what is there, only the first does: the others are its further runs.
pub(super) fn store(logs: &[PathBuf], mode: SteStoreMode, data: &Path) -> Result<(), Failure> {
    let mut replaced: Vec<String> = Vec::new();
    for log in logs {
        let task = crate::metrics::read_ste_log(log)?.task_name().to_owned();
        let mode = if replaced.contains(&task) {
            SteStoreMode::Append
        } else {
            mode
        };
        let stored = store_ste(data, log, mode)?;
        output::wrote(&stored.dir, format!("an expert of {}", stored.task_name));
        replaced.push(task);
    }
    Ok(())
}
