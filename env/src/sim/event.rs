//! What happened in a step, and what it was worth. Why it happened is in `interactions.rs`.

use std::sync::Arc;

use driftworld_spec::Stimulus;

/// One thing that happened to one object.
#[derive(Clone, Debug, PartialEq, serde::Serialize)]
pub struct Event {
    /// Index of the object in the world.
    pub object: usize,
    /// Its tag, if it has one.
    pub tag: Option<Arc<str>>,
    /// What set it off.
    pub stimulus: Stimulus,
    /// What was paid for it.
    pub reward: f64,
    /// Whether it destroyed the object.
    pub destroyed: bool,
    /// What the object did, if it is a door, a switch or a thing that is carried.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub effect: Option<Effect>,
}

/// What a door, a switch or a thing that is carried did at a stimulus.
#[derive(Clone, Copy, Debug, PartialEq, Eq, serde::Serialize, strum::IntoStaticStr)]
#[serde(rename_all = "snake_case")]
#[strum(serialize_all = "snake_case")]
pub enum Effect {
    /// The door opened.
    Opened,
    /// The door was set to close: it does at the end of the time step, or when nobody stands in it.
    Closed,
    /// The switch moved its doors.
    Switched,
    /// The agent picked the thing up.
    PickedUp,
    /// The agent put the thing down.
    PutDown,
}

impl Effect {
    /// Its name, as events are written.
    pub fn name(self) -> &'static str {
        self.into()
    }
}

/// Why an episode ended. Whether that was a success is said beside it.
#[derive(Clone, Copy, Debug, PartialEq, Eq, serde::Serialize, strum::EnumString, strum::IntoStaticStr)]
#[serde(rename_all = "snake_case")]
#[strum(serialize_all = "snake_case")]
#[non_exhaustive]
pub enum EndedBy {
    /// No object is left that pays a positive reward.
    AllCollected,
    /// The agent touched, or interacted with, an object that ends the episode.
    Touch,
    /// A door was opened.
    Opened,
    /// The agent carried a thing that ends the episode.
    Carried,
    /// All that was to be delivered lay where it should.
    Delivered,
    /// The return reached a bound.
    Return,
    /// The agent's energy was used up.
    Energy,
    /// A zone ended it.
    Zone,
    /// So many steps were over.
    Steps,
    /// So much of the world's own time was over.
    Time,
}

impl EndedBy {
    /// The word that logs have for it.
    pub fn word(self) -> &'static str {
        self.into()
    }
}

/// What a step led to.
#[derive(Clone, Debug, Default, PartialEq, serde::Serialize)]
pub struct Step {
    /// What the step paid in all.
    pub reward: f64,
    /// Whether the episode has come to its end by itself.
    pub terminated: bool,
    /// Whether the episode was cut off by the limit of steps.
    pub truncated: bool,
    /// Whether it ended as a success.
    pub success: bool,
    /// Why the episode ended, if it did.
    pub ended_by: Option<EndedBy>,
    /// What happened, in the order of objects.
    pub events: Vec<Event>,
}

impl Step {
    /// Whether the episode is over.
    pub fn ended(&self) -> bool {
        self.terminated || self.truncated
    }

    /// Forgets what happened, and keeps the memory.
    pub(crate) fn clear(&mut self) {
        self.events.clear();
        (self.reward, self.terminated, self.truncated, self.success) = (0.0, false, false, false);
        self.ended_by = None;
    }
}
