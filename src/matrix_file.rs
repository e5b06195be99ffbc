//! Reads and writes distance matrices as CSV or JSON, by file extension.

use std::path::Path;

use crate::contents::{Contents, OtherContents};
use crate::similarity::{DistanceMatrix, SimilarityError};
use driftworld_text::{Cells, ShownPath, WordKind, removed};

use crate::{Failure, argument, documents, output_file};

/// Maximum size of a matrix file in bytes. Its text and the matrix are in memory at the same time.
pub const MAX_MATRIX_BYTES: u64 = 400 << 20;

/// The format given by a file's name.
enum Format {
    Csv,
    Json,
}

fn format(option: &str, path: &Path) -> Result<Format, Failure> {
    let ending = path.extension().and_then(|ending| ending.to_str()).unwrap_or_default();
    match ending {
        "csv" => Ok(Format::Csv),
        "json" => Ok(Format::Json),
        _ => {
            let advice = removed(WordKind::Format, ending)
                .unwrap_or_else(|| "expected a name that ends in .csv or .json".to_owned());
            let (option, found) = (argument(option), path.shown());
            Err(Failure::usage(format!("{option}: found {found}, {advice}")))
        }
    }
}

/// Refuses a file name without a known extension, so that this is noticed before anything is measured.
pub(crate) fn expect_name(option: &str, path: &Path) -> Result<(), Failure> {
    format(option, path).map(|_| ())
}

/// Writes a matrix. In CSV, labels that a spreadsheet would read as formulas are escaped unless `cells` is [`Cells::Raw`].
pub(crate) fn write(option: &str, path: &Path, matrix: &DistanceMatrix, cells: Cells) -> Result<(), Failure> {
    match format(option, path)? {
        Format::Csv => output_file::write(path, matrix.to_csv_with(cells).as_bytes()),
        Format::Json => output_file::write(path, matrix.to_json().as_bytes()),
    }
}

/// Reads a matrix.
pub(crate) fn read(option: &str, path: &Path) -> Result<DistanceMatrix, Failure> {
    let named = |error: SimilarityError| Failure::in_file(path, error);
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
    }
}
