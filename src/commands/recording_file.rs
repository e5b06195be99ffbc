//! One episode in a file of recordings.

use std::path::Path;

use crate::Failure;
use crate::env::{Recording, RecordingLines};

use super::output;

/// Writes an episode as a file of recordings, whole or not at all.
pub(crate) fn write_recording(path: &Path, recording: &Recording) -> Result<(), Failure> {
    let text = RecordingLines::header() + &RecordingLines::default().lines(recording);
    output::write(path, text.as_bytes())
}
