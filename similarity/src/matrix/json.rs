//! Distance matrices as JSON: `labels`, `nature` and `values` row by row.

use driftworld_text::in_plain_words;
use ndarray::Array2;
use serde::Deserialize;

use super::DistanceMatrix;
use crate::{MetricProperties, SimilarityError};

#[derive(Deserialize)]
#[serde(deny_unknown_fields)]
struct Document {
    labels: Vec<String>,
    #[serde(default, rename = "nature")]
    properties: MetricProperties,
    values: Vec<Vec<f64>>,
}

impl DistanceMatrix {
    /// The matrix as JSON. Every number reads back exactly.
    pub fn to_json(&self) -> String {
        serde_json::to_string(self).expect("labels and finite numbers are valid JSON")
    }

    /// Reads the output of [`DistanceMatrix::to_json`]; `nature` may be left out.
    ///
    /// # Errors
    /// [`SimilarityError::BadMatrix`] if the text is not such a document; otherwise as [`DistanceMatrix::from_values`].
    ///
    /// # Example
    /// ```
    /// use driftworld_similarity::{DistanceMatrix, MetricProperties};
    /// let text = r#"{"labels": ["a", "b"], "nature": "metric", "values": [[0, 2.5], [2.5, 0]]}"#;
    /// let matrix = DistanceMatrix::from_json(text)?;
    /// assert_eq!((matrix.get(0, 1), matrix.properties()), (2.5, MetricProperties::Metric));
    /// # Ok::<(), driftworld_similarity::SimilarityError>(())
    /// ```
    pub fn from_json(text: &str) -> Result<Self, SimilarityError> {
        let document: Document = serde_json::from_str(text).map_err(|error| SimilarityError::BadMatrix {
            place: format!("line {} column {}", error.line(), error.column()),
            found: without_position(&error),
            expected: "an object with labels, nature and values".to_owned(),
        })?;
        let n = Self::bounded(document.labels.len())?;
        let bad = |place: String, found: usize| SimilarityError::BadMatrix {
            place,
            found: found.to_string(),
            expected: format!("{n}, one for each label"),
        };
        if document.values.len() != n {
            return Err(bad("number of rows".to_owned(), document.values.len()));
        }
        if let Some((index, row)) = document.values.iter().enumerate().find(|(_, row)| row.len() != n) {
            return Err(bad(format!("length of row {}", index + 1), row.len()));
        }
        let values = Array2::from_shape_fn((n, n), |(a, b)| document.values[a][b]);
        Ok(Self::from_values(document.labels, values)?.with_properties(document.properties))
    }
}

/// The JSON reader's message without the position, which the error states separately.
fn without_position(error: &serde_json::Error) -> String {
    let message = error.to_string();
    let end = message.rfind(" at line ").unwrap_or(message.len());
    in_plain_words(&message[..end])
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn json_round_trips() {
        let names = ["a", "say \"x\"", "é"].map(String::from).to_vec();
        let measure = |a: usize, b: usize| Ok::<_, SimilarityError>(((a + 3 * b) as f64).sqrt());
        let matrix = DistanceMatrix::measure(names, measure)
            .unwrap()
            .with_properties(MetricProperties::Metric);
        assert_eq!(DistanceMatrix::from_json(&matrix.to_json()).unwrap(), matrix);
    }

    #[test]
    fn bad_json_error_names_the_place() {
        let unknown = DistanceMatrix::from_json("{\"labels\": [\"a\"],\n \"rows\": []}").unwrap_err();
        let expected = "matrix, line 2 column 7: found unknown field `rows`, expected one of `labels`, `nature`, `values`, \
                        expected an object with labels, nature and values";
        assert_eq!(unknown.to_string(), expected);
        for row in r#"
"values": [[0, 1]] => matrix, number of rows: found 1, expected 2, one for each label
"values": [[0, 1], [1]] => matrix, length of row 2: found 1, expected 2, one for each label
"values": [[0, -1], [-1, 0]] => distance of "a" to "b": found -1, expected a number from 0 to 1e100"#
            .trim()
            .lines()
        {
            let (rest, expected) = row.split_once(" => ").expect("a row has two parts");
            let text = format!("{{\"labels\": [\"a\", \"b\"],\n {rest}}}");
            assert_eq!(
                DistanceMatrix::from_json(&text).unwrap_err().to_string(),
                expected,
                "{text}"
            );
        }
    }
}
