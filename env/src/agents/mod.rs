//! Built-in agents: still, random, on rails (knows the map), scripted, Sarsa (a learner), and trained networks.

mod agent;
mod grid;
mod network;
mod on_rails;
mod planner;
mod random;
mod sarsa;
mod script;
mod scripted;
mod shield;
mod steering;
mod still;
mod tiers;

pub use agent::{Agent, Label};
pub use network::NetworkAgent;
pub use on_rails::OnRailsAgent;
pub use random::RandomAgent;
pub use sarsa::SarsaAgent;
pub use scripted::ScriptedAgent;
pub(crate) use steering::in_space;
pub use still::StillAgent;
