//! Keeps who walks by a plan out of zones that end the episode as a failure, off objects whose touch does so, and out of zones
//! that cost: a plan leads around them, but steps are as long as the world's actions make them. Where ways lead is found in
//! `flood.rs` and `planner/`.

use driftworld_spec::{Zone, ZoneEnd};

use super::steering::{failing, in_space_where};
use crate::sim::{Action, SimRef};

/// The shares of a speed that are tried.
const SHARES: [f64; 4] = [1.0, 0.5, 0.25, 0.0];

/// How far beyond a touch a step keeps off what fails, in metres.
const AWAY: f64 = 0.01;

/// What a step keeps out of, beside off objects whose touch is a failure.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub(super) enum Shield {
    /// Those that end the episode as a failure.
    #[default]
    Failure,
    /// Those too that cost: the plan does not lead through one.
    Cost,
}

impl Shield {
    fn shuns(self, zone: &Zone) -> bool {
        zone.ends == Some(ZoneEnd::Failure) || self == Self::Cost && zone.is_costly()
    }

    fn has_use(self, sim: SimRef) -> bool {
        sim.world.environment_params.zones.iter().any(|zone| self.shuns(zone)) || failing(sim).next().is_some()
    }

    /// A step as speed, turn rate and interaction, slower where it would lead into what is shunned.
    pub(super) fn slowed(self, sim: SimRef, [speed, turn, interact]: [f64; 3]) -> [f64; 3] {
        if !self.has_use(sim) {
            return [speed, turn, interact];
        }
        let mut steps = SHARES.into_iter().map(|share| [speed * share, turn, interact]);
        steps
            .find(|step| self.is_safe(sim, *step))
            .unwrap_or([0.0, turn, interact])
    }

    /// Such a step as an action of the world: of its table, a row that does not lead into what is shunned, where there
    /// is one.
    pub(super) fn in_space(self, numbers: [f64; 3], sim: SimRef) -> Action {
        let has_use = self.has_use(sim);
        in_space_where(numbers, sim, |row| !has_use || self.is_safe(sim, row))
    }

    /// Whether a step by a velocity enters no zone and touches no object that is shunned, as far as nothing stands in the way.
    fn is_safe(self, sim: SimRef, step: [f64; 3]) -> bool {
        let path = path(sim, step);
        !sim.views.zones.are_entered(&path, |zone| self.shuns(zone))
            && !failing(sim).any(|object| sim.would_touch(object as u32, &path, AWAY))
    }
}

/// Where a step by a velocity leads, if nothing stands in the way: a place for each time step.
fn path(sim: SimRef, [speed, turn, _]: [f64; 3]) -> Vec<[f64; 2]> {
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
    path
}
