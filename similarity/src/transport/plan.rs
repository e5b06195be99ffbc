//! [`TransportPlan`]: what moves where, and what that costs. Finding it is up to `exact.rs`.

use serde::Serialize;

/// A cheapest way to turn one set of masses into another.
#[derive(Clone, Debug, PartialEq, Serialize)]
pub struct TransportPlan {
    /// The sum of mass times cost over all moves, in units of mass times units of cost.
    pub cost: f64,
    /// What moves, by origin, then by destination: at most `from + to − 1` moves.
    pub moves: Vec<Move>,
}

/// Some mass, from one place to another.
#[derive(Clone, Copy, Debug, PartialEq, Serialize)]
pub struct Move {
    /// Index among the origins.
    pub from: usize,
    /// Index among the destinations.
    pub to: usize,
    /// How much, above 0.
    pub mass: f64,
}
