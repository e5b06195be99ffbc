//! [`EnvError`]: all errors of this crate.

use driftworld_spec::SpecError;
use driftworld_text::one_line;

use crate::sim::Obstacle;

/// Bytes of a gibibyte.
const GIB: f64 = (1_u64 << 30) as f64;

/// All errors of this crate.
#[derive(Debug, Clone, PartialEq, thiserror::Error, strum::IntoStaticStr, strum::VariantNames)]
#[strum(prefix = "env/", serialize_all = "kebab-case")]
#[non_exhaustive]
pub enum EnvError {
    /// An action contains NaN or infinity.
    #[error("action: found {found:?}, expected three finite numbers; nothing was changed")]
    NotFinite {
        /// The action.
        found: [f64; 3],
    },
    /// An action is a row number beyond the world's action table.
    #[error("action: found row {found}, expected 0 to {last} of the world's action table; nothing was changed")]
    NoSuchAction {
        /// The requested row.
        found: usize,
        /// The last row of the table.
        last: usize,
    },
    /// A discrete action in a world whose actions are continuous.
    #[error("action: found row {found}, expected three numbers; this world has no action table (agent_params.actions)")]
    NotDiscrete {
        /// The requested row.
        found: usize,
    },
    /// A step after the episode has ended.
    #[error("step: the episode has ended, expected a reset first")]
    Ended,
    /// The buffer for the state vector has the wrong length.
    #[error("state vector: found room for {found} numbers, expected {expected} (agent_params.state_features)")]
    StateLength {
        /// Length of the buffer.
        found: usize,
        /// Length of the state vector.
        expected: usize,
    },
    /// A batch with no environments, or with too many.
    #[error("batch: found {found} environments, expected 1 to {most}")]
    BatchSize {
        /// Requested environments.
        found: usize,
        /// Maximum number of environments.
        most: usize,
    },
    /// Outputs need more memory than a batch may use, or than is available.
    #[error(
        "batch: found outputs of {:.1} GiB, expected at most {} GiB, and no more than the available memory; use fewer \
         environments (num_envs), smaller pictures or fewer modalities",
        *found as f64 / GIB,
        *most as f64 / GIB
    )]
    BatchMemory {
        /// Requested bytes.
        found: u64,
        /// Maximum number of bytes.
        most: u64,
    },
    /// A reset was stopped before every environment had begun its episode.
    #[error(
        "batch: stopped before every environment had begun its episode, expected a reset of all of them before the next step"
    )]
    Stopped,
    /// The system cannot start the requested threads.
    #[error("batch: {wanted} threads could not be started: {reason}; use fewer (num_threads)")]
    BatchThreads {
        /// Requested threads.
        wanted: usize,
        /// The system's message.
        reason: String,
    },
    /// A list does not have one entry per environment.
    #[error("batch: found {found} entries, expected {num_envs}, one for each environment; nothing was changed")]
    BatchLength {
        /// Entries in the list.
        found: usize,
        /// Number of environments.
        num_envs: usize,
    },
    /// The batch has no environment with this index.
    #[error("batch: found environment {found}, expected 0 to {}", num_envs - 1)]
    NoSuchEnv {
        /// The requested index.
        found: usize,
        /// Number of environments.
        num_envs: usize,
    },
    /// An environment of a batch cannot carry out its action.
    #[error("environment {env} of the batch: {error}")]
    BatchAction {
        /// Index of the environment.
        env: usize,
        /// The underlying error.
        error: Box<Self>,
    },
    /// A world source has no world.
    #[error("environment {env} of the batch: no world for episode {episode}: {reason}")]
    BatchWorld {
        /// Index of the environment.
        env: usize,
        /// Index of its episode.
        episode: u64,
        /// The source's reason.
        reason: String,
    },
    /// A world requests different images from the first world of its batch.
    #[error(
        "environment {env} of the batch: its world requests {found}, expected {expected} as in environment 0; give all worlds \
         of a batch the same agent_params.observation_size and modalities"
    )]
    BatchImages {
        /// Index of the environment.
        env: usize,
        /// Images that its world requests.
        found: String,
        /// Images of the batch.
        expected: String,
    },
    /// A recordings file is damaged or truncated, or the file is not a recordings file.
    #[error("line {line}: found {found}, expected {expected}", found = one_line(found), expected = one_line(expected))]
    Recording {
        /// The line, from 1.
        line: u64,
        /// What was found there.
        found: String,
        /// What was expected.
        expected: String,
    },
    /// The replay of a recorded episode differs from the recording.
    #[error(
        "experience {experience}, {what}: found {found}, expected {expected} as recorded by driftworld {recorded_by:.40}; this is \
         driftworld {now}: replay it with the version and the asset libraries that it was recorded with"
    )]
    Replay {
        /// Index of the experience.
        experience: u64,
        /// What differs: the reward, the cause of the end, or a step that the replay cannot take.
        what: &'static str,
        /// The value in the replay.
        found: String,
        /// The recorded value.
        expected: String,
        /// The version of Driftworld that recorded it.
        recorded_by: String,
        /// This version.
        now: &'static str,
    },
    /// A new object is invalid.
    #[error("spawn: {problem}; nothing was changed")]
    BadObject {
        /// The problem.
        problem: SpecError,
    },
    /// A new object has the same name as another.
    #[error(
        "spawn: found unique_name {name:?}, which object {object} has too, expected a name of its own; nothing was changed"
    )]
    NameTaken {
        /// The name.
        name: String,
        /// The object that has it.
        object: usize,
    },
    /// The world has the maximum number of objects.
    #[error("spawn: found a world of {limit} objects, expected fewer; destroyed objects count, so start another world")]
    TooManyObjects {
        /// Maximum number of objects in a world.
        limit: usize,
    },
    /// The world has no object with this index.
    #[error("object: found number {found}, expected less than {count}, the number of objects in this world")]
    NoSuchObject {
        /// The requested index.
        found: usize,
        /// Number of objects.
        count: usize,
    },
    /// The object is already destroyed and does not respawn.
    #[error("destroy: found object {object}, which is already gone, expected one that is present or will respawn")]
    AlreadyGone {
        /// The object.
        object: usize,
    },
    /// The agent does not fit at the requested position.
    #[error(
        "teleport: found {found} at {position:?}, expected free ground inside the arena for an agent {width} m wide; it stays where it is"
    )]
    NoRoom {
        /// The requested position in metres.
        position: [f64; 2],
        /// The obstacle.
        found: Obstacle,
        /// The agent's width in metres.
        width: f64,
    },
    /// A heading is not a finite number.
    #[error("teleport: found a heading of {found}, expected a finite number of degrees; it stays where it is")]
    NoHeading {
        /// The requested heading, in degrees.
        found: f64,
    },
    /// A world needs more photographs than allowed.
    #[error(
        "photographs: found {objects} objects in {views} views each, expected at most {most} photographs; use fewer objects, or \
         lower image_params.yaw_subdivisions or vertical_subdivisions"
    )]
    TooManyPhotographs {
        /// Objects of the world.
        objects: usize,
        /// Views of each object.
        views: usize,
        /// Maximum number of photographs.
        most: usize,
    },
    /// A setting of an abstraction is out of range.
    #[error("abstraction: found {what} {found}, expected a number above 0, at most {most}")]
    BadAbstraction {
        /// The name of the setting.
        what: &'static str,
        /// Its value.
        found: f64,
        /// Maximum allowed value.
        most: f64,
    },
    /// An abstraction needs more states than allowed.
    #[error("abstraction: found {found} states, expected at most {most}; use larger cells, or a smaller area")]
    TooManyStates {
        /// States needed.
        found: usize,
        /// Maximum number of states.
        most: usize,
    },
    /// A world that was composed from others is invalid.
    #[error("world: {problem}")]
    BadWorld {
        /// The problem.
        problem: SpecError,
    },
    /// An image size is out of range.
    #[error("picture: found {width} × {height} pixels, expected 1 to 4096 each way")]
    PictureSize {
        /// Requested width.
        width: u32,
        /// Requested height.
        height: u32,
    },
    /// A library of assets is invalid or truncated.
    #[error("library, byte {byte}: found {found}, expected {expected}", found = one_line(found), expected = one_line(expected))]
    BadLibrary {
        /// Offset in the file.
        byte: usize,
        /// What was found.
        found: String,
        /// What was expected.
        expected: String,
    },
    /// A model cannot be added to a library.
    #[error("{place}: found {found}, expected {expected}", place = one_line(place), found = one_line(found), expected = one_line(expected))]
    BadModel {
        /// The place in the model's file: a JSON pointer, or a few words.
        place: String,
        /// What was found.
        found: String,
        /// What was expected.
        expected: String,
    },
    /// A line of an agent's script is invalid.
    #[error("{script}:{line}: found {found}, expected {expected}", script = one_line(script), found = one_line(found), expected = one_line(expected))]
    BadScript {
        /// The script's name, usually its path.
        script: String,
        /// The line, counted from 1.
        line: usize,
        /// What was found.
        found: String,
        /// What was expected.
        expected: String,
    },
    /// A network file is invalid.
    #[error("{file}: {place}: found {found}, expected {expected}", file = one_line(file), place = one_line(place), found = one_line(found), expected = one_line(expected))]
    BadNetwork {
        /// The file's name, usually its path.
        file: String,
        /// The place in the file: a tensor, or a key of its metadata.
        place: String,
        /// What was found.
        found: String,
        /// What was expected.
        expected: String,
    },
    /// There is no renderer with this name.
    #[error("renderer: found {found:?}, expected cpu, gpu or auto")]
    NoSuchRenderer {
        /// The requested name.
        found: String,
    },
    /// A GPU is requested, but none is usable.
    #[error(
        "renderer gpu: found no working graphics adapter, expected one ({}); `driftworld doctor` says what is missing, \
         and the renderer cpu works everywhere",
        tried.join("; ")
    )]
    NoGpu {
        /// The adapters that were tried, with the reason why each failed.
        tried: Vec<String>,
    },
    /// An image is too large for the GPU.
    #[error(
        "picture: found {width} × {height} points, expected at most {most} each way on {adapter}; draw it with the renderer cpu, \
         at a smaller size, or with less supersampling",
        adapter = one_line(adapter)
    )]
    GpuPicture {
        /// Width in samples: pixels times supersampling.
        width: u32,
        /// Height in samples.
        height: u32,
        /// Maximum size that the adapter supports.
        most: u32,
        /// The adapter's name.
        adapter: String,
    },
    /// The GPU failed.
    #[error("renderer gpu: {adapter}: {reason}; expected a picture; the renderer cpu works everywhere", adapter = one_line(adapter), reason = one_line(reason))]
    Gpu {
        /// The adapter's name.
        adapter: String,
        /// The adapter's message.
        reason: String,
    },
}

impl EnvError {
    /// The stable name of this kind of error.
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
    #[expect(clippy::too_many_lines, reason = "a list with one of each error")]
    fn every_error_has_its_message() {
        let errors = [
            EnvError::NotFinite {
                found: [1.0, f64::INFINITY, 0.0],
            },
            EnvError::NoSuchAction { found: 7, last: 6 },
            EnvError::NotDiscrete { found: 2 },
            EnvError::Ended,
            EnvError::BadObject {
                problem: driftworld_spec::Object::new("tree", [0.0, 400.0])
                    .check()
                    .expect_err("the position is outside every arena"),
            },
            EnvError::NameTaken {
                name: "gate".to_owned(),
                object: 3,
            },
            EnvError::TooManyObjects { limit: 100_000 },
            EnvError::NoSuchObject { found: 9, count: 4 },
            EnvError::AlreadyGone { object: 2 },
            EnvError::NoRoom {
                position: [1.0, 2.5],
                found: Obstacle::Object { index: 3 },
                width: 1.0,
            },
            EnvError::NoHeading { found: f64::NAN },
            EnvError::TooManyPhotographs {
                objects: 86,
                views: 1000,
                most: 50_000,
            },
            EnvError::BadAbstraction {
                what: "cell",
                found: 0.0,
                most: 1e6,
            },
            EnvError::TooManyStates {
                found: 2_000_001,
                most: 1_048_576,
            },
            EnvError::BadWorld {
                problem: driftworld_spec::WorldDraft {
                    max_seconds: -1.0,
                    ..driftworld_spec::WorldDraft::default()
                }
                .check()
                .expect_err("durations are not negative"),
            },
            EnvError::PictureSize { width: 0, height: 5000 },
            EnvError::BadScript {
                script: "tour.txt".to_owned(),
                line: 3,
                found: "\"zero\"".to_owned(),
                expected: "a number of steps, 1 to 100000".to_owned(),
            },
            EnvError::BadNetwork {
                file: "net.safetensors".to_owned(),
                place: "__metadata__, policy".to_owned(),
                found: "\"best\"".to_owned(),
                expected: "sampled or greedy".to_owned(),
            },
            EnvError::NoSuchRenderer {
                found: "GPU".to_owned(),
            },
            EnvError::NoGpu {
                tried: vec![
                    "Card 1 (vulkan): is software".to_owned(),
                    "Card 2 (vulkan): is lost".to_owned(),
                ],
            },
            EnvError::GpuPicture {
                width: 16_384,
                height: 16_384,
                most: 8192,
                adapter: "Card 1".to_owned(),
            },
            EnvError::Gpu {
                adapter: "Card 1".to_owned(),
                reason: "out of graphics memory".to_owned(),
            },
            EnvError::BatchSize { found: 0, most: 65_536 },
            EnvError::BatchMemory {
                found: 3_298_534_883_328,
                most: 17_179_869_184,
            },
            EnvError::Stopped,
            EnvError::BatchThreads {
                wanted: 100_000,
                reason: "out of memory".to_owned(),
            },
            EnvError::StateLength { found: 3, expected: 5 },
            EnvError::BatchLength { found: 3, num_envs: 4 },
            EnvError::NoSuchEnv { found: 4, num_envs: 4 },
            EnvError::BatchAction {
                env: 2,
                error: Box::new(EnvError::Ended),
            },
            EnvError::BatchWorld {
                env: 2,
                episode: 7,
                reason: "the disk is full".to_owned(),
            },
            EnvError::BatchImages {
                env: 2,
                found: "64 × 64 pixels of Rgb".to_owned(),
                expected: "84 × 84 pixels of Rgb, Depth".to_owned(),
            },
            EnvError::Recording {
                line: 3,
                found: "the checksum 9a0b1c2d".to_owned(),
                expected: "0a0b1c2d, as the line says".to_owned(),
            },
            EnvError::Replay {
                experience: 17,
                what: "reward",
                found: "3.5".to_owned(),
                expected: "4".to_owned(),
                recorded_by: "0.1.0".to_owned(),
                now: "0.2.0",
            },
            EnvError::BadLibrary {
                byte: 56,
                found: "9 models in 0 bytes".to_owned(),
                expected: "at most 0".to_owned(),
            },
            EnvError::BadModel {
                place: "/accessors/3/count".to_owned(),
                found: "4000000000".to_owned(),
                expected: "at most 1000000".to_owned(),
            },
        ];
        let lines: Vec<String> = errors
            .iter()
            .map(|error| format!("{}: {error}", error.code()))
            .collect();
        insta::assert_snapshot!(lines.join("\n"));
        let covered: BTreeSet<&str> = errors.iter().map(EnvError::code).collect();
        let all: BTreeSet<&str> = EnvError::VARIANTS.iter().copied().collect();
        assert_eq!(covered, all, "every error code has a case here");
    }
}
