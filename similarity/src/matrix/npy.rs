//! Distance matrices in numpy's file format, version 1.0. It has no place for labels: they are handed in and out beside it.
//!
//! Not by `ndarray-npy`: it makes room for as many numbers as a heading announces before it looks whether they are there, and
//! brings a parser generator for what are two keys here.

use ndarray::Array2;

use super::DistanceMatrix;
use crate::SimilarityError;

/// What every file begins with: the format's name, and its version.
const MAGIC: &[u8] = b"\x93NUMPY\x01\x00";
/// The data begin at a multiple of this, for programs that map files into memory.
const ALIGNMENT: usize = 64;

impl DistanceMatrix {
    /// The distances as a `.npy` file's bytes: `float64`, `(items, items)`, row by row; the same bytes as `numpy.save` writes.
    pub fn to_npy(&self) -> Vec<u8> {
        let n = self.len();
        let mut header = format!("{{'descr': '<f8', 'fortran_order': False, 'shape': ({n}, {n}), }}");
        let unpadded = MAGIC.len() + 2 + header.len() + 1;
        header.push_str(&" ".repeat(unpadded.next_multiple_of(ALIGNMENT) - unpadded));
        header.push('\n');
        let mut bytes = Vec::with_capacity(MAGIC.len() + 2 + header.len() + 8 * n * n);
        bytes.extend(MAGIC);
        bytes.extend((header.len() as u16).to_le_bytes());
        bytes.extend(header.bytes());
        bytes.extend(self.values().iter().flat_map(|value| value.to_le_bytes()));
        bytes
    }

    /// Reads a `.npy` file of a square array of `float32` or `float64`. Without labels the items are called by their numbers,
    /// from 0, all of one width.
    ///
    /// # Errors
    /// [`SimilarityError::BadMatrix`] where the bytes are no such file, or the labels do not fit; whatever
    /// [`DistanceMatrix::from_values`] says.
    ///
    /// # Example
    /// ```
    /// use driftworld_similarity::{DistanceMatrix, SimilarityError};
    /// let matrix = DistanceMatrix::measure(vec!["a".into(), "b".into()], |_, _| Ok::<_, SimilarityError>(2.5))?;
    /// let bytes = matrix.to_npy();
    /// assert_eq!(bytes.len(), 128 + 4 * 8);
    /// assert_eq!(DistanceMatrix::from_npy(&bytes, Some(matrix.labels().to_vec()))?, matrix);
    /// # Ok::<(), SimilarityError>(())
    /// ```
    pub fn from_npy(bytes: &[u8], labels: Option<Vec<String>>) -> Result<Self, SimilarityError> {
        let header = Header::read(bytes)?;
        let n = Self::bounded(header.items)?;
        let expected = n * n * header.width;
        let data = &bytes[header.data..];
        if data.len() != expected {
            let found = format!("{} bytes", data.len());
            return Err(bad("numbers", found, format!("{expected} bytes: {n} × {n} numbers")));
        }
        let number = |k: usize| -> f64 {
            let bytes = &data[k * header.width..(k + 1) * header.width];
            match bytes.try_into() {
                Ok(wide) => f64::from_le_bytes(wide),
                Err(_) => bytes
                    .try_into()
                    .map_or(f64::NAN, |narrow| f64::from(f32::from_le_bytes(narrow))),
            }
        };
        let values = Array2::from_shape_fn((n, n), |(a, b)| number(a * n + b));
        let width = n.saturating_sub(1).to_string().len();
        let labels = labels.unwrap_or_else(|| (0..n).map(|index| format!("{index:0width$}")).collect());
        if labels.len() != n {
            let found = labels.len().to_string();
            return Err(bad("labels", found, format!("{n}, one for each row")));
        }
        Self::from_values(labels, values)
    }
}

/// What a file says of its array. By rows or by columns is all the same for a symmetric one.
struct Header {
    items: usize,
    /// Bytes of a number.
    width: usize,
    /// Where the numbers begin.
    data: usize,
}

impl Header {
    fn read(bytes: &[u8]) -> Result<Self, SimilarityError> {
        let start = bytes
            .get(..MAGIC.len() + 2)
            .filter(|start| start.starts_with(&MAGIC[..6]));
        let Some(start) = start else {
            return Err(bad("beginning", "no mark of numpy's format", "a .npy file"));
        };
        if start[6] != 1 {
            let found = format!("version {}.{} of numpy's format", start[6], start[7]);
            return Err(bad(
                "beginning",
                found,
                "version 1.0, which numpy.save writes for plain arrays",
            ));
        }
        let data = start.len() + usize::from(u16::from_le_bytes([start[8], start[9]]));
        let header = bytes
            .get(start.len()..data)
            .and_then(|header| std::str::from_utf8(header).ok());
        let header = header.ok_or_else(|| bad("heading", "fewer bytes than announced", "a whole heading"))?;
        let width = match value_of(header, "descr").map(|value| value.trim_matches(['\'', '"'])) {
            Some("<f8") => 8,
            Some("<f4") => 4,
            other => {
                let found = format!("numbers of the type {}", other.unwrap_or("unknown"));
                return Err(bad("heading", found, "'<f8' or '<f4', little-endian floats"));
            }
        };
        let shape = value_of(header, "shape").unwrap_or_default();
        let sizes: Option<Vec<usize>> = shape
            .trim_matches(['(', ')'])
            .split(',')
            .map(str::trim)
            .filter(|size| !size.is_empty())
            .map(|size| size.parse().ok())
            .collect();
        match sizes.as_deref() {
            Some([rows, columns]) if rows == columns => Ok(Self {
                items: *rows,
                width,
                data,
            }),
            _ => Err(bad("heading", format!("the shape {shape}"), "a square array")),
        }
    }
}

/// The text of a value in the heading, which is a dictionary in Python's notation.
fn value_of<'a>(header: &'a str, key: &str) -> Option<&'a str> {
    let after = header.split_once(&format!("'{key}':"))?.1.trim_start();
    let end = if after.starts_with('(') {
        after.find(')')? + 1
    } else {
        after.find([',', '}'])?
    };
    Some(after[..end].trim())
}

fn bad(place: &str, found: impl Into<String>, expected: impl Into<String>) -> SimilarityError {
    SimilarityError::BadMatrix {
        place: place.to_owned(),
        found: found.into(),
        expected: expected.into(),
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    /// The matrix that `tests/oracle/make_matrix.py` saves: `|a - b| + (a + b) / 8` off the diagonal.
    fn matrix() -> DistanceMatrix {
        let labels = (0..12).map(|k| format!("{k:02}")).collect();
        let measure = |a: usize, b: usize| Ok::<_, SimilarityError>(a.abs_diff(b) as f64 + (a + b) as f64 / 8.0);
        DistanceMatrix::measure(labels, measure).unwrap()
    }

    fn check_error(change: impl Fn(&mut Vec<u8>), expected: &str) {
        let mut bytes = matrix().to_npy();
        change(&mut bytes);
        let found = DistanceMatrix::from_npy(&bytes, None).unwrap_err();
        assert_eq!(found.to_string(), expected);
    }

    #[test]
    fn the_bytes_are_those_that_numpy_saves() {
        let saved = include_bytes!("../../tests/oracle/matrix_f8.npy");
        assert_eq!(matrix().to_npy(), saved);
        assert_eq!(DistanceMatrix::from_npy(saved, None).unwrap(), matrix());
    }

    #[test]
    fn single_precision_by_columns_reads_as_well() {
        let saved = include_bytes!("../../tests/oracle/matrix_f4_by_columns.npy");
        assert_eq!(DistanceMatrix::from_npy(saved, None).unwrap(), matrix());
    }

    #[test]
    fn what_is_no_square_array_of_floats_says_so() {
        check_error(
            |bytes| bytes[0] = b'P',
            "matrix, beginning: found no mark of numpy's format, expected a .npy file",
        );
        check_error(
            |bytes| bytes[6] = 3,
            "matrix, beginning: found version 3.0 of numpy's format, expected version 1.0, which numpy.save writes for plain arrays",
        );
        check_error(
            |bytes| bytes[22] = b'i',
            "matrix, heading: found numbers of the type <i8, expected '<f8' or '<f4', little-endian floats",
        );
        check_error(
            |bytes| bytes.truncate(200),
            "matrix, numbers: found 72 bytes, expected 1152 bytes: 12 × 12 numbers",
        );
        check_error(
            |bytes| bytes.truncate(40),
            "matrix, heading: found fewer bytes than announced, expected a whole heading",
        );
        let found = DistanceMatrix::from_npy(&matrix().to_npy(), Some(vec!["a".into()]));
        assert_eq!(
            found.unwrap_err().to_string(),
            "matrix, labels: found 1, expected 12, one for each row"
        );
    }
}
