//! Keeps who walks by a plan out of zones that end the episode as a failure: a plan leads around them, but steps are as long as
//! the world's actions make them. Where ways lead is found in `flood.rs` and `errands/`.

use driftworld_spec::ZoneEnd;

use super::steering::in_space_where;
use crate::sim::{Action, SimRef};

/// The shares of a speed that are tried.
const SHARES: [f64; 4] = [1.0, 0.5, 0.25, 0.0];

/// A step as speed, turn rate and interaction, slower where it would lead into a zone that fails.
pub(super) fn shielded(sim: SimRef, [speed, turn, interact]: [f64; 3]) -> [f64; 3] {
    let mut steps = SHARES.into_iter().map(|share| [speed * share, turn, interact]);
    if !can_fail(sim) {
        return [speed, turn, interact];
    }
    steps.find(|step| is_safe(sim, *step)).unwrap_or([0.0, turn, interact])
}

/// Such a step as an action of the world: of its table, a row that does not lead into a zone that fails, where there is one.
pub(crate) fn shielded_in_space(numbers: [f64; 3], sim: SimRef) -> Action {
    let can_fail = can_fail(sim);
    in_space_where(numbers, sim, |row| !can_fail || is_safe(sim, row))
}

fn can_fail(sim: SimRef) -> bool {
    let mut zones = sim.world.environment_params.zones.iter();
    zones.any(|zone| zone.ends == Some(ZoneEnd::Failure))
}

/// Whether a step by a velocity stays out of zones that fail, as far as nothing stands in the way.
fn is_safe(sim: SimRef, [speed, turn, _]: [f64; 3]) -> bool {
    let (agent, params) = (sim.agent(), &sim.world.agent_params);
    let turn = turn.clamp(-params.max_angular_speed, params.max_angular_speed);
    let mut heading = f64::from(agent.heading_deg);
    let mut path = vec![agent.position.map(f64::from)];
    for _ in 0..params.frame_skip.max(1) {
        heading += turn * params.time_step;
        let (sine, cosine) = (libm::sin(heading.to_radians()), libm::cos(heading.to_radians()));
        let [x, y] = path[path.len() - 1];
        let reach = speed * params.time_step;
        path.push([x + sine * reach, y + cosine * reach]);
    }
    !sim.views.zones.fails_on(&path)
}
