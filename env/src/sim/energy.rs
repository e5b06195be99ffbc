//! The agent's energy: changes with time and distance, and gains from objects.

use driftworld_spec::{Energy, World};

use super::state::SimState;
use super::views::Views;

/// Applies the change of energy in a time step and along the agent's path in it.
pub(super) fn use_energy(world: &World, state: &mut SimState, views: &Views) {
    let Some(energy) = &world.agent_params.energy else {
        return;
    };
    let metres: f64 = views
        .bodies
        .path()
        .windows(2)
        .map(|ends| {
            let [x, y] = [0, 1].map(|axis| ends[1][axis] - ends[0][axis]);
            (x * x + y * y).sqrt()
        })
        .sum();
    let change = energy.per_second * world.agent_params.time_step + energy.per_metre * metres;
    add(energy, state, change);
}

/// Adds an object's energy to the agent's.
pub(super) fn give_energy(world: &World, state: &mut SimState, gain: f64) {
    if let Some(energy) = &world.agent_params.energy {
        add(energy, state, gain);
    }
}

fn add(energy: &Energy, state: &mut SimState, change: f64) {
    state.energy = (state.energy + change).clamp(0.0, energy.most);
}
