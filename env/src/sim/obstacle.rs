//! What may stand where the agent should stand. Where walls leave no room is found in `walls.rs`.

use std::fmt;

/// What stands where the agent should stand.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
#[non_exhaustive]
pub enum Obstacle {
    /// Nothing: the place is outside the arena, or not a place at all.
    Outside,
    /// A wall, or a region that cannot be entered.
    Wall,
    /// A solid object.
    Object {
        /// Its index in the world.
        index: usize,
    },
}

impl fmt::Display for Obstacle {
    fn fmt(&self, f: &mut fmt::Formatter) -> fmt::Result {
        match self {
            Self::Outside => f.write_str("no ground of the arena"),
            Self::Wall => f.write_str("a wall"),
            Self::Object { index } => write!(f, "object {index}"),
        }
    }
}
