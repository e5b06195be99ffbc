//! Fuzz target for distance matrices in CSV and JSON; the first byte chooses the format.

use driftworld_similarity::DistanceMatrix;

use crate::refusal;

/// Maximum number of items in a matrix that is checked and written.
const MAX_ITEMS: usize = 64;

/// A matrix that can be read can be written in each format, and reads back the same.
pub(crate) fn check(bytes: &[u8]) {
    let Some((form, bytes)) = bytes.split_first() else {
        return;
    };
    let text = String::from_utf8_lossy(bytes);
    let read = match form {
        b'c' => DistanceMatrix::from_csv(&text),
        _ => DistanceMatrix::from_json(&text),
    };
    let matrix = match read {
        Ok(matrix) => matrix,
        Err(error) => return refusal::message(&error.to_string()),
    };
    if matrix.len() > MAX_ITEMS {
        return;
    }
    for a in 0..matrix.len() {
        for b in 0..matrix.len() {
            let distance = matrix.get(a, b);
            assert!(distance.is_finite() && distance >= 0.0 && distance == matrix.get(b, a));
        }
    }
    let same = |reread: Result<DistanceMatrix, _>| {
        let reread = reread.unwrap_or_else(|error| panic!("our own output is valid: {error}"));
        assert_eq!((reread.labels(), reread.values()), (matrix.labels(), matrix.values()));
    };
    same(DistanceMatrix::from_csv(&matrix.to_csv()));
    same(DistanceMatrix::from_json(&matrix.to_json()));
}
