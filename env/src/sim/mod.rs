//! Running a world: actions, bodies, events.

mod action;
mod body;
mod environment;
mod event;

pub use action::Action;
pub use environment::{AgentState, Environment, ObjectState};
pub use event::{Event, Step, Warning};
