//! Collision groups of bodies.

use rapier3d::prelude::Group;

/// Bodies that stop the agent.
pub(super) const SOLID: Group = Group::GROUP_1;
/// Bodies that the agent passes through.
pub(super) const GHOST: Group = Group::GROUP_2;
/// Walls, which stop the agent and belong to no object.
pub(super) const WALL: Group = Group::GROUP_3;
/// The agent, which moving objects may meet.
pub(super) const AGENT: Group = Group::GROUP_4;
