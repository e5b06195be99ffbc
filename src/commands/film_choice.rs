//! Writes films and recordings, and reports what they contain.

use std::path::Path;

use crate::Failure;
use crate::env::{Catalogue, Recording, RecordingLines};
use crate::film::{FilmOptions, FilmSummary, write_film};
use driftworld_text::{ShownPath, amount, counted};

use super::output;

/// Writes the film, with a progress bar on a terminal.
pub(super) fn write(
    path: &Path,
    recording: &Recording,
    catalogue: &Catalogue,
    options: &FilmOptions,
) -> Result<FilmSummary, Failure> {
    let bar = output::progress(options.num_frames(recording.actions.len()) as u64, "filming");
    let written = write_film(path, recording, catalogue, options, &mut |done| {
        bar.set_position(done);
    });
    bar.finish_and_clear();
    written
}

/// Writes recordings into a file that `replay` can play.
pub(super) fn record(path: &Path, recordings: &[Recording]) -> Result<(), Failure> {
    let mut lines = RecordingLines::default();
    let episodes: String = recordings.iter().map(|recording| lines.lines(recording)).collect();
    output::write(path, (RecordingLines::header() + &episodes).as_bytes())
}

/// Reports the written file with its properties.
pub(crate) fn report_film(path: &Path, film: &FilmSummary) -> Result<(), Failure> {
    let FilmSummary {
        frames,
        width,
        height,
        seconds,
        sheet,
    } = film;
    let details = match sheet {
        Some([wide, high]) => format!(", on a sheet of {wide} × {high}"),
        None => format!(", {seconds:.1} s"),
    };
    output::line(format!(
        "wrote {}: {frames} frames of {width} × {height} pixels{details}",
        path.shown()
    ))
}

/// Summary of an episode.
pub(crate) fn summary(recording: &Recording) -> String {
    let origin = &recording.origin;
    let world = match (&origin.task, &origin.variant, origin.seed, origin.index) {
        (Some(task), Some(variant), Some(seed), Some(index)) => {
            format!("{task}#{variant}, world {index} under seed {seed}: ")
        }
        (Some(task), Some(variant), ..) => format!("{task}#{variant}: "),
        (Some(world), None, ..) => format!("{world}: "),
        _ => String::new(),
    };
    let ended = recording
        .ended_by
        .map_or_else(|| "no end".to_owned(), |word| format!("ended by {}", word.word()));
    let steps = counted(recording.actions.len(), "step");
    format!("{world}{steps}, reward {}, {ended}", amount(recording.reward))
}
