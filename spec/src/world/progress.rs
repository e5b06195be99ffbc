//! [`Progress`]: the state of a running world, from which a saved world continues exactly as if it had not been interrupted.

use schemars::JsonSchema;
use serde::{Deserialize, Serialize};

use super::fields::Place;
use crate::serde_defaults::{is_default, is_true};

/// The progress of a running world; absent at its start.
///
/// The objects of a world with progress are its initial objects and those spawned since, including destroyed ones, at their
/// current positions. `Environment::state` writes it; a reset to such a world continues from there.
#[derive(Clone, Debug, Default, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(default, deny_unknown_fields)]
#[schemars(extend("examples" = [
    { "steps": 2, "ticks": 2, "episode_return": 1, "unshaped_return": 1, "velocity": [0, 1], "objects": [{ "collected": true }] },
]))]
pub struct Progress {
    /// In a world without a `seed`, the source of its random numbers: the hash of the initial positions, 64 hexadecimal digits.
    /// Absent if nothing is random.
    #[serde(skip_serializing_if = "Option::is_none")]
    #[schemars(regex(pattern = "^[0-9a-f]{64}$"))]
    pub seed: Option<String>,
    /// Steps since the start.
    #[schemars(range(min = 0, max = 4_294_967_295_u32))]
    pub steps: u32,
    /// Time steps since the start.
    #[schemars(range(min = 0, max = MAX_TICKS))]
    pub ticks: u64,
    /// The sum of rewards since the start.
    #[schemars(range(min = -1e15, max = 1e15))]
    pub episode_return: f64,
    /// The sum of rewards since the start, without shaping.
    #[schemars(range(min = -1e15, max = 1e15))]
    pub unshaped_return: f64,
    /// Reward of the last step.
    #[serde(skip_serializing_if = "is_default")]
    #[schemars(range(min = -1e15, max = 1e15))]
    pub last_reward: f64,
    /// The last event of the last step.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub last_event: Option<LastEvent>,
    /// Whether the episode is over.
    #[serde(skip_serializing_if = "is_default")]
    pub ended: bool,
    /// The agent's velocity over the last time step in metres per second.
    #[schemars(inner(range(min = -1e6, max = 1e6)))]
    pub velocity: [f64; 2],
    /// The agent's initial state; absent if unchanged.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub origin: Option<Origin>,
    /// Written by versions of Driftworld in which objects had no random streams of their own. Accepted and ignored.
    #[serde(rename = "chance", skip_serializing)]
    #[schemars(range(min = 0, max = MAX_INTEGER))]
    pub former_draws: Option<u64>,
    /// The current target of an agent on rails.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub rails: Option<RailsProgress>,
    /// Indices of the zones that the agent has entered and is still in, in ascending order.
    #[serde(skip_serializing_if = "Vec::is_empty")]
    #[schemars(length(max = 1000), inner(range(min = 0, max = 999)))]
    pub zones: Vec<u32>,
    /// The agent's energy; absent in worlds without energy.
    #[serde(skip_serializing_if = "Option::is_none")]
    #[schemars(range(min = 0.0, max = 1e9))]
    pub energy: Option<f64>,
    /// One entry for each object, in order.
    #[schemars(length(max = 100_000))]
    pub objects: Vec<ObjectProgress>,
    /// Indices of the objects that the agent carries, in the order in which it picked them up.
    #[serde(skip_serializing_if = "Vec::is_empty")]
    #[schemars(length(max = 100_000), inner(range(min = 0, max = 99_999)))]
    pub carried: Vec<u32>,
}

/// No parameter can set it.
impl Place for Progress {}

/// The largest integer that every JSON reader represents exactly: 2⁵³ − 1.
const MAX_INTEGER: u64 = (1 << 53) - 1;

/// Maximum number of draws of one kind; leaves room for as many again.
const MAX_DRAWS: u64 = 1 << 31;

/// Maximum number of time steps; leaves room for as many again.
const MAX_TICKS: u64 = 1 << 52;

/// An event, as reported in the state vector.
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
#[schemars(extend("examples" = [{ "stimulus": "AgentCollide", "reward": 1, "destroyed": false }]))]
pub struct LastEvent {
    /// The stimulus that caused it.
    pub stimulus: super::stimulus::Stimulus,
    /// The reward paid for it.
    #[schemars(range(min = -1e15, max = 1e15))]
    pub reward: f64,
    /// Whether it destroyed the object.
    pub destroyed: bool,
}

/// The initial state of the agent or an object.
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
#[schemars(extend("examples" = [{ "coordinates": [3, 4], "heading": 90, "reward": 1 }]))]
pub struct Origin {
    /// Its position in metres.
    #[schemars(inner(range(min = -300.0, max = 300.0)))]
    pub coordinates: [f64; 2],
    /// Its heading in degrees.
    #[schemars(range(min = 0.0, max = 360.0))]
    pub heading: f64,
    /// Its reward each time it is triggered.
    #[serde(default, skip_serializing_if = "is_default")]
    #[schemars(range(min = -1e9, max = 1e9))]
    pub reward: f64,
}

/// The progress of an object.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(default, deny_unknown_fields)]
#[expect(clippy::struct_excessive_bools, reason = "the facts are independent")]
#[schemars(extend("examples" = [{ "present": false, "collected": true, "returns_at": 99 }]))]
pub struct ObjectProgress {
    /// Whether it is present.
    #[serde(skip_serializing_if = "is_true")]
    pub present: bool,
    /// Whether it has paid, or was destroyed: sequences depend on it.
    #[serde(skip_serializing_if = "is_default")]
    pub collected: bool,
    /// Whether the agent is touching it, so that touching it is not a new contact.
    #[serde(skip_serializing_if = "is_default")]
    pub touched: bool,
    /// Whether the agent was in its range at the end of the last step.
    #[serde(skip_serializing_if = "is_default")]
    pub in_range: bool,
    /// Its initial state; absent if unchanged.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub origin: Option<Origin>,
    /// The time step in which it returns.
    #[serde(skip_serializing_if = "Option::is_none")]
    #[schemars(range(min = 0, max = MAX_INTEGER))]
    pub returns_at: Option<u64>,
    /// The current goal of a wandering object, in metres.
    #[serde(skip_serializing_if = "Option::is_none")]
    #[schemars(inner(inner(range(min = -300.0, max = 300.0))))]
    pub goal: Option<[f64; 2]>,
    /// Index of the next waypoint of a patrol, from 0.
    #[serde(skip_serializing_if = "is_default")]
    #[schemars(range(min = 0, max = 999))]
    pub waypoint: u32,
    /// Number of goals that a wandering object has drawn.
    #[serde(skip_serializing_if = "is_default")]
    #[schemars(range(min = 0, max = MAX_DRAWS))]
    pub goals: u64,
    /// Number of pulls of a bandit arm: each pull is one draw, whatever it pays.
    #[serde(skip_serializing_if = "is_default")]
    #[schemars(range(min = 0, max = MAX_DRAWS))]
    pub pulls: u64,
    /// Number of times it has returned.
    #[serde(skip_serializing_if = "is_default")]
    #[schemars(range(min = 0, max = MAX_DRAWS))]
    pub returns: u64,
    /// Number of positions tried for its next return.
    #[serde(skip_serializing_if = "is_default")]
    #[schemars(range(min = 0, max = MAX_DRAWS))]
    pub tries: u64,
    /// Like `chance` of the world's progress: accepted and ignored.
    #[serde(rename = "chance", skip_serializing)]
    #[schemars(range(min = 0, max = MAX_INTEGER))]
    pub former_draws: Option<u64>,
    /// Velocity of a pushed object, in metres per second.
    #[serde(skip_serializing_if = "Option::is_none")]
    #[schemars(inner(inner(range(min = -1e6, max = 1e6))))]
    pub velocity: Option<[f64; 2]>,
    /// Turn rate of a pushed object, in degrees per second clockwise.
    #[serde(skip_serializing_if = "is_default")]
    #[schemars(range(min = -1e9, max = 1e9))]
    pub spin: f64,
    /// Whether a door is open; unchanged since the start if absent.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub open: Option<bool>,
    /// Whether a door was unlocked by its key.
    #[serde(skip_serializing_if = "is_default")]
    pub unlocked: bool,
    /// The first time step in which an open door may close; it then closes as soon as nothing stands in it.
    #[serde(skip_serializing_if = "Option::is_none")]
    #[schemars(range(min = 0, max = MAX_INTEGER))]
    pub closes_at: Option<u64>,
}

impl Default for ObjectProgress {
    fn default() -> Self {
        Self {
            present: true,
            collected: false,
            touched: false,
            in_range: false,
            origin: None,
            returns_at: None,
            goal: None,
            waypoint: 0,
            goals: 0,
            pulls: 0,
            returns: 0,
            tries: 0,
            former_draws: None,
            velocity: None,
            spin: 0.0,
            open: None,
            unlocked: false,
            closes_at: None,
        }
    }
}

/// The current target of an agent on rails.
#[derive(Clone, Debug, Default, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(default, deny_unknown_fields)]
#[schemars(extend("examples" = [{ "target": 0, "goal": [3, 4], "patience": 7 }]))]
pub struct RailsProgress {
    /// Index of the target object.
    #[serde(skip_serializing_if = "Option::is_none")]
    #[schemars(range(min = 0, max = 99_999))]
    pub target: Option<u32>,
    /// Position of the target for which the path was found, in metres.
    #[schemars(inner(range(min = -300.0, max = 300.0)))]
    pub goal: [f64; 2],
    /// Number of steps spent on this target.
    #[serde(rename = "patience")]
    #[schemars(range(min = 0, max = 4_294_967_295_u32))]
    pub steps_on_target: u32,
    /// Indices of the postponed targets.
    #[schemars(length(max = 100_000), inner(range(min = 0, max = 99_999)))]
    pub given_up: Vec<u32>,
}
