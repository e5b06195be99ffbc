//! [`TransportPlan`]: the moves of an optimal transport, and their cost.

use serde::Serialize;

/// A cheapest way to turn one set of masses into another.
#[derive(Clone, Debug, PartialEq, Serialize)]
pub struct TransportPlan {
    /// The sum of mass times cost over all moves, in units of mass times units of cost.
    pub cost: f64,
    /// The moves, by origin, then by destination: at most `from + to − 1`.
    pub moves: Vec<Move>,
}

/// Mass moved from one place to another.
#[derive(Clone, Copy, Debug, PartialEq, Serialize)]
pub struct Move {
    /// Index among the origins.
    pub from: usize,
    /// Index among the destinations.
    pub to: usize,
    /// Mass moved, above 0.
    pub mass: f64,
}
