//! [`GeneratorError`]: errors raised while sampling a world, interpolating variants or searching for a distance.

use std::fmt::{Display, Formatter, Result};

use driftworld_spec::SpecError;

/// Errors of this crate.
#[derive(Debug, Clone, PartialEq, thiserror::Error, strum::IntoStaticStr, strum::VariantNames)]
#[strum(prefix = "generator/", serialize_all = "kebab-case")]
#[non_exhaustive]
pub enum GeneratorError {
    /// A draw fell outside the range allowed for its key in the world.
    #[error(
        "{world} ({place}): drew {found}, expected a number in {low}..{high}; use a bounded distribution, such as \
         truncated_normal"
    )]
    OutOfRange {
        /// The world.
        world: WorldId,
        /// The key of the value, as a pointer into the spec.
        place: String,
        /// The drawn number.
        found: f64,
        /// Smallest number allowed there.
        low: f64,
        /// Largest number allowed there.
        high: f64,
    },
    /// No free position was found for an object within the allowed number of tries.
    #[error(
        "{world}: group {group:?}, object {object} of {count}: found no free place in {}; {reason}",
        tried(*tries)
    )]
    NoPlace {
        /// The world.
        world: WorldId,
        /// The group.
        group: String,
        /// The object's number within the group, from 1.
        object: u32,
        /// Number of objects that the group should have.
        count: u32,
        /// Number of positions tried.
        tries: u32,
        /// The condition that most positions failed, the closest miss, and which field to relax.
        reason: String,
    },
    /// The agent starts outside the arena or in a region that cannot be entered.
    #[error(
        "{world}: found the agent's start at {start:?} in {}, expected free space inside the arena; move \
         agent_params.coordinates, or widen their distribution; in mazes, rooms and texts {{ \"cells\": {{}} }} means any \
         free cell",
        tried(*tries)
    )]
    NoStart {
        /// The world.
        world: WorldId,
        /// The last start tried, in metres.
        start: [f64; 2],
        /// Number of starts tried.
        tries: u32,
    },
    /// The layout has no cell in which the agent can start.
    #[error("{world}: found no cell for the agent's start: {reason}")]
    NoStartCell {
        /// The world.
        world: WorldId,
        /// The request, and the number of cells.
        reason: String,
    },
    /// One of the task's requirements failed in every try.
    #[error(
        "{world}: found no values in {tries} tries that satisfy the requirement {requirement:?}; the last were \
         {values}; widen the distributions, or relax the requirement"
    )]
    Requirement {
        /// The world.
        world: WorldId,
        /// The requirement.
        requirement: String,
        /// The values of the last try.
        values: String,
        /// Number of tries.
        tries: u32,
    },
    /// All groups together have more objects than a world can hold.
    #[error("{world}: found {found} objects, expected at most {limit}; lower the counts")]
    TooMany {
        /// The world.
        world: WorldId,
        /// Number of objects drawn.
        found: usize,
        /// Maximum number of objects in a world.
        limit: usize,
    },
    /// The drawn values are incompatible, such as large images with much supersampling.
    #[error("{world}: drew incompatible values: {source}")]
    Clash {
        /// The world.
        world: WorldId,
        /// The problem with the world.
        source: SpecError,
    },
    /// Two variants of different tasks cannot be interpolated.
    #[error(
        "found {from} and {to}, expected two variants of one task; a drift stays within a task, a curriculum switches \
         between tasks"
    )]
    DifferentTasks {
        /// The first variant.
        from: String,
        /// The second variant.
        to: String,
    },
    /// A variant along a drift is invalid.
    #[error("along the drift: {0}")]
    Between(#[source] SpecError),
    /// A search for a distance has no parameter to change.
    #[error(
        "{variant}: found no {asked}, expected at least one variant parameter to change; name parameters, or another \
         element"
    )]
    NothingToVary {
        /// The variant.
        variant: String,
        /// What was requested.
        asked: String,
    },
    /// No variant is as far away as requested.
    #[error(
        "{variant}: found at most {farthest:.6} ({values}), expected a distance of {target}; ask for a smaller distance, or vary \
         more parameters"
    )]
    TooFar {
        /// The variant from which the distance is measured.
        variant: String,
        /// The requested distance.
        target: f64,
        /// The largest distance reached.
        farthest: f64,
        /// The values that reached it.
        values: String,
    },
    /// The choices leave a gap around the requested distance.
    #[error(
        "{variant}: found a nearest distance of {nearest:.6} ({values}), expected {target} within {tolerance}; \
         widen the tolerance, or vary a parameter with a range"
    )]
    NoneBetween {
        /// The variant from which the distance is measured.
        variant: String,
        /// The requested distance.
        target: f64,
        /// The tolerance.
        tolerance: f64,
        /// The nearest distance reached.
        nearest: f64,
        /// The values that reached it.
        values: String,
    },
}

fn tried(tries: u32) -> String {
    if tries == 1 {
        "1 try".to_owned()
    } else {
        format!("{tries} tries")
    }
}

/// Identifies a world: variant, seed and index.
#[derive(Debug, Clone, PartialEq)]
pub struct WorldId {
    /// The variant, as `task#variant`.
    pub variant: String,
    /// The seed.
    pub seed: u64,
    /// Index of the world under the seed.
    pub index: u64,
}

impl Display for WorldId {
    fn fmt(&self, f: &mut Formatter) -> Result {
        let Self { variant, seed, index } = self;
        write!(f, "{variant}, seed {seed}, index {index}")
    }
}

impl GeneratorError {
    /// Stable code of this kind of error.
    pub fn code(&self) -> &'static str {
        self.into()
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use std::collections::BTreeSet;
    use strum::VariantNames;

    #[test]
    fn every_error_has_its_message() {
        let world = || WorldId {
            variant: "t#v".into(),
            seed: 1,
            index: 2,
        };
        let errors = [
            GeneratorError::OutOfRange {
                world: world(),
                place: "world/rules/step_reward".into(),
                found: 7.5,
                low: 0.0,
                high: 1.0,
            },
            GeneratorError::NoPlace {
                world: world(),
                group: "trees".into(),
                object: 3,
                count: 4,
                tries: 1000,
                reason: "lower the count".into(),
            },
            GeneratorError::NoStart {
                world: world(),
                start: [0.0, 0.5],
                tries: 1,
            },
            GeneratorError::NoStartCell {
                world: world(),
                reason: "of 16 cells, 0 are dead ends".into(),
            },
            GeneratorError::Requirement {
                world: world(),
                requirement: "low < high".into(),
                values: "low = 3, high = 2".into(),
                tries: 1000,
            },
            GeneratorError::TooMany {
                world: world(),
                found: 100_001,
                limit: 100_000,
            },
            GeneratorError::Clash {
                world: world(),
                source: SpecError::Values {
                    variant: "t#v".into(),
                    problems: Vec::new(),
                },
            },
            GeneratorError::DifferentTasks {
                from: "t#v".into(),
                to: "u#w".into(),
            },
            GeneratorError::Between(SpecError::Values {
                variant: "t#v..w@0.5".into(),
                problems: Vec::new(),
            }),
            GeneratorError::NothingToVary {
                variant: "t#v".into(),
                asked: "parameters that affect A alone".into(),
            },
            GeneratorError::TooFar {
                variant: "t#v".into(),
                target: 0.9,
                farthest: 0.5,
                values: "pay = -100".into(),
            },
            GeneratorError::NoneBetween {
                variant: "t#v".into(),
                target: 0.3,
                tolerance: 0.01,
                nearest: 0.4,
                values: "color = red".into(),
            },
        ];
        let messages: Vec<String> = errors
            .iter()
            .map(|error| format!("{}: {error}", error.code()))
            .collect();
        insta::assert_snapshot!(messages.join("\n"));
        let covered: BTreeSet<&str> = errors.iter().map(GeneratorError::code).collect();
        let all: BTreeSet<&str> = GeneratorError::VARIANTS.iter().copied().collect();
        assert_eq!(covered, all, "every code has a case here");
    }
}
