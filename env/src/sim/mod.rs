//! Running a world: actions, bodies, events.

mod action;
mod broad_phase;
mod budget;
mod collision_world;
mod contact;
#[cfg(test)]
mod crowds;
mod editing;
mod environment;
mod event;
mod features;
mod footprint;
mod interactions;
mod motion;
mod mover;
mod moving_body;
mod neighbours;
mod observation;
mod outline;
mod progress;
mod pushing;
mod sequence;
mod slide;
mod snapshot;
mod state;
mod step;
mod streams;
mod termination;
mod walls;

pub use action::Action;
pub use editing::Obstacle;
pub use environment::Environment;
pub use event::{Event, Step, Warning};
pub use snapshot::Snapshot;
pub use state::{AgentState, ObjectState};
