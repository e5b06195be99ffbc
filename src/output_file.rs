//! Files that are written whole or not at all, and never over a log.

use std::io::Write;
use std::path::Path;

use driftworld_atomic_files::AtomicFile;
use driftworld_report::picture::Drawing;
use driftworld_text::{ShownPath, WordKind, removed};

use crate::{Failure, overwrite};

/// Begins a file that is there whole or not at all; a device or a pipe is written straight. None that a log is made of
/// is written over.
pub(crate) fn create(path: &Path) -> Result<AtomicFile, Failure> {
    if path == Path::new("-") {
        let advice = "expected the path of a file; give /dev/stdout for standard output";
        return Err(Failure::usage(format!("found - as the file to write; {advice}")));
    }
    overwrite::refuse_log_files(path)?;
    AtomicFile::create(path).map_err(|error| unwritable(path, &error))
}

/// Writes a file as [`create`] begins it.
pub(crate) fn write(path: &Path, bytes: &[u8]) -> Result<(), Failure> {
    let mut file = create(path)?;
    let written = file.write_all(bytes).and_then(|()| file.commit());
    written.map_err(|error| unwritable(path, &error))
}

/// Writes a picture: as SVG where the name ends in `.svg`, else as PNG.
///
/// A name that ends like another kind of file is refused: it would lie.
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

/// Refuses the name of a file whose ending names a format that was removed.
pub(crate) fn refuse_removed_ending(path: &Path) -> Result<(), Failure> {
    let ending = path.extension().and_then(|ending| ending.to_str()).unwrap_or_default();
    removed(WordKind::Format, ending).map_or(Ok(()), |message| {
        Err(Failure::usage(format!("{}: .{ending} was {message}", path.shown())))
    })
}

/// Why a file cannot be written.
pub(crate) fn unwritable(path: &Path, error: &dyn std::fmt::Display) -> Failure {
    Failure::in_file(path, format!("cannot be written: {error}"))
}
