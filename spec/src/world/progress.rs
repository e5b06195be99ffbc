//! [`Progress`]: the state of a running world, without which a saved world could not continue unchanged.

use schemars::JsonSchema;
use serde::{Deserialize, Serialize};

use super::WorldDraft;
use super::fields::Place;
use crate::error::Problem;
use crate::serde_defaults::{is_default, is_true};

/// The course of a running world; absent at its start.
///
/// The objects of a world with progress are those of its start and those that were spawned since, where they are now; the
/// destroyed ones are among them. `Environment::state` writes it, a reset to such a world goes on from there.
#[derive(Clone, Debug, Default, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(default, deny_unknown_fields)]
#[schemars(extend("examples" = [
    { "steps": 2, "ticks": 2, "episode_return": 1, "unshaped_return": 1, "velocity": [0, 1], "objects": [{ "collected": true }] },
]))]
pub struct Progress {
    /// In a world without a `seed`, what its random numbers follow from: the hash of where things stood at the start, 64 hexadecimal
    /// letters. Absent if nothing is random.
    #[serde(skip_serializing_if = "Option::is_none")]
    #[schemars(regex(pattern = "^[0-9a-f]{64}$"))]
    pub seed: Option<String>,
    /// Steps since the start.
    #[schemars(range(min = 0, max = 4_294_967_295_u32))]
    pub steps: u32,
    /// Time steps since the start.
    #[schemars(range(min = 0, max = MOST_TICKS))]
    pub ticks: u64,
    /// The sum of rewards since the start.
    #[schemars(range(min = -1e15, max = 1e15))]
    pub episode_return: f64,
    /// The same without what shaping paid.
    #[schemars(range(min = -1e15, max = 1e15))]
    pub unshaped_return: f64,
    /// What the last step paid.
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
    /// Where the agent set out; absent if it is there.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub origin: Option<Origin>,
    /// Written by versions of Driftworld before objects had random streams of their own. Accepted and ignored.
    #[serde(rename = "chance", skip_serializing)]
    #[schemars(range(min = 0, max = MOST))]
    pub former_draws: Option<u64>,
    /// What an agent on rails is about to do.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub rails: Option<RailsProgress>,
    /// Places in the list of the zones that the agent has entered and is in, rising.
    #[serde(skip_serializing_if = "Vec::is_empty")]
    #[schemars(length(max = 1000), inner(range(min = 0, max = 999)))]
    pub zones: Vec<u32>,
    /// The agent's energy; absent if it has none to use.
    #[serde(skip_serializing_if = "Option::is_none")]
    #[schemars(range(min = 0.0, max = 1e9))]
    pub energy: Option<f64>,
    /// One for each object, in order.
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
const MOST: u64 = (1 << 53) - 1;

/// Maximum number of draws of one kind; leaves room for as many again.
const MOST_DRAWN: u64 = 1 << 31;

/// Maximum number of time steps; leaves room for as many again.
const MOST_TICKS: u64 = 1 << 52;

/// An event, as the state vector tells it.
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
#[schemars(extend("examples" = [{ "stimulus": "AgentCollide", "reward": 1, "destroyed": false }]))]
pub struct LastEvent {
    /// What set it off.
    pub stimulus: super::Stimulus,
    /// What was paid for it.
    #[schemars(range(min = -1e15, max = 1e15))]
    pub reward: f64,
    /// Whether it destroyed the object.
    pub destroyed: bool,
}

/// How something stood at the start.
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
#[schemars(extend("examples" = [{ "coordinates": [3, 4], "heading": 90, "reward": 1 }]))]
pub struct Origin {
    /// Its place in metres.
    #[schemars(inner(range(min = -300.0, max = 300.0)))]
    pub coordinates: [f64; 2],
    /// Its heading in degrees.
    #[schemars(range(min = 0.0, max = 360.0))]
    pub heading: f64,
    /// What one triggering was worth.
    #[serde(default, skip_serializing_if = "is_default")]
    #[schemars(range(min = -1e9, max = 1e9))]
    pub reward: f64,
}

/// How far an object has come.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(default, deny_unknown_fields)]
#[expect(
    clippy::struct_excessive_bools,
    reason = "facts that have nothing to do with each other"
)]
#[schemars(extend("examples" = [{ "present": false, "collected": true, "returns_at": 99 }]))]
pub struct ObjectProgress {
    /// Whether it is there.
    #[serde(skip_serializing_if = "is_true")]
    pub present: bool,
    /// Whether it has paid, or was destroyed: places in a sequence count on it.
    #[serde(skip_serializing_if = "is_default")]
    pub collected: bool,
    /// Whether the agent touches it, so that it is no new contact.
    #[serde(skip_serializing_if = "is_default")]
    pub touched: bool,
    /// Whether the agent was in its range at the end of the last step.
    #[serde(skip_serializing_if = "is_default")]
    pub in_range: bool,
    /// How it stood at the start; absent if it still stands so.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub origin: Option<Origin>,
    /// The time step in which it comes back.
    #[serde(skip_serializing_if = "Option::is_none")]
    #[schemars(range(min = 0, max = MOST))]
    pub returns_at: Option<u64>,
    /// Where a wanderer is going, in metres.
    #[serde(skip_serializing_if = "Option::is_none")]
    #[schemars(inner(inner(range(min = -300.0, max = 300.0))))]
    pub goal: Option<[f64; 2]>,
    /// Number of the next point of a patrol, from 0.
    #[serde(skip_serializing_if = "is_default")]
    #[schemars(range(min = 0, max = 999))]
    pub waypoint: u32,
    /// How many goals a wanderer has drawn.
    #[serde(skip_serializing_if = "is_default")]
    #[schemars(range(min = 0, max = MOST_DRAWN))]
    pub goals: u64,
    /// How often a bandit arm has been pulled: each pull is one draw, whatever it pays.
    #[serde(skip_serializing_if = "is_default")]
    #[schemars(range(min = 0, max = MOST_DRAWN))]
    pub pulls: u64,
    /// How often it has come back.
    #[serde(skip_serializing_if = "is_default")]
    #[schemars(range(min = 0, max = MOST_DRAWN))]
    pub returns: u64,
    /// Places that were tried for its next return.
    #[serde(skip_serializing_if = "is_default")]
    #[schemars(range(min = 0, max = MOST_DRAWN))]
    pub tries: u64,
    /// As `chance` of the whole: accepted and ignored.
    #[serde(rename = "chance", skip_serializing)]
    #[schemars(range(min = 0, max = MOST))]
    pub former_draws: Option<u64>,
    /// Velocity of what was pushed, in metres per second.
    #[serde(skip_serializing_if = "Option::is_none")]
    #[schemars(inner(inner(range(min = -1e6, max = 1e6))))]
    pub velocity: Option<[f64; 2]>,
    /// How fast what was pushed turns, in degrees per second clockwise.
    #[serde(skip_serializing_if = "is_default")]
    #[schemars(range(min = -1e9, max = 1e9))]
    pub spin: f64,
    /// Whether a door is open; as at the start if absent.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub open: Option<bool>,
    /// Whether a door was unlocked by its key.
    #[serde(skip_serializing_if = "is_default")]
    pub unlocked: bool,
    /// The time step from which on an open door closes, as soon as nobody stands in it.
    #[serde(skip_serializing_if = "Option::is_none")]
    #[schemars(range(min = 0, max = MOST))]
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

/// What an agent on rails is about to do.
#[derive(Clone, Debug, Default, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(default, deny_unknown_fields)]
#[schemars(extend("examples" = [{ "target": 0, "goal": [3, 4], "avoided": [1], "patience": 7 }]))]
pub struct RailsProgress {
    /// Index of the object that it goes to.
    #[serde(skip_serializing_if = "Option::is_none")]
    #[schemars(range(min = 0, max = 99_999))]
    pub target: Option<u32>,
    /// Where that object stood when it was chosen, in metres.
    #[schemars(inner(range(min = -300.0, max = 300.0)))]
    pub goal: [f64; 2],
    /// Indices of the objects that the way leads around.
    #[schemars(length(max = 100_000), inner(range(min = 0, max = 99_999)))]
    pub avoided: Vec<u32>,
    /// Steps on this target.
    #[serde(rename = "patience")]
    #[schemars(range(min = 0, max = 4_294_967_295_u32))]
    pub steps_on_target: u32,
    /// Indices of the targets that were left for later.
    #[schemars(length(max = 100_000), inner(range(min = 0, max = 99_999)))]
    pub given_up: Vec<u32>,
}

/// The parts of a world's progress that do not fit the world.
pub(super) fn problems(world: &WorldDraft) -> Vec<Problem> {
    let Some(progress) = &world.progress else {
        return Vec::new();
    };
    let (found, count) = (progress.objects.len(), world.objects.len());
    let mut problems = Vec::new();
    if found != count {
        let found = format!("the progress of {found} objects");
        problems.push(wrong("objects", found, format!("one for each of {count} objects")));
    }
    for (index, (object, own)) in world.objects.iter().zip(&progress.objects).enumerate() {
        let at = |key: &str| format!("objects/{index}{key}");
        if own.present && own.returns_at.is_some() {
            let found = "the return of an object that is there";
            problems.push(wrong(&at("/returns_at"), found, "none, or present false"));
        }
        if own.waypoint > 0 {
            let waypoints = object.waypoints.len();
            problems.extend(beyond(&at("/waypoint"), "waypoint", [own.waypoint], waypoints));
        }
        if object.door.is_none() && (own.open.is_some() || own.unlocked || own.closes_at.is_some()) {
            problems.push(wrong(&at(""), "the progress of a door", "none, for it is not a door"));
        }
    }
    let zones = world.environment_params.zones.len();
    problems.extend(beyond("zones", "zone", progress.zones.iter().copied(), zones));
    let rails = progress.rails.iter();
    let named = rails.flat_map(|rails| rails.target.iter().chain(&rails.avoided).chain(&rails.given_up));
    problems.extend(beyond("rails", "object", named.copied(), count));
    problems.extend(carried_problems(world, progress));
    problems
}

/// The carried objects that do not fit the world.
fn carried_problems(world: &WorldDraft, progress: &Progress) -> Vec<Problem> {
    let carried = &progress.carried;
    let mut problems = Vec::new();
    let is_carried = |index: u32| {
        let index = index as usize;
        let is_portable = world.objects.get(index).is_some_and(|object| object.portable.is_some());
        let is_away = |own: &ObjectProgress| !own.present && own.returns_at.is_none();
        is_portable && progress.objects.get(index).is_some_and(is_away)
    };
    let mut places = carried.iter().enumerate();
    if let Some((place, thing)) =
        places.find(|(place, thing)| !is_carried(**thing) || carried[..*place].contains(thing))
    {
        let expected = "a portable object, once, that is not present and does not return";
        problems.push(wrong(&format!("carried/{place}"), format!("object {thing}"), expected));
    }
    let limit = world.agent_params.carry_limit;
    if carried.len() > limit as usize {
        let expected = format!("at most {limit}, the agent's carry_limit");
        problems.push(wrong("carried", format!("{} things", carried.len()), expected));
    }
    problems
}

fn wrong(place: &str, found: impl Into<String>, expected: impl Into<String>) -> Problem {
    Problem::new("spec/progress", format!("/progress/{place}"), found, expected)
}

/// The problem of the first index that is out of range.
fn beyond(place: &str, what: &str, numbers: impl IntoIterator<Item = u32>, count: usize) -> Option<Problem> {
    let number = numbers.into_iter().find(|number| *number as usize >= count)?;
    let expected = format!("one of {count} {what}s, counted from 0");
    Some(wrong(place, format!("{what} {number}"), expected))
}
