//! Results of a step: events, rewards, and the cause of the episode's end.

use std::sync::Arc;

use driftworld_spec::Stimulus;

/// An event at one object.
#[derive(Clone, Debug, PartialEq, serde::Serialize)]
pub struct Event {
    /// Index of the object in the world.
    pub object: usize,
    /// Its tag, if it has one.
    pub tag: Option<Arc<str>>,
    /// The stimulus that triggered it.
    pub stimulus: Stimulus,
    /// Its reward.
    pub reward: f64,
    /// Whether it destroyed the object.
    pub destroyed: bool,
    /// The object's reaction, if it is a door, a switch or portable.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub effect: Option<Effect>,
}

/// The reaction of a door, a switch or a portable object to a stimulus.
#[derive(Clone, Copy, Debug, PartialEq, Eq, serde::Serialize, strum::IntoStaticStr)]
#[serde(rename_all = "snake_case")]
#[strum(serialize_all = "snake_case")]
pub enum Effect {
    /// The door opened.
    Opened,
    /// The door was triggered to close; it closes at the end of the time step, or as soon as nothing stands in it.
    Closed,
    /// The switch opened or closed its doors.
    Switched,
    /// The agent picked the object up.
    PickedUp,
    /// The agent put the object down.
    PutDown,
}

impl Effect {
    /// Its name in serialised events.
    pub fn name(self) -> &'static str {
        self.into()
    }
}

/// The cause of an episode's end; success is stored separately.
#[derive(Clone, Copy, Debug, PartialEq, Eq, serde::Serialize, strum::EnumString, strum::IntoStaticStr)]
#[serde(rename_all = "snake_case")]
#[strum(serialize_all = "snake_case")]
#[non_exhaustive]
pub enum EndedBy {
    /// No object with a positive reward is left.
    AllCollected,
    /// The agent touched or interacted with an object that ends the episode.
    Touch,
    /// A door was opened.
    Opened,
    /// The agent carried an object that ends the episode.
    Carried,
    /// Everything that had to be delivered was in place.
    Delivered,
    /// The return reached a bound.
    Return,
    /// The agent's energy was used up.
    Energy,
    /// A zone ended the episode.
    Zone,
    /// The step limit was reached.
    Steps,
    /// The limit of simulated time was reached.
    Time,
}

impl EndedBy {
    /// Its word in logs.
    pub fn word(self) -> &'static str {
        self.into()
    }
}

/// The result of a step.
#[derive(Clone, Debug, Default, PartialEq, serde::Serialize)]
pub struct Step {
    /// The step's total reward.
    pub reward: f64,
    /// Whether the episode ended by the world's rules.
    pub terminated: bool,
    /// Whether the episode was cut off by a step limit or a limit of simulated time.
    pub truncated: bool,
    /// Whether it ended as a success.
    pub success: bool,
    /// The cause of the end, if the episode ended.
    pub ended_by: Option<EndedBy>,
    /// The events, in the order of objects.
    pub events: Vec<Event>,
}

impl Step {
    /// Whether the episode is over.
    pub fn ended(&self) -> bool {
        self.terminated || self.truncated
    }

    /// Clears the results, but keeps the allocated memory.
    pub(crate) fn clear(&mut self) {
        self.events.clear();
        (self.reward, self.terminated, self.truncated, self.success) = (0.0, false, false, false);
        self.ended_by = None;
    }
}
