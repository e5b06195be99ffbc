//! Steers to one object: chooses the path and the next step on it, and converts the step to an action of the world.

use driftworld_spec::{ActionModel, ActionSpace, EndCondition, MotionModel, Object, World, Zone};

use super::route::Route;
use crate::polygon::distance;
use crate::sim::{Action, SimRef};

/// Distance in metres within which an agent walks straight at an object, ignoring the path.
const NEAR: f32 = 2.0;

/// Like `NEAR`, in worlds with zones that cost.
const NEAR_BESIDE_ZONES: f32 = 1.2;

/// Look-ahead along the path in metres, in worlds with zones that cost and without a layout.
const AHEAD_BESIDE_ZONES: f32 = 0.5;

/// Distance in metres within which an agent interacts while walking.
const REACH: f32 = 3.0;

/// Angle in degrees between heading and direction within which an agent faces an object.
const FACING: f32 = 30.0;

/// Fraction of the distance to an object by which the object may move before the path is recomputed.
const ASTRAY: f32 = 0.2;

/// What an agent wants to do at an object.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) enum Purpose {
    /// To walk into it.
    Touch,
    /// To interact with it.
    Interact,
}

/// Whether an object has moved so far from its position when it was chosen that the path there is out of date.
pub(super) fn is_astray(sim: SimRef, object: u32, goal: [f32; 2]) -> bool {
    let now = sim.objects()[object as usize].position;
    let far = distance(sim.agent().position, now);
    far >= NEAR && distance(now, goal) > (ASTRAY * far).max(0.5)
}

/// Whether the agent is near enough for an object to react to an interaction.
pub(super) fn is_in_reach(sim: SimRef, object: u32) -> bool {
    let bodies = sim.body_radius(object as usize) + sim.world.agent_params.agent_width as f32 / 2.0;
    distance(sim.agent().position, sim.objects()[object as usize].position) < bodies + 0.5
}

/// The next step of the route to an object, as speed, turn rate and interaction.
pub(super) fn towards(sim: SimRef, object: u32, purpose: Purpose, route: &mut Route) -> [f64; 3] {
    let goal = sim.objects()[object as usize].position;
    let [speed, turn, _] = walk(goal, sim, route);
    if purpose == Purpose::Interact && !interacts_on_the_way(sim) {
        // Walks there and faces the object before interacting.
        return match is_in_reach(sim, object) {
            true if angle_to(sim, goal).abs() < FACING => [0.0, 0.0, 1.0],
            true => [0.0, turn, 0.0],
            false => [speed, turn, 0.0],
        };
    }
    let interact = purpose == Purpose::Interact && distance(sim.agent().position, goal) < REACH;
    [speed, turn, if interact { 1.0 } else { 0.0 }]
}

/// The next step along the route to a position, as speed, turn rate and no interaction.
pub(super) fn walk(goal: [f32; 2], sim: SimRef, route: &mut Route) -> [f64; 3] {
    let world = sim.world;
    let agent = sim.agent();
    // Where it is narrow, looks less far ahead, so as not to cut corners.
    let is_narrow = is_narrow(sim);
    let ahead = if !is_narrow {
        3
    } else if world.plan().is_some() {
        1
    } else {
        // About one coarse cell, however fine the cells are, so that walking speed does not depend on them.
        (AHEAD_BESIDE_ZONES / route.occupancy.grid().side()).round().max(1.0) as usize
    };
    let near = if is_narrow { NEAR_BESIDE_ZONES } else { NEAR };
    let straight = distance(agent.position, goal);
    // In a layout a wall may stand in between.
    let mut is_open = || world.plan().is_none() || route.is_straight(agent.position, straight);
    let point = if straight < near && is_open() {
        goal
    } else {
        route.next(agent.position, ahead)
    };
    let (past, max_angle) = if is_narrow { (0.0, 5.0) } else { (0.3, 25.0) };
    step_to(sim, point, past, max_angle)
}

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

/// The objects that a path to `goal` avoids: static ones that are solid, cost or fail; without a goal, all of them. In
/// ascending order of index.
pub(super) fn avoided(sim: SimRef, goal: Option<usize>) -> Vec<u32> {
    let objects = sim.world.objects.iter().zip(sim.objects());
    let respawns_elsewhere = |object: &Object| object.respawn.as_ref().is_some_and(|back| back.radius > 0.0);
    let stands = |object: &Object| {
        object.motion_model == MotionModel::Stationary && object.pushable.is_none() && !respawns_elsewhere(object)
    };
    objects
        .enumerate()
        .filter(|(index, (object, state))| {
            Some(*index) != goal
                && state.present
                && stands(object)
                && (object.solid || object.reward < 0.0 || fails(sim.world, object))
        })
        .map(|(index, _)| index as u32)
        .collect()
}

/// Whether one action can move and interact at the same time; rows of an action table may do only one of them.
fn interacts_on_the_way(sim: SimRef) -> bool {
    let agent = &sim.world.agent_params;
    agent.num_actions().is_none_or(|rows| {
        let mut rows = (0..rows).filter_map(|row| agent.action_row(row));
        rows.any(|[speed, _, interact]| interact > 0.5 && speed > 0.0)
    })
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
