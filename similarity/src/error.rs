//! What can keep a distance or an order from being computed.

use driftworld_text::one_line;

/// Everything that can go wrong in this crate.
#[derive(Debug, Clone, PartialEq, thiserror::Error, strum::IntoStaticStr, strum::VariantNames)]
#[strum(prefix = "similarity/", serialize_all = "kebab-case")]
#[non_exhaustive]
pub enum SimilarityError {
    /// Variants of different tasks have no parameters to compare.
    #[error(
        "found variants of the tasks {a:?} and {b:?}, expected two of one task, of one and the same document; compare sampled worlds instead"
    )]
    DifferentTasks {
        /// The first variant's task.
        a: String,
        /// The second variant's task.
        b: String,
    },
    /// A distance is not a number that a distance can be.
    #[error("distance of {a:?} to {b:?}: found {found}, expected a number from 0 to 1e100")]
    NotADistance {
        /// The first label.
        a: String,
        /// The second label.
        b: String,
        /// What was found.
        found: f64,
    },
    /// A mass that nothing can have.
    #[error("mass {index} of {side}: found {found}, expected a number from 0 to 1e200")]
    BadMass {
        /// Which masses it is among.
        side: &'static str,
        /// Its place among them, from 0.
        index: usize,
        /// The mass.
        found: f64,
    },
    /// A coordinate that no point can have.
    #[error("point {index} of {side}: found the coordinate {found}, expected a number of metres from -1e100 to 1e100")]
    BadPoint {
        /// Which points it is among.
        side: &'static str,
        /// Its place among them, from 0.
        index: usize,
        /// The coordinate.
        found: f64,
    },
    /// Mass cannot be moved to where there is more room, or less, than mass.
    #[error(
        "masses: found sums of {from} and {to}, expected equal sums; divide each mass by its sum, or use a distance for unequal masses"
    )]
    UnequalMasses {
        /// The sum at the origins.
        from: f64,
        /// The sum at the destinations.
        to: f64,
    },
    /// Grids that are not of one raster.
    #[error("grids: found {a} and {b}, expected equal shapes; make both with one raster")]
    GridsDiffer {
        /// The first one's shape.
        a: String,
        /// The second one's shape.
        b: String,
    },
    /// A grid would not fit.
    #[error("grid: found {found} cells, expected at most {limit}; use larger cells, a smaller extent or fewer classes")]
    TooFine {
        /// How many there are.
        found: usize,
        /// How many are possible.
        limit: usize,
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
    /// What was read, or handed in, is no matrix of distances.
    #[error("matrix, {place}: found {found}, expected {expected}", place = one_line(place), found = one_line(found), expected = one_line(expected))]
    BadMatrix {
        /// Where in the text or the matrix.
        place: String,
        /// What is there.
        found: String,
        /// What should be.
        expected: String,
    },
    /// The wanted step is missing or no length.
    #[error("method target-step: found {found} as the wanted step, expected a finite number of at least 0")]
    BadTargetStep {
        /// What was found.
        found: String,
    },
    /// There are no samples to compare.
    #[error("samples: found none, expected at least 1")]
    NoSamples,
    /// There is nothing to order.
    #[error("order: found no items, expected at least 1")]
    Empty,
    /// A word that names no method.
    #[error("method: found {found:?}, {}", crate::Method::advice_for(found))]
    UnknownMethod {
        /// The word.
        found: String,
    },
    /// Lists that are to be correlated are not of one length.
    #[error("correlation: found lists of {a} and {b} numbers, expected as many in both")]
    CorrelationLengths {
        /// Numbers in the first list.
        a: usize,
        /// Numbers in the second list.
        b: usize,
    },
    /// Too few pairs to be correlated.
    #[error(
        "correlation: found {found} pairs, expected at least {needed}: two always lie on a straight line; measure more"
    )]
    CorrelationTooFew {
        /// How many there are.
        found: usize,
        /// How many are needed.
        needed: usize,
    },
    /// A number to be correlated is none.
    #[error("correlation: found {found} at place {place} of the {list} list, expected a finite number")]
    CorrelationNotFinite {
        /// First or second.
        list: &'static str,
        /// The place in it, from 0.
        place: usize,
        /// What was found.
        found: f64,
    },
    /// A list to be correlated is all one number.
    #[error(
        "correlation: found {found} everywhere in the {list} list, expected numbers that differ: what never changes goes \
         together with nothing"
    )]
    CorrelationConstant {
        /// First or second.
        list: &'static str,
        /// The number.
        found: f64,
    },
    /// A word that names no correlation.
    #[error("correlation: found {found:?}, expected spearman or pearson")]
    UnknownCorrelation {
        /// The word.
        found: String,
    },
    /// A pair that a Mantel test cannot take.
    #[error("mantel test: found a value for the pair {from} to {to} {found}, expected {expected}")]
    MantelPair {
        /// The first item's index.
        from: usize,
        /// The second item's index.
        to: usize,
        /// What is wrong with it.
        found: &'static str,
        /// What it should be.
        expected: &'static str,
    },
    /// More or fewer of something than a Mantel test can take.
    #[error("mantel test: found {found} {what}, expected 1 to {limit}")]
    MantelCount {
        /// What is counted.
        what: &'static str,
        /// How many there are.
        found: u64,
        /// How many are possible.
        limit: u64,
    },
    /// A weight that cannot be one.
    #[error("weight of {name}: found {found}, expected a number from 0 to 1000000")]
    BadWeight {
        /// What it weighs.
        name: String,
        /// The weight.
        found: f64,
    },
    /// Numbers that do not fill the table they are for, or fill more.
    #[error("{of}: found {found} numbers, expected {expected}")]
    Shape {
        /// What the numbers are.
        of: &'static str,
        /// How many there are.
        found: usize,
        /// How many there should be.
        expected: usize,
    },
    /// A cost that cannot be added up.
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
    /// A number that is not what it is taken for.
    #[error("{of}: found {found}, expected {expected}")]
    BadNumber {
        /// What the number is.
        of: &'static str,
        /// The number.
        found: f64,
        /// What would do.
        expected: &'static str,
    },
    /// A table of costs in which one is not a distance.
    #[error("cost of {a:?} to {b:?}: found {found}, expected {expected}")]
    BadTable {
        /// The first choice.
        a: String,
        /// The second choice.
        b: String,
        /// The cost.
        found: f64,
        /// What would do.
        expected: String,
    },
    /// A name that is there more than once.
    #[error("choices: found {name:?} more than once, expected each once; remove one")]
    TwiceNamed {
        /// The name.
        name: String,
    },
    /// A choice that a table of costs does not have.
    #[error("choice: found {found:?}, expected one of {expected}; add it to the cost table", expected = one_line(expected))]
    UnknownChoice {
        /// The choice.
        found: String,
        /// Those that it has.
        expected: String,
    },
    /// Two that are to be compared place by place do not have as many places.
    #[error("{of}: found {a} and {b} {what}, expected as many in both")]
    SizesDiffer {
        /// What is compared.
        of: &'static str,
        /// What is counted.
        what: &'static str,
        /// How many the first has.
        a: usize,
        /// How many the second has.
        b: usize,
    },
    /// A reward that nothing can pay.
    #[error("reward of {place}: found {found}, expected a number from -1e100 to 1e100")]
    BadReward {
        /// For what it is paid.
        place: String,
        /// The reward.
        found: f64,
    },
    /// A state that a decision process does not have.
    #[error("state of a decision process: found {found}, expected one of 0 to {most}")]
    NoSuchState {
        /// The state.
        found: usize,
        /// The last there is.
        most: usize,
    },
    /// Pictures that do not lie on each other.
    #[error(
        "picture: found {found} pixels (height × width), expected {expected} as in the other; render both at one size"
    )]
    PictureSizes {
        /// The second picture's height and width.
        found: String,
        /// The first picture's.
        expected: String,
    },
    /// Sets of pictures without any.
    #[error("pictures: found none, expected at least 1 of each world; render from at least one pose")]
    NoPictures,
    /// A picture with a side that is too short or too long.
    #[error("picture: found a side of {found} pixels, expected {least} to {most}")]
    PictureSide {
        /// The side.
        found: usize,
        /// The least.
        least: usize,
        /// The most.
        most: usize,
    },
}

impl SimilarityError {
    /// The stable name of this kind of error.
    pub fn code(&self) -> &'static str {
        self.into()
    }

    /// Refuses more items than can be compared at a time.
    pub(crate) fn check_count(found: usize, limit: usize) -> Result<(), Self> {
        if found > limit {
            return Err(Self::TooMany { found, limit });
        }
        Ok(())
    }

    /// Refuses a list of another length than its shape has.
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
                expected: "1 as on the way back".into(),
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
        let said: Vec<String> = errors
            .iter()
            .map(|error| format!("{}: {error}", error.code()))
            .collect();
        insta::assert_snapshot!(said.join("\n"));
        let covered: BTreeSet<&str> = errors.iter().map(SimilarityError::code).collect();
        let all: BTreeSet<&str> = SimilarityError::VARIANTS.iter().copied().collect();
        assert_eq!(covered, all, "every code has a case here");
    }
}
