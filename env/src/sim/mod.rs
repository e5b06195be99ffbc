//! Running a world: actions, bodies, events.

mod action;
mod answer;
mod body;
mod chance;
mod edit;
mod environment;
mod episode;
mod event;
mod judge;
mod motion;
mod moving_body;
mod objects;
mod reuse;
mod snapshot;
mod state;
mod walls;

pub use action::Action;
pub use edit::Obstacle;
pub use environment::Environment;
pub use episode::{AgentState, ObjectState};
pub use event::{Event, Step, Warning};
pub use snapshot::Snapshot;
