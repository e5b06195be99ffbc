//! [`Policy`]: the agents that act while two worlds are compared.

use driftworld_spec::World;
use serde::{Deserialize, Serialize};

use crate::agents::{Agent, OnRailsAgent, RandomAgent, ScriptedAgent, StillAgent};

/// The kind of agent in an experiment.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Serialize, Deserialize, strum::IntoStaticStr)]
#[serde(rename_all = "lowercase")]
#[strum(serialize_all = "lowercase")]
pub enum Policy {
    /// Stands still.
    Still,
    /// Acts at random, as [`RandomAgent`] does.
    Random,
    /// Knows the map and visits the objects that pay, as [`OnRailsAgent`] does.
    Expert,
    /// Touches one object of each tag and interacts with one, regardless of rewards.
    Visitor,
}

impl Policy {
    /// All policies.
    pub const ALL: [Self; 4] = [Self::Still, Self::Random, Self::Expert, Self::Visitor];

    /// Its name in tables.
    pub fn name(self) -> &'static str {
        self.into()
    }

    /// Creates the agent for a world.
    pub(super) fn agent(self, world: &World, seed: u64) -> Box<dyn Agent> {
        match self {
            Self::Still => Box::new(StillAgent),
            Self::Random => Box::new(RandomAgent::new(seed)),
            Self::Expert => Box::new(OnRailsAgent::new()),
            Self::Visitor => scripted(&visits(world, seed % 2 == 1)),
        }
    }
}

fn scripted(script: &str) -> Box<dyn Agent> {
    match ScriptedAgent::parse("experiment", script) {
        Ok(agent) => Box::new(agent),
        // If a script cannot name a tag, the expert takes over.
        Err(_) => Box::new(OnRailsAgent::new()),
    }
}

/// A script that touches and interacts with objects of each one-word tag, in the world's order or backwards.
fn visits(world: &World, is_backwards: bool) -> String {
    let mut tags: Vec<&str> = world
        .objects
        .iter()
        .filter_map(|object| object.tag.as_deref())
        .collect();
    tags.retain(|tag| !tag.is_empty() && !tag.contains(|c: char| c.is_whitespace() || c == '#'));
    if is_backwards {
        tags.reverse();
    }
    let mut script = String::new();
    let mut seen: Vec<&str> = Vec::new();
    for tag in tags {
        if !seen.contains(&tag) {
            seen.push(tag);
            script.extend(["touch ", tag, " 40\ninteract ", tag, " 15\n"]);
        }
    }
    if script.is_empty() {
        "near nothing 1".to_owned()
    } else {
        script + "repeat\n"
    }
}
