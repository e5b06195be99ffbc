//! [`TransportPlan`]: what moves where, what that costs, and the prices that prove it. Finding it is up to `exact.rs`.

use serde::Serialize;

/// A cheapest way to turn one set of masses into another.
#[derive(Clone, Debug, PartialEq, Serialize)]
pub struct TransportPlan {
    /// The sum of mass times cost over all moves, in units of mass times units of cost.
    pub cost: f64,
    /// What moves, by origin, then by destination: at most `from + to − 1` moves.
    pub moves: Vec<Move>,
    /// The price at each origin. No price at an origin and price at a destination add up to more than the cost between the two.
    pub from_prices: Vec<f64>,
    /// The price at each destination.
    pub to_prices: Vec<f64>,
    /// How much cheaper than `cost` a plan can be at most: cost less the masses at their prices (weak duality). Rounding leaves
    /// something like 1e-15 of the cost, of either sign.
    pub gap: f64,
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
