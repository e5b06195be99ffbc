//! Running a world: actions, bodies, events.

mod action;
mod answer;
mod body;
mod chance;
mod contact;
mod edit;
mod environment;
mod episode;
mod event;
mod features;
mod footprint;
mod judge;
mod look;
mod motion;
mod moving_body;
mod objects;
mod outline;
mod pushing;
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
