//! [`Method`]: every ordering method by name, and the default one. Each is implemented in the file of its name.

use driftworld_text::{WordKind, removed};
use serde::Serialize;
use strum::VariantArray;

use super::exact::MAX_EXACT;
use crate::SimilarityError;

/// How items are put into an order.
#[derive(
    Clone, Copy, Debug, PartialEq, Eq, Serialize, strum::EnumString, strum::IntoStaticStr, strum::VariantArray,
)]
#[serde(rename_all = "kebab-case")]
#[strum(serialize_all = "kebab-case", parse_err_ty = SimilarityError, parse_err_fn = unknown)]
pub enum Method {
    /// Each time the nearest that is left. Simple, and often far from the shortest.
    Nearest,
    /// The shortest path, by dynamic programming (Held and Karp 1962). For up to 15 items.
    Exact,
    /// The nearest walk, then stretches are turned round (2-opt) and moved (Or-opt), and the path shaken, while that shortens it.
    TwoOpt,
    /// The longest path: neighbours unlike each other. Exact for up to 15 items.
    Abrupt,
    /// Each time what is farthest from everything met so far: as new as can be (farthest-first traversal).
    Farthest,
    /// At random, from a seed: a control.
    Random,
    /// Every step close to a wanted one. Exact for up to 15 items.
    TargetStep,
    /// In small steps: the shortest path, and of equally short ones that whose largest step is smallest. Exact for up to 15 items.
    Gradual,
    /// By growing distance from the first: what is most like it comes next, what is least like it comes last.
    Outward,
    /// As the items stand in the matrix.
    Given,
}

impl Method {
    /// Every method.
    pub const ALL: &[Self] = Self::VARIANTS;

    /// Exact where that is possible, 2-opt beyond.
    pub fn default_for(items: usize) -> Self {
        if items <= MAX_EXACT { Self::Exact } else { Self::TwoOpt }
    }

    /// Whether the method looks for the best path from an item that is asked for as the first.
    pub fn seeks_from_a_first(self) -> bool {
        !matches!(self, Self::Random | Self::Given)
    }

    /// The word by which the command line calls it.
    pub fn name(self) -> &'static str {
        self.into()
    }

    /// What to use in place of a word that names no method.
    pub(crate) fn advice_for(word: &str) -> String {
        removed(WordKind::Order, word).unwrap_or_else(|| {
            let names: Vec<&str> = Self::ALL.iter().map(|method| method.name()).collect();
            format!("expected one of {}", names.join(", "))
        })
    }
}

fn unknown(word: &str) -> SimilarityError {
    SimilarityError::UnknownMethod { found: word.to_owned() }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn every_name_leads_back_to_its_method_and_serialises_as_such() {
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
