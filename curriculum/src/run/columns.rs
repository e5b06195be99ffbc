//! The numbers that every experience is logged with. What the file looks like is `metrics`'.

use driftworld_metrics::{BlockType, Record, TaskParams, Timestamp};
use driftworld_spec::BlockKind;
use serde_json::{Map, Value};

use super::episode::Experience;
use super::gap::Gap;
use super::planned::Planned;

/// The columns that every experience is logged with, beside those that the format asks for.
///
/// - `reward`: what all its steps paid.
/// - `success`: 1 if the world's success condition ended it, else 0.
/// - `episode_step_count`: its steps.
/// - `time_to_completion`: the seconds of the world's time that it took, which is steps times time step times
///   `frame_skip`.
/// - `truncated`: 1 if a limit of steps cut it off, 0 if what happened in it ended it.
/// - `world_index`: the number of its world among those of its variant and seed; `nan` for a world from a file.
/// - `progress`: how far on its way a drift is, 0..=1; 0 where nothing drifts.
/// - `distance`: how far its variant is from the variant that the agent learned last before this regime began, 0..=1: for an
///   experience of a learning block the step that the curriculum takes, for one of an evaluation block the way that what was
///   learned has to carry. 0 if both are the same; `nan`, the format's word for no value, before anything was learned.
/// - `distance_state`, `distance_action`, `distance_transition`, `distance_reward`, `distance_observation`: the same in each
///   element of the decision process; 0 where nothing can differ in it.
///
/// Variants of one task are compared by what they declare, others by their first 16 worlds under seed 0.
///
/// An experience that was left out because its world cannot be drawn has a row, too, so that numbers go on without a gap: all its columns
/// are `nan` but for `world_index` and `progress`, and its parameters say under `"skipped"` why. Programs that score a log leave rows
/// without a value out.
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

/// The column of words that says how an experience ended: `success`, `failure` or `step_limit`, as [`Experience::ending`] does, and
/// `skipped` where it was left out. It is not among the metrics columns that the log declares, so that l2metrics passes it over. Logs from before it go on without it.
pub const ENDING: &str = "ending";

/// The column of words that says what ended an experience, as [`EndedBy::word`](driftworld_env::EndedBy::word) does: `all_collected`,
/// `touch`, `return`, `energy`, `zone`, `steps` or `time`; `unknown` where nobody said, and `skipped` where it was left out. As with
/// [`ENDING`], l2metrics passes it over, and logs from before it go on without it.
pub const ENDED_BY: &str = "ended_by";

/// The row of experience `number`.
pub(super) fn record(planned: &Planned, number: u64, experience: &Experience, gap: &Gap, now: Timestamp) -> Record {
    let lived = [
        experience.reward,
        f64::from(u8::from(experience.success)),
        f64::from(experience.steps),
        experience.seconds,
        f64::from(u8::from(experience.truncated)),
        planned.world_index(number),
        planned.progress(number),
    ];
    row(planned, number, lived.iter().chain(gap), planned.params(), now)
}

/// The key of a row's parameters that says why its experience was left out.
pub(super) const SKIPPED: &str = "skipped";

/// The row of experience `number`, which was left out.
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

/// What a log says of an experience that was left out.
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
