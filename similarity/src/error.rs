//! Errors raised while computing distances and orders.

use driftworld_text::one_line;

/// An error of this crate.
#[derive(Debug, Clone, PartialEq, thiserror::Error, strum::IntoStaticStr, strum::VariantNames)]
#[strum(prefix = "similarity/", serialize_all = "kebab-case")]
#[non_exhaustive]
pub enum SimilarityError {
    /// Variants of different tasks have no parameters to compare.
    #[error(
        "found variants of the tasks {a:?} and {b:?}, expected variants of one task from one document; compare sampled worlds instead"
    )]
    DifferentTasks {
        /// The first variant's task.
        a: String,
        /// The second variant's task.
        b: String,
    },
    /// A distance is negative or not finite.
    #[error("distance of {a:?} to {b:?}: found {found}, expected a number from 0 to 1e100")]
    NotADistance {
        /// The first label.
        a: String,
        /// The second label.
        b: String,
        /// The number found.
        found: f64,
    },
    /// An invalid mass.
    #[error("mass {index} of {side}: found {found}, expected a number from 0 to 1e200")]
    BadMass {
        /// The list that contains it.
        side: &'static str,
        /// Its index, from 0.
        index: usize,
        /// The mass.
        found: f64,
    },
    /// An invalid coordinate.
    #[error("point {index} of {side}: found the coordinate {found}, expected a number of metres from -1e100 to 1e100")]
    BadPoint {
        /// The list of points that contains it.
        side: &'static str,
        /// The point's index, from 0.
        index: usize,
        /// The coordinate.
        found: f64,
    },
    /// The total masses differ, so one cannot be moved onto the other.
    #[error(
        "masses: found sums of {from} and {to}, expected equal sums; divide each mass by its sum, or use a distance for unequal masses"
    )]
    UnequalMasses {
        /// The sum at the origins.
        from: f64,
        /// The sum at the destinations.
        to: f64,
    },
    /// Grids of different shapes.
    #[error("grids: found {a} and {b}, expected equal shapes; make both with one raster")]
    GridsDiffer {
        /// The first one's shape.
        a: String,
        /// The second one's shape.
        b: String,
    },
    /// A grid would not fit in memory.
    #[error("grid: found {found} cells, expected at most {limit}; use larger cells, a smaller extent or fewer classes")]
    TooFine {
        /// The number found.
        found: usize,
        /// The largest allowed.
        limit: usize,
    },
    /// A matrix would not fit in memory.
    #[error("found {found} items, expected at most {limit}; compare fewer at a time")]
    TooMany {
        /// The number found.
        found: usize,
        /// The largest allowed.
        limit: usize,
    },
    /// More items than a method can order.
    #[error("method {method}: found {found} items, expected at most {limit}; use the method two-opt")]
    TooManyForMethod {
        /// The method.
        method: &'static str,
        /// The number found.
        found: usize,
        /// The largest allowed.
        limit: usize,
    },
    /// The requested first or last item does not exist.
    #[error("order: found {found} as the {end} item, expected one of 0 to {most}")]
    NoSuchEnd {
        /// "first" or "last".
        end: &'static str,
        /// The index asked for.
        found: usize,
        /// The largest valid index.
        most: usize,
    },
    /// The same item was given for both ends.
    #[error("order: found {label:?} as the first item and as the last, expected two different ones")]
    EqualEnds {
        /// The item.
        label: String,
    },
    /// A distance matrix, read or passed in, is invalid.
    #[error("matrix, {place}: found {found}, expected {expected}", place = one_line(place), found = one_line(found), expected = one_line(expected))]
    BadMatrix {
        /// The position in the text or the matrix.
        place: String,
        /// The text or value found.
        found: String,
        /// The expected text or value.
        expected: String,
    },
    /// The target step is missing or not a length.
    #[error("method target-step: found {found} as the target step, expected a finite number of at least 0")]
    BadTargetStep {
        /// The text or value found.
        found: String,
    },
    /// There are no samples to compare.
    #[error("samples: found none, expected at least 1")]
    NoSamples,
    /// There is nothing to order.
    #[error("order: found no items, expected at least 1")]
    Empty,
    /// An unknown method.
    #[error("method: found {found:?}, {advice}")]
    UnknownMethod {
        /// The word.
        found: String,
        /// What to write instead.
        advice: String,
    },
    /// Lists to correlate have different lengths.
    #[error("correlation: found lists of {a} and {b} numbers, expected equal lengths")]
    CorrelationLengths {
        /// Numbers in the first list.
        a: usize,
        /// Numbers in the second list.
        b: usize,
    },
    /// Too few pairs to correlate.
    #[error(
        "correlation: found {found} pairs, expected at least {needed}: two always lie on a straight line; measure more"
    )]
    CorrelationTooFew {
        /// The number found.
        found: usize,
        /// The number needed.
        needed: usize,
    },
    /// A number to correlate is not finite.
    #[error("correlation: found {found} at index {place} of the {list} list, expected a finite number")]
    CorrelationNotFinite {
        /// First or second.
        list: &'static str,
        /// Its index, from 0.
        place: usize,
        /// The number found.
        found: f64,
    },
    /// A list to correlate is constant.
    #[error(
        "correlation: found {found} everywhere in the {list} list, expected numbers that differ: correlation is \
         undefined for a constant list"
    )]
    CorrelationConstant {
        /// First or second.
        list: &'static str,
        /// The number.
        found: f64,
    },
    /// An unknown correlation.
    #[error("correlation: found {found:?}, expected spearman or pearson")]
    UnknownCorrelation {
        /// The word.
        found: String,
    },
    /// An invalid pair for a Mantel test.
    #[error("mantel test: found a value for the pair {from} to {to} {found}, expected {expected}")]
    MantelPair {
        /// The first item's index.
        from: usize,
        /// The second item's index.
        to: usize,
        /// The fault.
        found: &'static str,
        /// The expected pair.
        expected: &'static str,
    },
    /// A count out of range for a Mantel test.
    #[error("mantel test: found {found} {what}, expected 1 to {limit}")]
    MantelCount {
        /// The thing counted.
        what: &'static str,
        /// The number found.
        found: u64,
        /// The largest allowed.
        limit: u64,
    },
    /// An invalid weight.
    #[error("weight of {name}: found {found}, expected a number from 0 to 1000000")]
    BadWeight {
        /// The name of the weighted thing.
        name: String,
        /// The weight.
        found: f64,
    },
    /// A table with the wrong number of entries.
    #[error("{of}: found {found} numbers, expected {expected}")]
    Shape {
        /// The kind of entries.
        of: &'static str,
        /// The number found.
        found: usize,
        /// The number expected.
        expected: usize,
    },
    /// A cost too large to add up, or not finite.
    #[error(
        "cost in row {row}, column {column}: found {found}, expected a number from -1e200 to 1e200; use a large cost to keep two apart"
    )]
    BadCost {
        /// The row, from 0.
        row: usize,
        /// The column, from 0.
        column: usize,
        /// The cost.
        found: f64,
    },
    /// A number out of range.
    #[error("{of}: found {found}, expected {expected}")]
    BadNumber {
        /// The number's meaning.
        of: &'static str,
        /// The number found.
        found: f64,
        /// The expected range.
        expected: &'static str,
    },
    /// A table of costs with an entry that is not a distance.
    #[error("cost of {a:?} to {b:?}: found {found}, expected {expected}")]
    BadTable {
        /// The first choice.
        a: String,
        /// The second choice.
        b: String,
        /// The cost found.
        found: f64,
        /// The expected cost.
        expected: String,
    },
    /// A name that occurs more than once.
    #[error("choices: found {name:?} more than once, expected each once; remove one")]
    TwiceNamed {
        /// The name.
        name: String,
    },
    /// A choice that is not in a table of costs.
    #[error("choice: found {found:?}, expected one of {expected}; add it to the cost table", expected = one_line(expected))]
    UnknownChoice {
        /// The choice found.
        found: String,
        /// The choices in the table.
        expected: String,
    },
    /// Two things to compare element by element have different sizes.
    #[error("{of}: found {a} and {b} {what}, expected equal numbers")]
    SizesDiffer {
        /// The things compared.
        of: &'static str,
        /// The elements counted.
        what: &'static str,
        /// The first one's number of elements.
        a: usize,
        /// The second one's number of elements.
        b: usize,
    },
    /// An invalid reward.
    #[error("reward of {place}: found {found}, expected a number from -1e100 to 1e100")]
    BadReward {
        /// The event that pays it.
        place: String,
        /// The reward.
        found: f64,
    },
    /// A state that is not in the decision process.
    #[error("state of a decision process: found {found}, expected one of 0 to {most}")]
    NoSuchState {
        /// The state.
        found: usize,
        /// The largest valid state.
        most: usize,
    },
    /// Pictures of different sizes.
    #[error(
        "picture: found {found} pixels (height × width), expected {expected} as in the other; render both at one size"
    )]
    PictureSizes {
        /// The second picture's height and width.
        found: String,
        /// The first picture's.
        expected: String,
    },
    /// Sets without pictures.
    #[error("pictures: found none, expected at least 1 of each world; render from at least one pose")]
    NoPictures,
    /// A picture with a side that is too short or too long.
    #[error("picture: found a side of {found} pixels, expected {least} to {most}")]
    PictureSide {
        /// The side.
        found: usize,
        /// The shortest allowed.
        least: usize,
        /// The longest allowed.
        most: usize,
    },
}

impl SimilarityError {
    /// The stable name of this kind of error.
    pub fn code(&self) -> &'static str {
        self.into()
    }

    /// Fails if there are more items than can be compared at a time.
    pub(crate) fn check_count(found: usize, limit: usize) -> Result<(), Self> {
        if found > limit {
            return Err(Self::TooMany { found, limit });
        }
        Ok(())
    }

    /// Fails if a list's length differs from its shape.
    pub(crate) fn check_length(of: &'static str, found: usize, expected: usize) -> Result<(), Self> {
        if found != expected {
            return Err(Self::Shape { of, found, expected });
        }
        Ok(())
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use std::collections::BTreeSet;
    use strum::VariantNames;

    #[test]
    #[expect(clippy::too_many_lines, reason = "each kind of error has a case")]
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
            SimilarityError::BadMass {
                side: "from",
                index: 3,
                found: -1.0,
            },
            SimilarityError::BadPoint {
                side: "a",
                index: 0,
                found: f64::NAN,
            },
            SimilarityError::UnequalMasses { from: 1.0, to: 2.5 },
            SimilarityError::GridsDiffer {
                a: "3 × 3 × 1 cells of 1 m".into(),
                b: "3 × 4 × 1 cells of 1 m".into(),
            },
            SimilarityError::TooFine {
                found: 2_000_000,
                limit: 1_048_576,
            },
            SimilarityError::TooMany {
                found: 30_000,
                limit: 20_000,
            },
            SimilarityError::NoSamples,
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
            SimilarityError::BadMatrix {
                place: "line 2".into(),
                found: "\"far\"".into(),
                expected: "a number".into(),
            },
            SimilarityError::BadTargetStep { found: "none".into() },
            SimilarityError::Empty,
            SimilarityError::UnknownMethod {
                found: "shortest".into(),
                advice: "expected one of nearest, exact, two-opt".into(),
            },
            SimilarityError::CorrelationLengths { a: 3, b: 2 },
            SimilarityError::CorrelationTooFew { found: 2, needed: 3 },
            SimilarityError::CorrelationNotFinite {
                list: "second",
                place: 1,
                found: f64::NAN,
            },
            SimilarityError::CorrelationConstant {
                list: "first",
                found: 2.0,
            },
            SimilarityError::UnknownCorrelation {
                found: "kendall".into(),
            },
            SimilarityError::MantelPair {
                from: 0,
                to: 9,
                found: "that the matrix does not have",
                expected: "indices of its items",
            },
            SimilarityError::MantelCount {
                what: "relabellings",
                found: 0,
                limit: 10,
            },
            SimilarityError::BadWeight {
                name: "reward".into(),
                found: f64::NAN,
            },
            SimilarityError::Shape {
                of: "costs",
                found: 5,
                expected: 6,
            },
            SimilarityError::BadCost {
                row: 1,
                column: 2,
                found: f64::INFINITY,
            },
            SimilarityError::BadNumber {
                of: "a scale",
                found: -2.0,
                expected: "a finite number above 0",
            },
            SimilarityError::BadTable {
                a: "walk".into(),
                b: "run".into(),
                found: 2.0,
                expected: "1, the cost in the other direction".into(),
            },
            SimilarityError::TwiceNamed { name: "walk".into() },
            SimilarityError::UnknownChoice {
                found: "swim".into(),
                expected: "fly, run, walk".into(),
            },
            SimilarityError::SizesDiffer {
                of: "rewards",
                what: "states",
                a: 3,
                b: 4,
            },
            SimilarityError::BadReward {
                place: "state 3, action 1".into(),
                found: f64::INFINITY,
            },
            SimilarityError::NoSuchState { found: 9, most: 4 },
            SimilarityError::PictureSizes {
                found: "64 × 64".into(),
                expected: "84 × 84".into(),
            },
            SimilarityError::NoPictures,
            SimilarityError::PictureSide {
                found: 8,
                least: 11,
                most: 4096,
            },
        ];
        let messages: Vec<String> = errors
            .iter()
            .map(|error| format!("{}: {error}", error.code()))
            .collect();
        insta::assert_snapshot!(messages.join("\n"));
        let covered: BTreeSet<&str> = errors.iter().map(SimilarityError::code).collect();
        let all: BTreeSet<&str> = SimilarityError::VARIANTS.iter().copied().collect();
        assert_eq!(covered, all, "every code has a case here");
    }
}
