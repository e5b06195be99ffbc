//! Running a world: actions, bodies, events.

mod action;
mod body;
mod environment;
mod event;
mod motion;
mod moving_body;
mod objects;
mod reuse;

pub use action::Action;
pub use environment::{AgentState, Environment, ObjectState};
pub use event::{Event, Step, Warning};
