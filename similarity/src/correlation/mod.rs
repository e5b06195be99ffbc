//! Correlations between two measures of the same pairs, and how often such a correlation arises by chance.

mod mantel;
mod pearson;
mod relabelling;
mod spearman;

use serde::{Deserialize, Serialize};
use strum::VariantArray;

pub use mantel::{MAX_MANTEL_ITEMS, MAX_RELABELLINGS, MantelTest, PairValue, mantel};
pub use pearson::pearson;
pub use spearman::{ranks, spearman};

use crate::SimilarityError;

/// Minimum number of pairs that can be correlated: two always lie on a straight line.
pub const MIN_CORRELATED: usize = 3;

/// A correlation coefficient.
#[derive(
    Clone,
    Copy,
    Debug,
    Default,
    PartialEq,
    Eq,
    Serialize,
    Deserialize,
    strum::Display,
    strum::EnumString,
    strum::IntoStaticStr,
    strum::VariantArray,
)]
#[serde(rename_all = "kebab-case")]
#[strum(serialize_all = "kebab-case", parse_err_ty = SimilarityError, parse_err_fn = unknown)]
pub enum Correlation {
    /// Of ranks: whether one rises with the other, however steeply. See [`spearman`].
    #[default]
    Spearman,
    /// Of values: whether they lie on a straight line. See [`pearson`].
    Pearson,
}

impl Correlation {
    /// All correlations.
    pub const ALL: &[Self] = Self::VARIANTS;

    /// The correlation's name on the command line.
    pub fn name(self) -> &'static str {
        self.into()
    }

    /// The correlation of two lists, −1 to 1.
    ///
    /// # Errors
    /// As [`spearman`] and [`pearson`].
    pub fn of(self, a: &[f64], b: &[f64]) -> Result<f64, SimilarityError> {
        match self {
            Self::Spearman => spearman(a, b),
            Self::Pearson => pearson(a, b),
        }
    }
}

fn unknown(word: &str) -> SimilarityError {
    SimilarityError::UnknownCorrelation { found: word.to_owned() }
}

/// Checks that two lists can be correlated: equal length, long enough, finite, not constant.
fn check(a: &[f64], b: &[f64]) -> Result<(), SimilarityError> {
    if a.len() != b.len() {
        return Err(SimilarityError::CorrelationLengths { a: a.len(), b: b.len() });
    }
    if a.len() < MIN_CORRELATED {
        return Err(SimilarityError::CorrelationTooFew {
            found: a.len(),
            needed: MIN_CORRELATED,
        });
    }
    for (list, values) in [("first", a), ("second", b)] {
        if let Some(place) = values.iter().position(|value| !value.is_finite()) {
            let found = values[place];
            return Err(SimilarityError::CorrelationNotFinite { list, place, found });
        }
        if values.iter().all(|value| *value == values[0]) {
            let found = values[0];
            return Err(SimilarityError::CorrelationConstant { list, found });
        }
    }
    Ok(())
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn impossible_correlations_are_refused_with_a_reason() {
        let message = |a: &[f64], b: &[f64]| {
            let of = |correlation: Correlation| correlation.of(a, b).unwrap_err().to_string();
            assert_eq!(of(Correlation::Spearman), of(Correlation::Pearson));
            of(Correlation::Spearman)
        };
        assert_eq!(
            message(&[1.0, 2.0, 3.0], &[1.0, 2.0]),
            "correlation: found lists of 3 and 2 numbers, expected equal lengths"
        );
        assert_eq!(
            message(&[1.0, 2.0], &[1.0, 2.0]),
            "correlation: found 2 pairs, expected at least 3: two always lie on a straight line; measure more"
        );
        assert_eq!(
            message(&[1.0, 2.0, 3.0], &[1.0, f64::NAN, 3.0]),
            "correlation: found NaN at index 1 of the second list, expected a finite number"
        );
        assert_eq!(
            message(&[2.0, 2.0, 2.0], &[1.0, 2.0, 3.0]),
            "correlation: found 2 everywhere in the first list, expected numbers that differ: correlation is \
             undefined for a constant list"
        );
        assert!("kendall".parse::<Correlation>().is_err());
        for &correlation in Correlation::ALL {
            assert_eq!(correlation.to_string().parse(), Ok(correlation));
        }
    }
}
