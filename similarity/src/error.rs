//! What can keep a distance or an order from being computed.

/// Everything that can go wrong in this crate.
#[derive(Debug, Clone, PartialEq, thiserror::Error)]
#[non_exhaustive]
pub enum SimilarityError {
    /// Variants of different tasks have no parameters to compare.
    #[error("found variants of the tasks {a:?} and {b:?}, expected two of one task; compare sampled worlds instead")]
    DifferentTasks {
        /// The first variant's task.
        a: String,
        /// The second variant's task.
        b: String,
    },
    /// A distance is not a number that a distance can be.
    #[error("distance of {a:?} to {b:?}: found {found}, expected a finite number of at least 0")]
    NotADistance {
        /// The first label.
        a: String,
        /// The second label.
        b: String,
        /// What was found.
        found: f64,
    },
    /// A matrix would not fit.
    #[error("found {found} items, expected at most {limit}; compare fewer at a time")]
    TooMany {
        /// How many there are.
        found: usize,
        /// How many are possible.
        limit: usize,
    },
    /// A method was asked for more items than it can put into an order.
    #[error("method {method}: found {found} items, expected at most {limit}; use the method two-opt")]
    TooManyForMethod {
        /// The method.
        method: &'static str,
        /// How many there are.
        found: usize,
        /// How many are possible.
        limit: usize,
    },
    /// An item that an order should begin or end with is not there.
    #[error("order: found {found} as the {end} item, expected one of 0 to {most}")]
    NoSuchEnd {
        /// "first" or "last".
        end: &'static str,
        /// The index asked for.
        found: usize,
        /// The last index there is.
        most: usize,
    },
    /// One item cannot be at both ends.
    #[error("order: found {label:?} as the first item and as the last, expected two different ones")]
    EqualEnds {
        /// The item.
        label: String,
    },
    /// A method chooses its ends by itself.
    #[error(
        "method {method}: found {label:?} as the {end} item, which this method cannot keep there; leave that end free or use the method two-opt"
    )]
    CannotFixEnds {
        /// The method.
        method: &'static str,
        /// "first" or "last".
        end: &'static str,
        /// The item.
        label: String,
    },
    /// A method whose promise needs the triangle inequality got distances that break it.
    #[error(
        "method {method}: found {a:?} and {b:?} {straight} apart but by way of {by:?} only {detour}, expected a metric; use the method two-opt"
    )]
    NotAMetric {
        /// The method.
        method: &'static str,
        /// One item.
        a: String,
        /// Another.
        b: String,
        /// The one between them.
        by: String,
        /// The distance of the two.
        straight: f64,
        /// The way by the third.
        detour: f64,
    },
    /// A method whose promise needs a metric got more items than can be checked for it.
    #[error(
        "method {method}: found {found} items whose measure is not known to be a metric, expected at most {limit} to check; declare the matrix's nature or use the method two-opt"
    )]
    NotCheckedAsMetric {
        /// The method.
        method: &'static str,
        /// How many there are.
        found: usize,
        /// How many would be checked.
        limit: usize,
    },
    /// The wanted step is missing or no length.
    #[error("method target-step: found {found} as the wanted step, expected a finite number of at least 0")]
    BadTargetStep {
        /// What was found.
        found: String,
    },
    /// There is nothing to order.
    #[error("order: found no items, expected at least 1")]
    Empty,
    /// A word that names no method.
    #[error("method: found {found:?}, expected one of {}", crate::Method::names())]
    UnknownMethod {
        /// The word.
        found: String,
    },
    /// A weight that cannot be one.
    #[error("weight of {name}: found {found}, expected a finite number of at least 0")]
    BadWeight {
        /// What it weighs.
        name: String,
        /// The weight.
        found: f64,
    },
}

impl SimilarityError {
    /// The stable name of this kind of error.
    pub fn code(&self) -> &'static str {
        match self {
            Self::DifferentTasks { .. } => "similarity/different-tasks",
            Self::NotADistance { .. } => "similarity/not-a-distance",
            Self::TooMany { .. } => "similarity/too-many",
            Self::TooManyForMethod { .. } => "similarity/too-many-for-method",
            Self::NoSuchEnd { .. } => "similarity/no-such-end",
            Self::EqualEnds { .. } => "similarity/equal-ends",
            Self::CannotFixEnds { .. } => "similarity/cannot-fix-ends",
            Self::NotAMetric { .. } => "similarity/not-a-metric",
            Self::NotCheckedAsMetric { .. } => "similarity/not-checked-as-metric",
            Self::BadTargetStep { .. } => "similarity/bad-target-step",
            Self::Empty => "similarity/empty",
            Self::UnknownMethod { .. } => "similarity/unknown-method",
            Self::BadWeight { .. } => "similarity/bad-weight",
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use std::collections::BTreeSet;

    #[test]
    fn every_error_has_its_message() {
        let errors = [
            SimilarityError::DifferentTasks {
                a: "one".into(),
                b: "two".into(),
            },
            SimilarityError::NotADistance {
                a: "one".into(),
                b: "two".into(),
                found: -1.0,
            },
            SimilarityError::TooMany {
                found: 30_000,
                limit: 20_000,
            },
            SimilarityError::TooManyForMethod {
                method: "exact",
                found: 16,
                limit: 15,
            },
            SimilarityError::NoSuchEnd {
                end: "first",
                found: 3,
                most: 2,
            },
            SimilarityError::EqualEnds { label: "one".into() },
            SimilarityError::CannotFixEnds {
                method: "spectral",
                end: "first",
                label: "one".into(),
            },
            SimilarityError::NotAMetric {
                method: "tree",
                a: "one".into(),
                b: "two".into(),
                by: "three".into(),
                straight: 4.0,
                detour: 2.0,
            },
            SimilarityError::NotCheckedAsMetric {
                method: "tree",
                found: 3000,
                limit: 2000,
            },
            SimilarityError::BadTargetStep { found: "none".into() },
            SimilarityError::Empty,
            SimilarityError::UnknownMethod {
                found: "shortest".into(),
            },
            SimilarityError::BadWeight {
                name: "reward".into(),
                found: f64::NAN,
            },
        ];
        let said: Vec<String> = errors
            .iter()
            .map(|error| format!("{}: {error}", error.code()))
            .collect();
        insta::assert_snapshot!(said.join("\n"));
        let covered: BTreeSet<&str> = errors.iter().map(SimilarityError::code).collect();
        let all: BTreeSet<&str> = include_str!("error.rs")
            .split('"')
            .filter(|word| word.starts_with("similarity/") && word.len() > 11)
            .collect();
        assert_eq!(covered, all, "every code has a case here");
    }
}
