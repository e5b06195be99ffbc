//! [`Method`]: every ordering method by name, and the default one.

use driftworld_text::{WordKind, removed};
use serde::Serialize;
use strum::VariantArray;

use super::exact::MAX_EXACT;
use crate::SimilarityError;

/// A method for ordering items.
#[derive(
    Clone, Copy, Debug, PartialEq, Eq, Serialize, strum::EnumString, strum::IntoStaticStr, strum::VariantArray,
)]
#[serde(rename_all = "kebab-case")]
#[strum(serialize_all = "kebab-case", parse_err_ty = SimilarityError, parse_err_fn = unknown)]
pub enum Method {
    /// Always the nearest remaining item. Simple, and often far from the shortest path.
    Nearest,
    /// The shortest path, by dynamic programming (Held and Karp 1962). For up to 15 items.
    Exact,
    /// The nearest-neighbour path, improved by reversing stretches (2-opt), moving them (Or-opt) and shaking, while that
    /// shortens it.
    TwoOpt,
    /// The longest path: neighbours are as different as possible. Exact for up to 15 items.
    Abrupt,
    /// Always the item farthest from all items so far: maximal novelty (farthest-first traversal).
    Farthest,
    /// At random, from a seed: a control.
    Random,
    /// Every step close to a target length. Exact for up to 15 items.
    TargetStep,
    /// Small steps: the shortest path; ties go to the smaller largest step. Exact for up to 15 items.
    Gradual,
    /// By increasing distance from the first: the most similar item comes next, the least similar last.
    Outward,
    /// The order of the matrix.
    Given,
}

impl Method {
    /// Every method.
    pub const ALL: &[Self] = Self::VARIANTS;

    /// [`Method::Exact`] for up to 15 items, otherwise [`Method::TwoOpt`].
    pub fn default_for(items: usize) -> Self {
        if items <= MAX_EXACT { Self::Exact } else { Self::TwoOpt }
    }

    /// Whether the method searches for the best path from a given first item.
    pub fn seeks_from_a_first(self) -> bool {
        !matches!(self, Self::Random | Self::Given)
    }

    /// The method's name on the command line.
    pub fn name(self) -> &'static str {
        self.into()
    }
}

fn unknown(word: &str) -> SimilarityError {
    let advice = removed(WordKind::Order, word).unwrap_or_else(|| {
        let names: Vec<&str> = Method::ALL.iter().map(|method| method.name()).collect();
        format!("expected one of {}", names.join(", "))
    });
    SimilarityError::UnknownMethod {
        found: word.to_owned(),
        advice,
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn method_names_round_trip_and_serialise() {
        for &method in Method::ALL {
            assert_eq!(method.name().parse(), Ok(method));
            assert_eq!(
                serde_json::to_string(&method).unwrap(),
                format!("\"{}\"", method.name())
            );
        }
        assert!("Exact".parse::<Method>().is_err());
    }
}
