//! Running a world: one state, the systems that change it, the views on it.

mod action;
mod agent_motion;
mod broad_phase;
mod budget;
mod collision_world;
mod contact;
#[cfg(test)]
mod crowds;
mod editing;
mod encounters;
mod environment;
mod event;
mod features;
mod footprint;
mod groups;
mod interactions;
mod motion;
mod mover;
mod moving_body;
mod neighbours;
mod observation;
mod obstacle;
mod outline;
mod progress;
mod pushed;
mod pushing;
mod respawn;
mod sequence;
mod sim_ref;
mod slide;
mod snapshot;
mod state;
mod step;
mod streams;
mod termination;
mod views;
mod walls;
mod warning;

pub use action::Action;
pub use environment::Environment;
pub use event::{Event, Step};
pub use obstacle::Obstacle;
pub(crate) use sim_ref::SimRef;
pub use snapshot::Snapshot;
pub use state::{AgentState, ObjectState};
pub use warning::Warning;
