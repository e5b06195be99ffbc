//! Runs a world: physics, rewards, interactions, cameras.
