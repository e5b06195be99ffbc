//! [`Shield`] keeps agents that follow a plan away from zones and objects that end the episode as a failure, and out of zones
//! that cost. Plans avoid them, but the world's actions may force longer steps than planned.

use driftworld_spec::{Zone, ZoneEnd};

use super::steering::{failing, in_space_where};
use crate::sim::{Action, SimRef};

/// Fractions of the planned speed to try, in this order.
const SPEED_FRACTIONS: [f64; 4] = [1.0, 0.5, 0.25, 0.0];

/// Extra distance that steps keep from objects that fail the episode when touched, in metres.
const CLEARANCE: f64 = 0.01;

/// Which zones steps avoid, in addition to objects that fail the episode when touched.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub(super) enum Shield {
    /// Zones that end the episode as a failure.
    #[default]
    Failure,
    /// Those, and zones that cost. Used when the plan crosses no such zone.
    Cost,
}

impl Shield {
    fn avoids(self, zone: &Zone) -> bool {
        zone.ends == Some(ZoneEnd::Failure) || self == Self::Cost && zone.is_costly()
    }

    fn is_needed(self, sim: SimRef) -> bool {
        sim.world.environment_params.zones.iter().any(|zone| self.avoids(zone)) || failing(sim).next().is_some()
    }

    /// The step as speed, turn rate and interaction, slowed down as far as necessary to be safe.
    pub(super) fn slowed(self, sim: SimRef, [speed, turn, interact]: [f64; 3]) -> [f64; 3] {
        if !self.is_needed(sim) {
            return [speed, turn, interact];
        }
        let mut steps = SPEED_FRACTIONS.into_iter().map(|share| [speed * share, turn, interact]);
        steps
            .find(|step| self.is_safe(sim, *step))
            .unwrap_or([0.0, turn, interact])
    }

    /// The step as an action of the world. From an action table, it picks a safe row, if there is one.
    pub(super) fn in_space(self, numbers: [f64; 3], sim: SimRef) -> Action {
        let is_needed = self.is_needed(sim);
        in_space_where(numbers, sim, |row| !is_needed || self.is_safe(sim, row))
    }

    /// Whether a step at this velocity enters no avoided zone and touches no failing object, assuming that nothing blocks it.
    fn is_safe(self, sim: SimRef, step: [f64; 3]) -> bool {
        let path = path(sim, step);
        !sim.views.zones.are_entered(&path, |zone| self.avoids(zone))
            && !failing(sim).any(|object| sim.would_touch(object as u32, &path, CLEARANCE))
    }
}

/// The positions along a step at this velocity, one per time step, assuming that nothing blocks it.
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
