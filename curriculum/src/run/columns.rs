//! The columns that are logged for every experience.

use driftworld_metrics::{BlockType, Record, TaskParams, Timestamp};
use driftworld_spec::BlockKind;
use serde_json::{Map, Value};

use super::episode::Experience;
use super::gap::Gap;
use super::planned::Planned;

/// The metrics columns that are logged for every experience, in addition to those that the format requires.
///
/// - `reward`: the sum of its rewards.
/// - `success`: 1 if the world's success condition ended it, else 0.
/// - `episode_step_count`: its steps.
/// - `time_to_completion`: its simulated seconds: steps times time step times `frame_skip`, at most the world's time limit.
/// - `truncated`: 1 if a step or time limit cut it off, 0 if an event in the world ended it.
/// - `world_index`: the index of its world for its variant and seed; `nan` for a world from a file.
/// - `progress`: the progress of a drift, 0..=1; 0 without a drift.
/// - `distance`: the distance of its variant from the variant that the agent learned last before this regime began, 0..=1: in a
///   learning block the step that the curriculum takes, in an evaluation block the distance over which learning has to
///   generalise. 0 if both are the same; `nan`, the format's missing value, before anything was learned.
/// - `distance_state`, `distance_action`, `distance_transition`, `distance_reward`, `distance_observation`: the same in each
///   element of the decision process; 0 if nothing can differ in it.
///
/// Variants of one task are compared by what they declare, others by their first 16 worlds under seed 0.
///
/// An experience that was skipped because its world cannot be drawn also has a row, so that the numbers have no gap: all its
/// columns except `world_index` and `progress` are `nan`, and its parameters give the reason under `"skipped"`. Programs that
/// score a log ignore rows without a value.
pub const COLUMNS: [&str; 13] = [
    "reward",
    "success",
    "episode_step_count",
    "time_to_completion",
    "truncated",
    "world_index",
    "progress",
    "distance",
    "distance_state",
    "distance_action",
    "distance_transition",
    "distance_reward",
    "distance_observation",
];

/// The text column for how an experience ended: `success`, `failure` or `step_limit`, as in [`Experience::ending`], and
/// `skipped` if it was left out. The log does not declare it as a metrics column, so l2metrics ignores it. Logs started before
/// it existed continue without it.
pub const ENDING: &str = "ending";

/// The text column for what ended an experience, as in [`EndedBy::word`](driftworld_env::EndedBy::word): `all_collected`,
/// `touch`, `return`, `energy`, `zone`, `steps` or `time`; `unknown` if not reported, and `skipped` if it was left out. As with
/// [`ENDING`], l2metrics ignores it, and logs started before it existed continue without it.
pub const ENDED_BY: &str = "ended_by";

/// The row of experience `number`.
pub(super) fn record(planned: &Planned, number: u64, experience: &Experience, gap: &Gap, now: Timestamp) -> Record {
    let values = [
        experience.reward,
        f64::from(u8::from(experience.success)),
        f64::from(experience.steps),
        experience.seconds,
        f64::from(u8::from(experience.truncated)),
        planned.world_index(number),
        planned.progress(number),
    ];
    row(planned, number, values.iter().chain(gap), planned.params(), now)
}

/// The parameter of a row with the reason why its experience was skipped.
pub(super) const SKIPPED: &str = "skipped";

/// The row of experience `number`, which was skipped.
pub(super) fn skipped(planned: &Planned, number: u64, reason: &str, now: Timestamp) -> Record {
    let values = COLUMNS.map(|name| match name {
        "world_index" => planned.world_index(number),
        "progress" => planned.progress(number),
        _ => f64::NAN,
    });
    row(planned, number, values.iter(), skipped_params(planned, reason), now)
}

/// A row with a number for each of [`COLUMNS`].
fn row<'a>(
    planned: &Planned,
    number: u64,
    values: impl Iterator<Item = &'a f64>,
    params: TaskParams,
    now: Timestamp,
) -> Record {
    let kind = block_type(planned.kind);
    let record = Record::new(planned.block as u64, number, kind, &planned.log_name, now);
    let named = COLUMNS.into_iter().zip(values);
    let record = named.fold(record, |record, (name, value)| record.with_metric(name, *value));
    record.with_task_params(params)
}

/// The task parameters of an experience that was skipped.
pub(super) fn skipped_params(planned: &Planned, reason: &str) -> TaskParams {
    let mut params = Map::clone(&planned.params());
    params.insert(SKIPPED.to_owned(), Value::from(reason));
    TaskParams::from(params)
}

pub(super) fn block_type(kind: BlockKind) -> BlockType {
    match kind {
        BlockKind::Learning => BlockType::Train,
        BlockKind::Evaluation => BlockType::Test,
    }
}
