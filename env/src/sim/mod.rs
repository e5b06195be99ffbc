//! Running a world: actions, bodies, events.

mod action;
mod answer;
mod body;
mod chance;
mod contact;
#[cfg(test)]
mod crowds;
mod edit;
mod environment;
mod episode;
mod event;
mod features;
mod footprint;
mod judge;
mod look;
mod looks;
mod motion;
mod moving_body;
mod neighbours;
mod objects;
mod outline;
mod places;
mod pushing;
mod sequence;
mod slide;
mod snapshot;
mod state;
mod step;
mod walls;

pub use action::Action;
pub use edit::Obstacle;
pub use environment::Environment;
pub use episode::{AgentState, ObjectState};
pub use event::{Event, Step, Warning};
pub use snapshot::Snapshot;
