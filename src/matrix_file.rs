//! Distance matrices as files: CSV, JSON or numpy's, by the name's ending. The formats themselves are `similarity`'s.

use std::path::{Path, PathBuf};

use crate::contents::{Contents, OtherContents};
use crate::similarity::{DistanceMatrix, SimilarityError};
use driftworld_text::{Cells, ShownPath};

use crate::{Failure, argument, documents, output_file};

/// The largest file of a matrix that is read, in bytes: 7,240 items in numpy's format. It and the matrix are in memory
/// together.
pub(crate) const MAX_MATRIX_BYTES: u64 = 400 << 20;

/// What a file's name says it holds.
enum Format {
    Csv,
    Json,
    Npy,
}

fn format(option: &str, path: &Path) -> Result<Format, Failure> {
    match path.extension().and_then(|ending| ending.to_str()) {
        Some("csv") => Ok(Format::Csv),
        Some("json") => Ok(Format::Json),
        Some("npy") => Ok(Format::Npy),
        _ => Err(Failure::usage(format!(
            "{}: found {}, expected a name that ends in .csv, .json or .npy",
            argument(option),
            path.shown()
        ))),
    }
}

/// Refuses a name that says no format, before anything is measured.
pub(crate) fn expect_name(option: &str, path: &Path) -> Result<(), Failure> {
    format(option, path).map(|_| ())
}

/// Writes a matrix. The labels, for which numpy's format has no place, come into a JSON file beside it.
///
/// CSV guards labels that a spreadsheet would take for formulas, unless `cells` are raw.
pub(crate) fn write(option: &str, path: &Path, matrix: &DistanceMatrix, cells: Cells) -> Result<(), Failure> {
    match format(option, path)? {
        Format::Csv => output_file::write(path, matrix.to_csv_with(cells).as_bytes()),
        Format::Json => output_file::write(path, matrix.to_json().as_bytes()),
        Format::Npy => {
            output_file::write(path, &matrix.to_npy())?;
            output_file::write(&labels_beside(path), &serde_json::to_vec_pretty(matrix.labels())?)
        }
    }
}

/// Reads a matrix. Without a file of labels beside it, the items of an array are called by their numbers.
pub(crate) fn read(option: &str, path: &Path) -> Result<DistanceMatrix, Failure> {
    let named = |error: SimilarityError| Failure::input(format!("{}: {error}", path.shown()));
    if let Some(other) = OtherContents::check(path, Contents::of_folder(path), &[Contents::Matrix]) {
        return Err(other.into());
    }
    if documents::is_standard_input(path) {
        let text = documents::text(path)?;
        let is_json = text.trim_start().starts_with('{');
        let read = if is_json {
            DistanceMatrix::from_json(&text)
        } else {
            DistanceMatrix::from_csv(&text)
        };
        return read.map_err(|error| Failure::input(format!("standard input: {error}")));
    }
    match format(option, path)? {
        Format::Csv => DistanceMatrix::from_csv(&driftworld_files::text(path, MAX_MATRIX_BYTES)?).map_err(named),
        Format::Json => {
            let text = driftworld_files::text(path, MAX_MATRIX_BYTES)?;
            if let Some(other) = OtherContents::check(path, Contents::of_text(&text), &[Contents::Matrix]) {
                return Err(other.into());
            }
            DistanceMatrix::from_json(&text).map_err(named)
        }
        Format::Npy => {
            let bytes = driftworld_files::read(path, MAX_MATRIX_BYTES)?;
            let beside = labels_beside(path);
            let labels = if beside.exists() { Some(labels(&beside)?) } else { None };
            DistanceMatrix::from_npy(&bytes, labels).map_err(named)
        }
    }
}

fn labels(path: &Path) -> Result<Vec<String>, Failure> {
    serde_json::from_str(&documents::text(path)?)
        .map_err(|error| Failure::input(format!("{}: {error}, expected a list of labels", path.shown())))
}

/// `matrix.labels.json` for `matrix.npy`.
fn labels_beside(path: &Path) -> PathBuf {
    path.with_extension("labels.json")
}
