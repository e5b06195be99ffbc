//! Steps towards a point, and their conversion to actions of the world.

use driftworld_spec::{ActionModel, ActionSpace, EndCondition, Object, World, Zone};

use crate::polygon::distance;
use crate::sim::{Action, SimRef};

/// A step towards a point, overshooting by `past` metres, as speed, turn rate and no interaction. The speed is 0 if the agent
/// would still face more than `max_angle` degrees away from the point after the step.
pub(super) fn step_to(sim: SimRef, point: [f32; 2], past: f32, max_angle: f32) -> [f64; 3] {
    let agent = &sim.world.agent_params;
    let (angle_to, seconds) = (angle_to(sim, point), seconds(sim));
    let reach = (distance(sim.agent().position, point) + past) / seconds;
    let after_turn = (angle_to.abs() - agent.max_angular_speed as f32 * seconds).max(0.0);
    let speed = if after_turn > max_angle {
        0.0
    } else {
        reach.min(agent.max_linear_speed as f32)
    };
    [f64::from(speed), f64::from(angle_to / seconds), 0.0]
}

/// A step backwards, at half speed.
pub(super) fn step_back(sim: SimRef) -> [f64; 3] {
    [-sim.world.agent_params.max_linear_speed / 2.0, 0.0, 0.0]
}

/// Angle from the agent's heading to a point, clockwise in degrees, -180 to 180.
pub(super) fn angle_to(sim: SimRef, point: [f32; 2]) -> f32 {
    let agent = sim.agent();
    let direction = [point[0] - agent.position[0], point[1] - agent.position[1]];
    let wanted = libm::atan2f(direction[0], direction[1]).to_degrees();
    (wanted - agent.heading_deg + 540.0).rem_euclid(360.0) - 180.0
}

/// Duration of an agent's step in seconds.
pub(super) fn seconds(sim: SimRef) -> f32 {
    sim.world.agent_params.time_step as f32 * sim.world.agent_params.frame_skip as f32
}

/// Whether touching an object ends the episode as a failure.
pub(super) fn fails(world: &World, object: &Object) -> bool {
    world
        .rules
        .failure
        .iter()
        .any(|condition| condition.is_touch_of(object))
}

/// Present objects whose touch ends the episode as a failure.
pub(super) fn failing(sim: SimRef) -> impl Iterator<Item = usize> {
    let mut conditions = sim.world.rules.failure.iter();
    let has_any = conditions.any(|condition| matches!(condition, EndCondition::Touch(_)));
    let objects = if has_any { sim.world.objects.as_slice() } else { &[] };
    let is_there = move |(index, object): &(usize, &Object)| sim.objects()[*index].present && fails(sim.world, object);
    objects.iter().enumerate().filter(is_there).map(|(index, _)| index)
}

/// Whether corners must not be cut, because zones that cost or failing objects may be beside them.
pub(super) fn is_narrow(sim: SimRef) -> bool {
    sim.world.environment_params.zones.iter().any(Zone::is_costly) || failing(sim).next().is_some()
}

/// The step in the world's own action space: the nearest row if the world has an action table.
pub(crate) fn in_space(numbers: [f64; 3], sim: SimRef) -> Action {
    in_space_where(numbers, sim, |_| true)
}

/// Like [`in_space`], but prefers allowed rows of an action table.
pub(super) fn in_space_where(numbers: [f64; 3], sim: SimRef, is_allowed: impl Fn([f64; 3]) -> bool) -> Action {
    let agent = &sim.world.agent_params;
    let velocity = |numbers: [f64; 3]| match agent.action_model {
        ActionModel::ByWaypoint => waypoint(numbers, sim),
        _ => numbers,
    };
    let (speed, turn) = (agent.max_linear_speed.max(1e-9), agent.max_angular_speed.max(1e-9));
    let Some(rows) = agent.num_actions() else {
        let numbers = velocity(numbers);
        if agent.actions != ActionSpace::Normalized {
            return Action::Continuous(numbers);
        }
        let [a, b, c] = numbers;
        return Action::Continuous(match agent.action_model {
            ActionModel::ByWaypoint => {
                let [width, depth] = sim.world.environment_params.arena_size();
                [a / width * 2.0, b / depth * 2.0, c / turn]
            }
            _ => [a / speed, b / turn, c * 2.0 - 1.0],
        });
    };
    let scale = [speed, turn, 1.0];
    let wanted = [numbers[0], numbers[1].clamp(-scale[1], scale[1]), numbers[2]];
    let miss = |row: [f64; 3]| (0..3).map(|k| ((row[k] - wanted[k]) / scale[k]).powi(2)).sum::<f64>();
    let misses = (0..rows).filter_map(|row| {
        let numbers = agent.action_row(row)?;
        Some((row, (!is_allowed(numbers), miss(numbers))))
    });
    let nearest = misses.min_by(|(_, a), (_, b)| a.0.cmp(&b.0).then(a.1.total_cmp(&b.1)));
    Action::Discrete(nearest.map_or(0, |(row, _)| row))
}

/// Converts a speed and a turn to a waypoint: the point that the velocity reaches in one step.
fn waypoint([speed, turn, _]: [f64; 3], sim: SimRef) -> [f64; 3] {
    let agent = sim.agent();
    let agent_params = &sim.world.agent_params;
    let seconds = agent_params.time_step * f64::from(agent_params.frame_skip);
    let heading = (agent.heading_deg + (turn * seconds) as f32).to_radians();
    let ahead = if speed < 0.0 {
        speed
    } else {
        agent_params.max_linear_speed.min(speed.max(1.0))
    };
    let reach = (ahead * seconds) as f32;
    let [x, y] = agent.position;
    [
        f64::from(x + libm::sinf(heading) * reach),
        f64::from(y + libm::cosf(heading) * reach),
        turn,
    ]
}
