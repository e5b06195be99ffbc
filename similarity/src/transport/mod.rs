//! Exact optimal transport of masses and points.

mod candidates;
mod earth_movers;
mod exact;
mod masses;
mod network_simplex;
mod plan;
mod spanning_tree;
mod start;

pub use earth_movers::earth_movers_distance;
pub use exact::{MAX_TRANSPORTED, optimal_transport};
pub use plan::{Move, TransportPlan};

pub(crate) use exact::{cheapest_moves, check_costs};
pub(crate) use masses::{Units, sum as sum_of_masses};
