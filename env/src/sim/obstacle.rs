//! [`Obstacle`]: the reason why a body does not fit somewhere.

/// An obstacle at the position where the agent should stand.
#[derive(Clone, Copy, Debug, PartialEq, Eq, strum::Display)]
#[non_exhaustive]
pub enum Obstacle {
    /// The position is outside the arena, or not finite.
    #[strum(to_string = "a place outside the arena")]
    Outside,
    /// A wall, or a region that cannot be entered.
    #[strum(to_string = "a wall")]
    Wall,
    /// A solid object.
    #[strum(to_string = "object {index}")]
    Object {
        /// Its index in the world.
        index: usize,
    },
}
