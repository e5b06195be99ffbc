//! Compares the table of a log with `python -m l2logger.aggregate`: `tests/oracles/l2logger_aggregate.py` generated both.

use std::path::Path;

use driftworld_metrics::{Delimiter, KeptRows, LogTable, read_log_with_texts, validate_log};
use driftworld_text::Cells;

/// Rows of cells, header first.
fn cells(tsv: &[u8]) -> Vec<Vec<String>> {
    let mut reader = csv::ReaderBuilder::new()
        .delimiter(b'\t')
        .has_headers(false)
        .from_reader(tsv);
    let rows = reader
        .records()
        .map(|row| row.unwrap().iter().map(str::to_owned).collect());
    rows.collect()
}

/// Whether two cells are equal text, or numbers that differ by at most the error of pandas' fast parser: the last one or two
/// bits.
fn same(found: &str, expected: &str) -> bool {
    match (found.parse::<f64>(), expected.parse::<f64>()) {
        (Ok(a), Ok(b)) => (a - b).abs() <= 4.0 * f64::EPSILON * b.abs(),
        _ => found == expected,
    }
}

#[test]
fn log_of_two_workers_matches_l2logger() {
    let oracles = Path::new(env!("CARGO_MANIFEST_DIR")).join("tests/oracles");
    let dir = oracles.join("l2logger_aggregate");
    assert!(validate_log(&dir).is_valid());
    let mut table = LogTable::new(KeptRows::Complete);
    table.add(read_log_with_texts(&dir).unwrap()).unwrap();
    let mut bytes = Vec::new();
    table.write(&mut bytes, Delimiter::Tab, Cells::Guarded).unwrap();
    let (found, expected) = (cells(&bytes), cells(include_bytes!("oracles/l2logger_aggregate.tsv")));
    assert_eq!(found[0], expected[0]);
    assert_eq!(found.len(), 13);
    assert_eq!(found.len(), expected.len());
    for (found, expected) in found.iter().zip(&expected) {
        assert!(
            found.iter().zip(expected).all(|(a, b)| same(a, b)),
            "{found:?}\n{expected:?}"
        );
    }
}
