//! [`ZoneCosts`]: the cost that zones add to the ground and to entering, and the cells that they close.

use driftworld_spec::{World, Zone, ZoneEnd};

use super::flood::STRAIGHT;
use crate::agents::grid::Grid;
use crate::polygon::{distance, is_near_or_inside, to_f32};

/// Weight of cells near objects that cost, and factor on the weights of cells in zones that are traps.
pub(super) const COSTS: u16 = 20;

/// Distance in metres that paths preferably keep from zones that cost or fail, and the factor on the weights of nearer cells.
const PREFERRED_CLEARANCE: f32 = 0.35;
const NEAR_FACTOR: u16 = 8;

/// Maximum factor by which zones raise the cost of the ground. Where time costs nothing, every zone that costs gets it.
const MAX_FACTOR: f64 = 100.0;

/// Maximum cost of entering, in fifths of a cell: 800 m of open ground with cells of 0.2 m.
const MAX_ENTRY_COST: f64 = 20_000.0;

/// Maximum weight of a cell, so that sums over all cells stay far from overflow.
const MAX_WEIGHT: f64 = 4000.0;

/// Below this speed factor an agent cannot leave a zone, so its cells are closed.
const MIN_SPEED_FACTOR: f64 = 0.01;

/// Path costs due to zones, in addition to the weights of cells.
#[derive(Clone, Debug, Default)]
pub(super) struct ZoneCosts {
    /// For each cell, the cost of entering its zones, in fifths of a cell; empty if no zone has one.
    entering: Vec<u32>,
    /// Whether a cell is in a zone that costs; empty if none does.
    costs: Vec<bool>,
}

impl ZoneCosts {
    /// Costs of entering each cell alone.
    #[cfg(test)]
    pub(super) fn of_entering(entering: Vec<u32>) -> Self {
        Self {
            entering,
            ..Self::default()
        }
    }

    /// Raises the weights of cells in zones that cost, and closes zones that end an episode in failure.
    pub(super) fn new(world: &World, grid: Grid, weight: &mut [u16]) -> Self {
        let zones = &world.environment_params.zones;
        if zones.is_empty() {
            return Self::default();
        }
        let [second, metre] = costs_of_time(world);
        let (mut pay, mut pace) = (vec![0.0_f64; weight.len()], vec![1.0_f64; weight.len()]);
        let mut zone_costs = Self::default();
        for zone in zones {
            let fails = zone.ends == Some(ZoneEnd::Failure);
            let is_plain = !fails && !zone.is_costly() && zone.ends.is_none() && zone.teleport.is_none();
            if is_plain && (zone.reward_per_second, zone.reward_on_entering, zone.speed_factor) == (0.0, 0.0, 1.0) {
                continue;
            }
            if fails || zone.is_costly() {
                avoid(zone, fails, grid, weight);
            }
            // Entering may also end the episode, or move the agent.
            let is_trap = zone.ends == Some(ZoneEnd::Success) || zone.teleport.is_some();
            let entry_cost = match -zone.reward_on_entering {
                pay if pay <= 0.0 => 0.0,
                pay if metre > 0.0 => (pay / metre / f64::from(grid.side()) * f64::from(STRAIGHT)).min(MAX_ENTRY_COST),
                _ => MAX_ENTRY_COST,
            };
            if zone.is_costly() {
                zone_costs.costs.resize(weight.len(), false);
                cells(zone, 0.0, grid).for_each(|cell| zone_costs.costs[cell] = true);
            }
            // A zone that costs also counts where one more step could lead into it.
            let margin = if zone.is_costly() { seal(grid) } else { 0.0 };
            for cell in cells(zone, margin, grid) {
                pay[cell] -= zone.reward_per_second;
                pace[cell] = Zone::speed_factor_of([pace[cell], zone.speed_factor]);
                if is_trap {
                    weight[cell] = weight[cell].saturating_mul(COSTS);
                }
                if entry_cost > 0.0 {
                    zone_costs.entering.resize(weight.len(), 0);
                    zone_costs.entering[cell] =
                        (zone_costs.entering[cell] + entry_cost as u32).min(MAX_ENTRY_COST as u32);
                }
            }
        }
        for (cell, weight) in weight.iter_mut().enumerate() {
            let by_pay = match pay[cell] {
                pay if pay <= 0.0 => 1.0,
                pay if second > 0.0 => 1.0 + pay / second,
                _ => MAX_FACTOR,
            };
            let factor = (by_pay / pace[cell].max(MIN_SPEED_FACTOR)).clamp(1.0, MAX_FACTOR);
            *weight = if pace[cell] < MIN_SPEED_FACTOR {
                0
            } else {
                (f64::from(*weight) * factor).min(MAX_WEIGHT) as u16
            };
        }
        zone_costs
    }

    /// The cost of a step from one cell to the next in addition to their weights, in fifths of a cell.
    pub(super) fn of(&self, from: usize, to: usize) -> u32 {
        match (self.entering.get(from), self.entering.get(to)) {
            (Some(from), Some(to)) => to.saturating_sub(*from),
            _ => 0,
        }
    }

    /// The maximum cost of entering zones.
    pub(super) fn max_entry(&self) -> u32 {
        self.entering.iter().copied().max().unwrap_or(0)
    }

    /// Whether a cell is in a zone that costs.
    pub(super) fn is_in_costly_zone(&self, cell: usize) -> bool {
        self.costs.get(cell).is_some_and(|costs| *costs)
    }
}

/// The cost of a second, and of a metre at full speed.
pub(super) fn costs_of_time(world: &World) -> [f64; 2] {
    let (agent, rules) = (&world.agent_params, &world.rules);
    let step = agent.time_step * f64::from(agent.frame_skip.max(1));
    let second = (-rules.reward_per_second - rules.step_reward / step).max(0.0);
    [second, second / agent.max_linear_speed.max(1e-6)]
}

/// Raises the weights in and around a zone; if the zone fails, closes its cells.
fn avoid(zone: &Zone, fails: bool, grid: Grid, weight: &mut [u16]) {
    for cell in cells(zone, PREFERRED_CLEARANCE, grid) {
        weight[cell] = weight[cell].saturating_mul(NEAR_FACTOR);
    }
    if fails {
        cells(zone, seal(grid), grid).for_each(|cell| weight[cell] = 0);
    }
}

/// Distance from a border, in metres, at which no step between cells crosses it.
fn seal(grid: Grid) -> f32 {
    0.71 * grid.side()
}

/// The cells whose centres are in a zone, or nearer to it than `margin` metres.
fn cells(zone: &Zone, margin: f32, grid: Grid) -> impl Iterator<Item = usize> {
    let disc = zone.disc.as_ref();
    let disc = disc.map(|disc| (disc.center.map(|metres| metres as f32), disc.radius as f32 + margin));
    let corners = to_f32(zone.polygon.as_deref().unwrap_or_default());
    let bounds = zone.bounds().unwrap_or([[0.0; 2]; 2]);
    let [low, high] = [(0, -margin), (1, margin)].map(|(end, by)| bounds[end].map(|metres| metres as f32 + by));
    let is_there = move |cell: &usize| match disc {
        Some((center, radius)) => distance(grid.centre(*cell), center) < radius,
        None => is_near_or_inside(corners.iter().copied(), grid.centre(*cell), margin),
    };
    grid.within(low, high).filter(is_there)
}
