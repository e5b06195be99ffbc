//! The groups of bodies that questions about the ground tell apart.

use rapier3d::prelude::Group;

/// Bodies that stop the agent.
pub(super) const SOLID: Group = Group::GROUP_1;
/// Bodies that it passes through.
pub(super) const GHOST: Group = Group::GROUP_2;
/// Walls: they stop it, and are nobody's object.
pub(super) const WALL: Group = Group::GROUP_3;
/// The agent, as objects that move meet it.
pub(super) const AGENT: Group = Group::GROUP_4;
