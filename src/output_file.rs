//! Writes files atomically, and never over the files of a log.

use std::io::Write;
use std::path::Path;

use driftworld_atomic_files::AtomicFile;
use driftworld_report::picture::Drawing;
use driftworld_text::{ShownPath, WordKind, removed};

use crate::{Failure, overwrite};

/// Starts a file that is written atomically; a device or a pipe is written directly. Refuses to overwrite files of a log.
pub(crate) fn create(path: &Path) -> Result<AtomicFile, Failure> {
    if path == Path::new("-") {
        let advice = "expected the path of a file; give /dev/stdout for standard output";
        return Err(Failure::usage(format!("found - as the file to write; {advice}")));
    }
    overwrite::refuse_log_files(path)?;
    AtomicFile::create(path).map_err(|error| unwritable(path, &error))
}

/// Writes a file like [`create`].
pub(crate) fn write(path: &Path, bytes: &[u8]) -> Result<(), Failure> {
    let mut file = create(path)?;
    let written = file.write_all(bytes).and_then(|()| file.commit());
    written.map_err(|error| unwritable(path, &error))
}

/// Writes a picture: as SVG if the name ends in `.svg`, else as PNG.
///
/// Refuses a name with the extension of any other format.
pub(crate) fn write_picture(path: &Path, picture: &Drawing) -> Result<(), Failure> {
    const OTHERS: [&str; 14] = [
        "jpg", "jpeg", "gif", "bmp", "webp", "tif", "tiff", "pdf", "csv", "html", "json", "jsonl", "parquet", "txt",
    ];
    let ending = path.extension().and_then(|ending| ending.to_str()).unwrap_or_default();
    if ending.eq_ignore_ascii_case("svg") {
        return write(path, picture.to_svg()?.as_bytes());
    }
    if OTHERS.iter().any(|other| ending.eq_ignore_ascii_case(other)) {
        return Err(Failure::usage(format!(
            "{}: found a name that ends in .{ending}, expected .png or .svg; pictures are written as PNG or SVG",
            path.shown()
        )));
    }
    write(path, &picture.to_png()?)
}

/// Refuses a file extension whose format was removed.
pub(crate) fn refuse_removed_ending(path: &Path) -> Result<(), Failure> {
    let ending = path.extension().and_then(|ending| ending.to_str()).unwrap_or_default();
    removed(WordKind::Format, ending).map_or(Ok(()), |message| {
        Err(Failure::usage(format!("{}: .{ending} was {message}", path.shown())))
    })
}

/// The failure of writing a file.
pub(crate) fn unwritable(path: &Path, error: &dyn std::fmt::Display) -> Failure {
    Failure::in_file(path, format!("cannot be written: {error}"))
}
