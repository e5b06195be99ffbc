//! Errors raised while designing or running a curriculum.

use std::path::PathBuf;

use driftworld_env::EnvError;
use driftworld_files::FileError;
use driftworld_generator::GeneratorError;
use driftworld_metrics::MetricsError;
use driftworld_similarity::{MIN_CORRELATED, SimilarityError};
use driftworld_spec::MAX_EXPERIENCES;
use driftworld_text::{ShownPath, one_line, when};

use crate::design::wanted::{MAX_BLOCKS, MAX_PROBED, MAX_SEED, MAX_STEPS, Steps};

/// An error of this crate.
#[derive(Debug, thiserror::Error, strum::IntoStaticStr, strum::VariantNames)]
#[strum(prefix = "curriculum/", serialize_all = "kebab-case")]
#[non_exhaustive]
pub enum CurriculumError {
    /// A frozen agent behaved differently when an evaluation was repeated.
    #[error(
        "block {block}: found {found} of experience {experience} ({variant}) when this evaluation was run once more, \
         expected the same: evaluations change the agent, or its random numbers are not drawn from the seed that each \
         experience begins with; keep statistics, memories and counters of evaluations apart from the agent's own, or \
         switch the check off"
    )]
    NotFrozen {
        /// The block.
        block: usize,
        /// The variant, as `task#variant`.
        variant: String,
        /// The number of the experience over the whole lifetime.
        experience: u64,
        /// The difference: an action in a step, or the reward.
        found: String,
    },
    /// There are no variants.
    #[error("design: found no variants, expected at least 1")]
    NoVariants,
    /// A number of experiences out of range.
    #[error("design: found {found} {kind} experiences per regime, expected 1 to {MAX_EXPERIENCES}")]
    BadCount {
        /// Learning, evaluation or pre-deployment.
        kind: &'static str,
        /// The number.
        found: u32,
    },
    /// A seed too large to derive others from.
    #[error("design: found seed {0}, expected at most {MAX_SEED}")]
    BadSeed(u64),
    /// A number of learning blocks out of range.
    #[error("design: found {0} learning blocks, expected 1 to {MAX_BLOCKS}")]
    BadBlocks(u32),
    /// Variants or blocks that do not fit a form.
    #[error("the form {form}: found {variants} variants{}, expected {expected}", and_blocks(*blocks))]
    BadForm {
        /// The form.
        form: &'static str,
        /// Number of variants.
        variants: usize,
        /// Number of learning blocks, if given.
        blocks: Option<u32>,
        /// What the form requires.
        expected: String,
    },
    /// An evaluation after a learning block that does not exist.
    #[error("design: found an evaluation after learning block {found}, expected 0 to {last}; 0 is before the first")]
    NoSuchPlace {
        /// The number of the learning block.
        found: u32,
        /// Number of learning blocks.
        last: u32,
    },
    /// A held-out variant is among those to learn.
    #[error("design: found {0} among the variants to learn and among those held out, expected one of the two")]
    HeldOut(String),
    /// A drift without a second variant.
    #[error("design: found one variant to drift through, expected at least 2")]
    NoWay,
    /// A drift from one task to another.
    #[error(
        "design: found a drift from {from} to {to}, expected two variants of one task; remove the drift, or one \
         of the two variants"
    )]
    DriftBetweenTasks {
        /// Its first variant.
        from: String,
        /// Its second variant.
        to: String,
    },
    /// Variants of several tasks, which cannot be compared element by element.
    #[error("design: found {a} and {b}, expected variants of one task; probe and step within a task")]
    SeveralTasks {
        /// The first variant.
        a: String,
        /// The second variant.
        b: String,
    },
    /// Two experts would have the same name.
    #[error(
        "experts: found {a} and {b}, which would both be named {name}, expected different names; leave one out, or \
         rename it"
    )]
    SameName {
        /// The first variant.
        a: String,
        /// The second variant.
        b: String,
        /// The name.
        name: String,
    },
    /// A number of variants out of range for a probe.
    #[error("probing: found {0} variants wanted, expected 2 to {MAX_PROBED}")]
    BadProbe(usize),
    /// A search for a sequence of steps reached its limit.
    #[error(
        "steps from {anchor}: found at most {found} steps of {} ± {} in {limit} comparisons, \
         expected {}; ask for fewer or larger steps, or a larger tolerance",
        wanted.distance,
        wanted.tolerance,
        wanted.count
    )]
    StepsGivenUp {
        /// The first variant of the sequence.
        anchor: String,
        /// The steps of the longest sequence found before the limit.
        found: usize,
        /// The requested steps.
        wanted: Steps,
        /// The limit of comparisons.
        limit: u64,
    },
    /// Too few variants differ in only one element.
    #[error(
        "probing the {element}: found {found} variants that differ from {anchor} in it alone, expected {wanted}; ask \
         for fewer, or give the task parameters that affect it alone"
    )]
    TooFew {
        /// The variant that the others are compared with.
        anchor: String,
        /// The element.
        element: &'static str,
        /// Variants found, including the anchor.
        found: usize,
        /// Variants requested.
        wanted: usize,
    },
    /// Invalid numbers for a sequence of steps.
    #[error(
        "steps: found {} steps of {} ± {}, expected 1 to {MAX_STEPS} steps, a distance above 0 and at most 1, and a \
         tolerance below it",
        .0.count,
        .0.distance,
        .0.tolerance
    )]
    BadSteps(Steps),
    /// A sequence of steps ends too soon.
    #[error(
        "steps from {anchor}: found at most {found} steps of {} ± {}, expected {}; the farthest \
         variant is {farthest:.4} away: ask for fewer or smaller steps, a larger tolerance, or another start",
        wanted.distance,
        wanted.tolerance,
        wanted.count
    )]
    TooFewSteps {
        /// The first variant of the sequence.
        anchor: String,
        /// The steps of the longest sequence found.
        found: usize,
        /// The requested steps.
        wanted: Steps,
        /// The largest distance of any variant from the first, as far as known.
        farthest: f64,
    },
    /// A distance or an order cannot be computed.
    #[error(transparent)]
    Similarity(#[from] SimilarityError),
    /// A variant cannot be generated.
    #[error(transparent)]
    Generator(#[from] GeneratorError),
    /// Two variants would have the same name in the log.
    #[error(
        "found {a} and {b}, which are both {name:?} in a log, expected names that differ in the letters a to z and \
         digits, since logs keep nothing else; rename one",
        a = one_line(a),
        b = one_line(b)
    )]
    SameLogName {
        /// The first variant.
        a: String,
        /// The second variant.
        b: String,
        /// Their name in the log.
        name: String,
    },
    /// A task or variant of the scenario cannot be found.
    #[error("block {block}, regime {regime}: {task}#{variant}: \
         {reason}", task = one_line(task), variant = one_line(variant))]
    Unknown {
        /// The block, from 0.
        block: usize,
        /// The regime in it, from 0.
        regime: usize,
        /// The task.
        task: String,
        /// The variant.
        variant: String,
        /// The source's error message.
        reason: String,
    },
    /// A world file of the scenario cannot be found.
    #[error("block {block}, regime {regime}: {reason}")]
    WorldFile {
        /// The block, from 0.
        block: usize,
        /// The regime in it, from 0.
        regime: usize,
        /// The source's error message.
        reason: String,
    },
    /// An experience number beyond the scenario's end.
    #[error("found experience {found}, expected less than {total}, the number of experiences in the scenario")]
    NoSuchExperience {
        /// The number.
        found: u64,
        /// Number of experiences.
        total: u64,
    },
    /// A log to be resumed was written by a different run.
    #[error(
        "{}: {place}: found {found}, expected {expected} as in this run; continue with what the log was started with, \
         or choose another folder",
        path.shown(),
        place = one_line(place),
        found = one_line(found),
        expected = one_line(expected)
    )]
    OtherRun {
        /// The log's folder.
        path: PathBuf,
        /// The place in the log's `scenario_info.json`.
        place: String,
        /// The log's value.
        found: String,
        /// This run's value.
        expected: String,
    },
    /// A row of a log to be resumed does not match the scenario.
    #[error(
        "{}: row {row}: found {found}, expected {expected}; is a file missing or changed? choose another folder",
        path.shown(),
        found = one_line(found),
        expected = one_line(expected)
    )]
    OtherRow {
        /// The log's folder.
        path: PathBuf,
        /// The row, from 0 over all files.
        row: u64,
        /// The row's value.
        found: String,
        /// The scenario's value.
        expected: String,
    },
    /// A variant named for a probe also differs in other elements.
    #[error(
        "probing the {element}: found {a} and {b}, which differ in {differs}, expected variants that differ in the \
         {element} alone; name other variants, or the task alone to have them chosen"
    )]
    NotAlone {
        /// The first variant.
        a: String,
        /// The second variant.
        b: String,
        /// The element.
        element: &'static str,
        /// The elements in which they differ.
        differs: String,
    },
    /// A world of the scenario cannot be drawn.
    #[error("block {block}, regime {regime}, experience {experience}, {variant}{}: \
         {source}", at_progress(*progress), variant = one_line(variant))]
    World {
        /// The block, from 0.
        block: usize,
        /// The regime in it, from 0.
        regime: usize,
        /// The experience, from 0 over the whole lifetime.
        experience: u64,
        /// Its name: `task#variant`; for a drift, with both ends.
        variant: String,
        /// Progress of a drift, 0..=1; 0 without a drift.
        progress: f64,
        /// The generator's error.
        source: GeneratorError,
    },
    /// The agent took an invalid action.
    #[error("block {block}, regime {regime}, experience {experience}: {source}")]
    Episode {
        /// The block, from 0.
        block: usize,
        /// The regime in it, from 0.
        regime: usize,
        /// The experience, from 0 over the whole lifetime.
        experience: u64,
        /// The environment's error.
        source: EnvError,
    },
    /// Transfer is measured from evaluations, and there are none.
    #[error(
        "transfer: found no evaluation in {0} logs, expected every variant evaluated before and after another is \
         learned; design the curriculum with --evaluate every"
    )]
    NoEvaluations(usize),
    /// Logs and distances have too few variants in common.
    #[error(
        "transfer: found {found} variants that are both in the logs ({logs}) and in the distance matrix ({matrix}), \
         expected at least 2; measure the distances of the variants that were run: task#variant in a matrix is \
         task_variant in a log, letters and digits only",
        logs = one_line(logs),
        matrix = one_line(matrix)
    )]
    NoCommonNames {
        /// Variants in both.
        found: usize,
        /// Names in the logs.
        logs: String,
        /// Names in the matrix.
        matrix: String,
    },
    /// Too few pairs of variants with a transfer.
    #[error(
        "transfer: found {forward} forward and {backward} backward pairs of variants with a transfer, expected at \
         least {MIN_CORRELATED} in one direction; log a lifetime of 3 or more variants of the matrix, all evaluated before and \
         after each is learned, or add lifetimes in other orders"
    )]
    TooFewTransfers {
        /// Pairs whose second variant was not yet learned.
        forward: usize,
        /// Pairs whose second variant was learned before.
        backward: usize,
    },
    /// The requested test is not possible.
    #[error("transfer: {0}")]
    Relabelling(#[source] SimilarityError),
    /// A file of recordings is damaged, or is not a file of recordings.
    #[error("{}: {source}", path.shown())]
    Recording {
        /// The file.
        path: PathBuf,
        /// The position, and the fault.
        source: EnvError,
    },
    /// A file of recordings cannot be opened.
    #[error(transparent)]
    UnreadableRecordings(FileError),
    /// A file of recordings cannot be read or written.
    #[error("{}: cannot {doing}: {source}", path.shown())]
    Recordings {
        /// The file or folder.
        path: PathBuf,
        /// The operation.
        doing: &'static str,
        /// The operating system's error.
        source: std::io::Error,
    },
    /// Recordings were lost.
    #[error(
        "{}: found {found}, expected the {expected} bytes that were recorded: the file was removed, replaced or truncated \
         during the run; put it back, or continue without recordings",
        path.shown()
    )]
    RecordingsLost {
        /// The file.
        path: PathBuf,
        /// The current state.
        found: String,
        /// Bytes that were written.
        expected: u64,
    },
    /// The log cannot be written.
    #[error(transparent)]
    Log(#[from] MetricsError),
}

fn and_blocks(blocks: Option<u32>) -> String {
    blocks.map_or_else(String::new, |blocks| format!(" and {blocks} learning blocks"))
}

fn at_progress(progress: f64) -> String {
    when(progress != 0.0, || format!(" at progress {progress}"))
}

impl CurriculumError {
    pub(crate) fn bad_form(
        form: &'static str,
        variants: usize,
        blocks: Option<u32>,
        expected: impl Into<String>,
    ) -> Self {
        let expected = expected.into();
        Self::BadForm {
            form,
            variants,
            blocks,
            expected,
        }
    }

    pub(crate) fn several_tasks(a: String, b: String) -> Self {
        Self::SeveralTasks { a, b }
    }

    /// The stable name of this kind of error.
    pub fn code(&self) -> &'static str {
        self.into()
    }
}

#[cfg(test)]
mod tests;
