//! What can go wrong while a curriculum is designed or lived.

use driftworld_env::EnvError;
use driftworld_generator::GeneratorError;
use driftworld_metrics::MetricsError;
use driftworld_similarity::SimilarityError;

/// Everything that can go wrong in this crate.
#[derive(Debug, thiserror::Error)]
#[non_exhaustive]
pub enum CurriculumError {
    /// There is nothing to make blocks of.
    #[error("design: found no variants, expected at least 1")]
    NoVariants,
    /// A number of experiences that a regime cannot have.
    #[error("design: found {found} {kind} experiences a regime, expected 1 to {limit}")]
    BadCount {
        /// Learning or evaluation.
        kind: &'static str,
        /// The number.
        found: u32,
        /// The most there can be.
        limit: u32,
    },
    /// A seed too large to derive others from.
    #[error("design: found seed {found}, expected at most {limit}")]
    BadSeed {
        /// The seed.
        found: u64,
        /// The largest there can be.
        limit: u64,
    },
    /// Two variants would have the same name in the log.
    #[error(
        "found {a} and {b}, which are both {name:?} in a log, expected names that differ in letters and digits; rename one"
    )]
    SameLogName {
        /// The first variant.
        a: String,
        /// The second variant.
        b: String,
        /// Their name in the log.
        name: String,
    },
    /// A task or variant of the scenario is not to be had.
    #[error("block {block}, regime {regime}: {task}#{variant}: {reason}")]
    Unknown {
        /// The block, from 0.
        block: usize,
        /// The regime in it, from 0.
        regime: usize,
        /// The task.
        task: String,
        /// The variant.
        variant: String,
        /// What whoever was asked for it says.
        reason: String,
    },
    /// A world of the scenario cannot be drawn.
    #[error("block {block}, regime {regime}: {source}")]
    World {
        /// The block, from 0.
        block: usize,
        /// The regime in it, from 0.
        regime: usize,
        /// Why.
        source: GeneratorError,
    },
    /// The agent did what cannot be done.
    #[error("block {block}, regime {regime}, experience {experience}: {source}")]
    Episode {
        /// The block, from 0.
        block: usize,
        /// The regime in it, from 0.
        regime: usize,
        /// The experience, from 0 over the whole lifetime.
        experience: u64,
        /// What the environment says.
        source: EnvError,
    },
    /// Transfer is measured by evaluations, and there are none.
    #[error(
        "transfer: found no evaluation in {logs} logs, expected every variant evaluated before and after another is \
         learned; design the curriculum with --evaluate every"
    )]
    NoEvaluations {
        /// How many logs there are.
        logs: usize,
    },
    /// Logs and distances speak of different variants.
    #[error(
        "transfer: found {found} variants that are both in the logs ({logs}) and in the distance matrix ({matrix}), \
         expected at least 2; measure the distances of the variants that were lived: task#variant there is task_variant \
         in a log, letters and digits alone"
    )]
    NoCommonNames {
        /// How many are in both.
        found: usize,
        /// Names in the logs.
        logs: String,
        /// Names in the matrix.
        matrix: String,
    },
    /// Too few pairs of variants with a transfer.
    #[error(
        "transfer: found {forward} forward and {backward} backward pairs of variants with a transfer, expected at least \
         {needed} in one direction; log a lifetime of 3 or more variants of the matrix, all evaluated before and after \
         each is learned, or add lifetimes in other orders"
    )]
    TooFewTransfers {
        /// Pairs whose second variant was not yet learned.
        forward: usize,
        /// Pairs whose second variant had been learned.
        backward: usize,
        /// How many are needed.
        needed: usize,
    },
    /// The test cannot be run as asked.
    #[error("transfer: {source}")]
    Relabelling {
        /// What the test says.
        source: SimilarityError,
    },
    /// The log cannot be written.
    #[error(transparent)]
    Log(#[from] MetricsError),
}

impl CurriculumError {
    /// The stable name of this kind of error.
    pub fn code(&self) -> &'static str {
        match self {
            Self::NoVariants => "curriculum/no-variants",
            Self::BadCount { .. } => "curriculum/bad-count",
            Self::BadSeed { .. } => "curriculum/bad-seed",
            Self::SameLogName { .. } => "curriculum/same-log-name",
            Self::Unknown { .. } => "curriculum/unknown",
            Self::World { .. } => "curriculum/world",
            Self::Episode { .. } => "curriculum/episode",
            Self::NoEvaluations { .. } => "curriculum/no-evaluations",
            Self::NoCommonNames { .. } => "curriculum/no-common-names",
            Self::TooFewTransfers { .. } => "curriculum/too-few-transfers",
            Self::Relabelling { .. } => "curriculum/relabelling",
            Self::Log(_) => "curriculum/log",
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
            CurriculumError::NoVariants,
            CurriculumError::BadCount {
                kind: "learning",
                found: 0,
                limit: 10,
            },
            CurriculumError::BadSeed { found: 9, limit: 8 },
            CurriculumError::SameLogName {
                a: "a#b_c".into(),
                b: "a#bc".into(),
                name: "a_bc".into(),
            },
            CurriculumError::Unknown {
                block: 1,
                regime: 0,
                task: "t".into(),
                variant: "v".into(),
                reason: "no such task".into(),
            },
            CurriculumError::World {
                block: 1,
                regime: 0,
                source: GeneratorError::TooMany {
                    variant: "t#v".into(),
                    seed: 1,
                    index: 2,
                    found: 9,
                    limit: 8,
                },
            },
            CurriculumError::Episode {
                block: 1,
                regime: 0,
                experience: 5,
                source: EnvError::Ended,
            },
            CurriculumError::NoEvaluations { logs: 2 },
            CurriculumError::NoCommonNames {
                found: 0,
                logs: "t_x, t_y".into(),
                matrix: "t#a, t#b".into(),
            },
            CurriculumError::TooFewTransfers {
                forward: 1,
                backward: 0,
                needed: 3,
            },
            CurriculumError::Relabelling {
                source: SimilarityError::MantelCount {
                    what: "relabellings",
                    found: 0,
                    limit: 9,
                },
            },
            CurriculumError::Log(MetricsError::LogExists {
                path: "logs/run".into(),
            }),
        ];
        let said: Vec<String> = errors
            .iter()
            .map(|error| format!("{}: {error}", error.code()))
            .collect();
        insta::assert_snapshot!(said.join("\n"));
        let covered: BTreeSet<&str> = errors.iter().map(CurriculumError::code).collect();
        let all: BTreeSet<&str> = include_str!("error.rs")
            .split('"')
            .filter(|word| word.starts_with("curriculum/") && word.len() > 11)
            .collect();
        assert_eq!(covered, all, "every code has a case here");
    }
}
