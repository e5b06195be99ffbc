//! What zones make of the ground: where it is dearer, what entering costs, and where nobody should be. Where ways lead then is
//! found in `ways.rs`.

use driftworld_spec::{World, Zone, ZoneEnd};

use super::floor::COSTS;
use crate::agents::grid::Grid;
use crate::ground;
use crate::polygon::{is_near_or_inside, to_f32};

/// How far ways like to keep from zones that cost or fail, in metres, and how dear it is to be nearer.
const LIKED: f32 = 0.35;
const NEAR: u16 = 8;

/// The most times as dear as elsewhere that a zone makes the ground. Time alone costs nothing in some worlds: whatever costs is
/// so dear there.
const MOST: f64 = 100.0;

/// The most that entering costs, in fifths of a cell: 800 m of open ground with cells of 0.2 m.
const MOST_TOLL: f64 = 20_000.0;

/// The dearest ground, so that sums over all cells stay far from overflow.
const MOST_WEIGHT: f64 = 4000.0;

/// Slower than this nobody gets out of a zone.
const STUCK: f64 = 0.01;

/// What zones do to ways beside making the ground dear.
#[derive(Clone, Debug, Default)]
pub(super) struct Tolls {
    /// For each cell what entering the zones that it is in costs, in fifths of a cell; empty if nothing does.
    entering: Vec<u32>,
    /// Whether a cell is in a zone that costs; empty if none does.
    costs: Vec<bool>,
}

impl Tolls {
    /// Makes ground dearer by the zones that it is in, and takes away that of zones that end an episode as failures.
    pub(super) fn lay(world: &World, grid: Grid, weight: &mut [u16]) -> Self {
        let zones = &world.environment_params.zones;
        if zones.is_empty() {
            return Self::default();
        }
        let agent = &world.agent_params;
        let rules = &world.rules;
        let step = agent.time_step * f64::from(agent.frame_skip.max(1));
        let second = (-rules.reward_per_second - rules.step_reward / step).max(0.0);
        let metre = second / agent.max_linear_speed.max(1e-6);
        let (mut pay, mut pace) = (vec![0.0_f64; weight.len()], vec![1.0_f64; weight.len()]);
        let mut tolls = Self::default();
        for zone in zones {
            let fails = zone.ends == Some(ZoneEnd::Failure);
            if fails || zone.is_costly() {
                shun(zone, fails, grid, weight);
            }
            // What is in it without being meant to be: the end of the episode, another place.
            let is_trap = zone.ends == Some(ZoneEnd::Success) || zone.teleport.is_some();
            let toll = match -zone.reward_on_entering {
                pay if pay <= 0.0 => 0.0,
                pay if metre > 0.0 => (pay / metre / f64::from(grid.side()) * 5.0).min(MOST_TOLL),
                _ => MOST_TOLL,
            };
            if zone.is_costly() {
                tolls.costs.resize(weight.len(), false);
                cells(zone, 0.0, grid).for_each(|cell| tolls.costs[cell] = true);
            }
            // What costs does so from where a step to the next cell could lead into it.
            let margin = if zone.is_costly() { seal(grid) } else { 0.0 };
            for cell in cells(zone, margin, grid) {
                pay[cell] -= zone.reward_per_second;
                pace[cell] = Zone::speed_factor_of([pace[cell], zone.speed_factor]);
                if is_trap {
                    weight[cell] = weight[cell].saturating_mul(COSTS);
                }
                if toll > 0.0 {
                    tolls.entering.resize(weight.len(), 0);
                    tolls.entering[cell] = (tolls.entering[cell] + toll as u32).min(MOST_TOLL as u32);
                }
            }
        }
        for (cell, weight) in weight.iter_mut().enumerate() {
            let by_pay = match pay[cell] {
                pay if pay <= 0.0 => 1.0,
                pay if second > 0.0 => 1.0 + pay / second,
                _ => MOST,
            };
            let times = (by_pay / pace[cell].max(STUCK)).clamp(1.0, MOST);
            *weight = if pace[cell] < STUCK {
                0
            } else {
                (f64::from(*weight) * times).min(MOST_WEIGHT) as u16
            };
        }
        tolls
    }

    /// What a step from a cell to another costs beside the ground, in fifths of a cell.
    pub(super) fn of(&self, from: usize, to: usize) -> u32 {
        match (self.entering.get(from), self.entering.get(to)) {
            (Some(from), Some(to)) => to.saturating_sub(*from),
            _ => 0,
        }
    }

    /// Whether a cell is in a zone that costs.
    pub(super) fn is_in_what_costs(&self, cell: usize) -> bool {
        self.costs.get(cell).is_some_and(|costs| *costs)
    }
}

/// Makes the ground around a zone dear, and shuts that of one that fails.
fn shun(zone: &Zone, fails: bool, grid: Grid, weight: &mut [u16]) {
    for cell in cells(zone, LIKED, grid) {
        weight[cell] = weight[cell].saturating_mul(NEAR);
    }
    if fails {
        cells(zone, seal(grid), grid).for_each(|cell| weight[cell] = 0);
    }
}

/// So far from a border, in metres, no step from cell to cell crosses it.
fn seal(grid: Grid) -> f32 {
    0.71 * grid.side()
}

/// The cells whose middles are in a zone, or nearer to it than this.
fn cells(zone: &Zone, margin: f32, grid: Grid) -> impl Iterator<Item = usize> {
    let corners = to_f32(&ground::corners(zone));
    let bounds = zone.bounds().unwrap_or([[0.0; 2]; 2]);
    let [low, high] = [(0, -margin), (1, margin)].map(|(end, by)| bounds[end].map(|metres| metres as f32 + by));
    let is_there = move |cell: &usize| is_near_or_inside(corners.iter().copied(), grid.centre(*cell), margin);
    grid.within(low, high).filter(is_there)
}
