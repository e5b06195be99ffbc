//! What can go wrong while a curriculum is designed or lived.

use std::path::PathBuf;

use driftworld_env::EnvError;
use driftworld_generator::GeneratorError;
use driftworld_metrics::MetricsError;

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
    /// A world file of the scenario is not to be had.
    #[error("block {block}, regime {regime}: {reason}")]
    WorldFile {
        /// The block, from 0.
        block: usize,
        /// The regime in it, from 0.
        regime: usize,
        /// What whoever was asked for it says.
        reason: String,
    },
    /// A number of an experience that the scenario does not have.
    #[error("found experience {found}, expected less than {total}, the experiences of the scenario")]
    NoSuchExperience {
        /// The number.
        found: u64,
        /// How many there are.
        total: u64,
    },
    /// A log that is to be taken up was written by another run.
    #[error(
        "{}: {place}: found {found}, expected {expected} as in this run; \
         go on with what the log was begun with, or choose another folder", path.display()
    )]
    OtherRun {
        /// The log's folder.
        path: PathBuf,
        /// Where in the log's `scenario_info.json`.
        place: String,
        /// What the log has there.
        found: String,
        /// What this run has.
        expected: String,
    },
    /// A row of a log that is to be taken up is not the one that the scenario has there.
    #[error(
        "{}: row {row}: found {found}, expected {expected}; is a file missing or changed? choose another folder", path.display()
    )]
    OtherRow {
        /// The log's folder.
        path: PathBuf,
        /// The row, from 0 over all files.
        row: u64,
        /// What it says.
        found: String,
        /// What the scenario has there.
        expected: String,
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
            Self::WorldFile { .. } => "curriculum/world-file",
            Self::NoSuchExperience { .. } => "curriculum/no-such-experience",
            Self::OtherRun { .. } => "curriculum/other-run",
            Self::OtherRow { .. } => "curriculum/other-row",
            Self::World { .. } => "curriculum/world",
            Self::Episode { .. } => "curriculum/episode",
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
            CurriculumError::WorldFile {
                block: 1,
                regime: 0,
                reason: "maps/yard.json: not there".into(),
            },
            CurriculumError::NoSuchExperience { found: 9, total: 9 },
            CurriculumError::OtherRun {
                path: "logs/run".into(),
                place: "/agent".into(),
                found: "\"random\"".into(),
                expected: "\"onrails\"".into(),
            },
            CurriculumError::OtherRow {
                path: "logs/run".into(),
                row: 7,
                found: "experience 9 in block 1-test, t_v {}".into(),
                expected: "experience 7 in block 0-train, t_v {}".into(),
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
