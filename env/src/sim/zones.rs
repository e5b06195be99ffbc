//! Applies zones to the agent in a time step: rewards, speed, the end of the episode, and teleports.

use driftworld_spec::{World, Zone, ZoneEnd};

use super::action::Intent;
use super::areas::Zones;
use super::event::Step;
use super::footprint::Point;
use super::sim_ref::SimRef;
use super::state::SimState;
use super::things::follow;
use super::views::Views;
use super::walls::agent_obstacle;

/// A command for the body, slowed by the zones that the agent is in.
pub(super) fn slowed(intent: Intent, state: &SimState, zones: &Zones) -> Intent {
    if zones.0.is_empty() {
        return intent;
    }
    let here = state.agent.position.map(f64::from);
    let factor = Zone::speed_factor_of(zones.around(here).map(|zone| zone.speed_factor)) as f32;
    Intent {
        ahead: intent.ahead * factor,
        towards: intent.towards.map(|(point, reach)| (point, reach * factor)),
        ..intent
    }
}

/// Pays the rewards of zones that the agent is in or entered in this time step, and teleports it if one of them does so.
/// Returns how they end the episode.
pub(super) fn apply_zones(world: &World, state: &mut SimState, views: &Views, step: &mut Step) -> Option<ZoneEnd> {
    let zones = &views.zones;
    if zones.0.is_empty() {
        return None;
    }
    let here = state.agent.position.map(f64::from);
    let path = views.bodies.path();
    let mut end = None;
    let mut teleport: Option<(usize, Point)> = None;
    for (area, inside) in zones.0.iter().zip(&mut state.inside) {
        let zone = &area.zone;
        let was_inside = std::mem::replace(inside, area.contains(here));
        let enters = !was_inside && (*inside || area.is_crossed(path));
        if *inside {
            step.reward += zone.reward_per_second * world.agent_params.time_step;
        }
        if enters {
            step.reward += zone.reward_on_entering;
            let is_first = teleport.is_none_or(|(index, _)| area.index < index);
            teleport = zone
                .teleport
                .filter(|_| is_first)
                .map(|to| (area.index, to))
                .or(teleport);
        }
        if enters || *inside {
            end = prefer_success(end, zone.ends);
        }
    }
    let Some((_, to)) = teleport.filter(|_| end.is_none()) else {
        return end;
    };
    let sim = SimRef { world, state, views };
    let position = free_position(sim, to)?;
    let agent = &mut state.agent;
    agent.position = position.map(|metres| metres as f32);
    agent.velocity = [0.0; 2];
    let here = agent.position.map(f64::from);
    follow(state);
    for (area, inside) in zones.0.iter().zip(&mut state.inside) {
        let was_inside = std::mem::replace(inside, area.contains(here));
        if *inside && !was_inside {
            step.reward += area.zone.reward_on_entering;
            end = prefer_success(end, area.zone.ends);
        }
    }
    end
}

/// Of two endings in one time step, a success takes precedence.
fn prefer_success(a: Option<ZoneEnd>, b: Option<ZoneEnd>) -> Option<ZoneEnd> {
    match (a, b) {
        (Some(ZoneEnd::Success), _) | (_, Some(ZoneEnd::Success)) => Some(ZoneEnd::Success),
        (a, b) => a.or(b),
    }
}

/// The nearest position where the agent's body fits, among candidates on rings around the target; `None` if there is none.
fn free_position(sim: SimRef, target: Point) -> Option<Point> {
    /// Number of rings; the radius grows by half the agent's width from ring to ring.
    const RINGS: u32 = 8;
    const DIAGONAL: f64 = std::f64::consts::FRAC_1_SQRT_2;
    const DIRECTIONS: [Point; 8] = [
        [0.0, 1.0],
        [DIAGONAL, DIAGONAL],
        [1.0, 0.0],
        [DIAGONAL, -DIAGONAL],
        [0.0, -1.0],
        [-DIAGONAL, -DIAGONAL],
        [-1.0, 0.0],
        [-DIAGONAL, DIAGONAL],
    ];
    let step = sim.world.agent_params.agent_width / 2.0;
    let around = (1..=RINGS).flat_map(|ring| {
        let by = f64::from(ring) * step;
        DIRECTIONS.map(|[x, y]| [target[0] + by * x, target[1] + by * y])
    });
    let mut positions = std::iter::once(target).chain(around);
    positions.find(|position| agent_obstacle(sim, *position).is_none())
}
