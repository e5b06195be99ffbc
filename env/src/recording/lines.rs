//! [`RecordingLines`] writes recordings as lines of JSON. The first line identifies the file. A world has its own line before
//! the first episode that uses it. Each line ends with a checksum of its contents.

use std::collections::BTreeSet;

use driftworld_spec::World;
use serde::{Deserialize, Serialize};

use super::packed::{PackedActions, deflated};
use super::{EpisodeOrigin, Recording};

/// The version of the format, given in the first line of a file.
pub const RECORDING_FORMAT: u32 = 1;

/// The first line.
#[derive(Debug, Serialize, Deserialize)]
pub(super) struct HeaderLine {
    /// The version of the format.
    pub(super) recording_format: u32,
    /// The version of the program.
    pub(super) driftworld: String,
}

/// A world.
#[derive(Debug, Serialize, Deserialize)]
pub(super) struct WorldLine {
    /// Its hash.
    pub(super) world_hash: String,
    /// Its JSON, deflated and encoded as text.
    pub(super) world: String,
}

/// An episode.
#[derive(Debug, Serialize, Deserialize)]
pub(super) struct EpisodeLine {
    #[serde(flatten)]
    pub(super) origin: EpisodeOrigin,
    /// The hash of its world.
    pub(super) world_hash: String,
    /// Seconds per time step, and time steps for which an action is held, for readers that do not replay the episode.
    pub(super) time_step: f64,
    pub(super) frame_skip: u32,
    pub(super) steps: u32,
    pub(super) reward: f64,
    pub(super) ended_by: Option<String>,
    pub(super) driftworld: String,
    /// The step of each edit, and the hash of the world after it.
    #[serde(default, skip_serializing_if = "Vec::is_empty")]
    pub(super) edits: Vec<(u32, String)>,
    pub(super) actions: PackedActions,
}

/// Writes recordings as lines, each with its line ending.
#[derive(Clone, Debug, Default)]
pub struct RecordingLines {
    /// The hashes of worlds that already have a line.
    known: BTreeSet<String>,
}

impl RecordingLines {
    /// The first line of a file.
    pub fn header() -> String {
        with_checksum(&HeaderLine {
            recording_format: RECORDING_FORMAT,
            driftworld: env!("CARGO_PKG_VERSION").to_owned(),
        })
    }

    /// Continues a file that contains these worlds.
    pub(super) fn with_worlds(known: impl IntoIterator<Item = String>) -> Self {
        Self {
            known: known.into_iter().collect(),
        }
    }

    /// The lines of a recording: its worlds if they are new, then the episode.
    pub fn lines(&mut self, recording: &Recording) -> String {
        let mut lines = String::new();
        let mut hash_of = |world: &World| {
            let json = world.to_json();
            let hash = world.hash();
            if self.known.insert(hash.clone()) {
                lines.push_str(&with_checksum(&WorldLine {
                    world_hash: hash.clone(),
                    world: deflated(json.into_bytes()),
                }));
            }
            hash
        };
        let agent = &recording.world.agent_params;
        let episode = EpisodeLine {
            origin: recording.origin.clone(),
            world_hash: hash_of(&recording.world),
            time_step: agent.time_step,
            frame_skip: agent.frame_skip.max(1),
            steps: u32::try_from(recording.actions.len()).unwrap_or(u32::MAX),
            reward: recording.reward,
            ended_by: recording.ended_by.map(|ended_by| ended_by.word().to_owned()),
            driftworld: recording.recorded_by.clone(),
            edits: (recording.edits.iter())
                .map(|edit| (edit.step, hash_of(&edit.world)))
                .collect(),
            actions: PackedActions::new(&recording.actions),
        };
        lines.push_str(&with_checksum(&episode));
        lines
    }
}

/// The key of the checksum, the last in a line.
const CHECKSUM_KEY: &str = ",\"crc32\":\"";

/// Serialises a line of JSON, with the checksum of its contents and a line ending.
pub(super) fn with_checksum(line: &impl Serialize) -> String {
    let mut json = serde_json::to_string(line).expect("lines have only string keys, so they always serialise");
    let end = json.pop();
    debug_assert_eq!(end, Some('}'), "a line is an object");
    let sum = crc32fast::hash(json.as_bytes());
    json + &format!("{CHECKSUM_KEY}{sum:08x}\"}}\n")
}

/// Verifies the checksum of a line without its line ending; the error is what was found, and what was expected.
pub(super) fn check_checksum(line: &[u8]) -> Result<(), (String, String)> {
    let expected = || "a line of JSON that ends with its checksum".to_owned();
    let text = std::str::from_utf8(line).map_err(|_| ("bytes that are not UTF-8".to_owned(), expected()))?;
    let (body, expected_sum) = text
        .rsplit_once(CHECKSUM_KEY)
        .and_then(|(body, rest)| Some((body, rest.strip_suffix("\"}")?)))
        .ok_or_else(|| ("a line without a checksum at its end".to_owned(), expected()))?;
    let sum = format!("{:08x}", crc32fast::hash(body.as_bytes()));
    if expected_sum == sum {
        Ok(())
    } else {
        Err((
            format!("the checksum {sum}"),
            format!("{expected_sum:.12}, as the line says"),
        ))
    }
}
