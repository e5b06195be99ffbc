//! Walking to one object: the way there, the next step on it, and that step as an action of the world. Which object is
//! chosen by the agents.

use driftworld_spec::{ActionModel, ActionSpace, EndCondition, MotionModel, Object, World, Zone};

use super::route::Route;
use crate::sim::{Action, Environment, SimRef};

/// Metres within which an object is walked at straight, whatever the way.
const NEAR: f32 = 2.0;

/// The same in a world with zones that cost.
const NEAR_BESIDE_ZONES: f32 = 1.2;

/// Metres that it looks ahead on its way there, without a layout.
const AHEAD_BESIDE_ZONES: f32 = 0.5;

/// Metres within which an agent that means to interact does so.
const REACH: f32 = 3.0;

/// Degrees off which an agent that stands before an object looks at it.
const FACING: f32 = 30.0;

/// Share of the distance to an object that it may have moved by before the way to it is found anew.
const ASTRAY: f32 = 0.2;

/// What an agent goes to an object for.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) enum Purpose {
    /// To walk into it.
    Touch,
    /// To interact with it.
    Interact,
}

/// Where an agent is going.
#[derive(Clone, Debug)]
pub(super) struct Target {
    /// Index of the object.
    pub(super) object: usize,
    /// Where it stood when it was chosen.
    pub(super) goal: [f32; 2],
    /// What the way leads around.
    pub(super) avoided: Vec<u32>,
}

impl Target {
    /// The object where it is now, with the way around what is there now: the route leads to it from now on.
    pub(super) fn at(object: usize, sim: SimRef, route: &mut Route) -> Self {
        let (world, scene) = (sim.world, sim.scene());
        let goal = sim.objects()[object].position;
        let avoided = avoided(sim, Some(object));
        route.lead(world, scene, goal, &avoided);
        Self { object, goal, avoided }
    }

    /// Whether the object has moved so far that the way leads astray.
    pub(super) fn is_astray(&self, sim: SimRef) -> bool {
        let now = sim.objects()[self.object].position;
        let far = distance(sim.agent().position, now);
        far >= NEAR && distance(now, self.goal) > (ASTRAY * far).max(0.5)
    }

    /// Whether the agent is so near that an interaction should be answered.
    pub(super) fn is_in_reach(&self, sim: SimRef) -> bool {
        let bodies = sim.body_radius(self.object) + sim.world.agent_params.agent_width as f32 / 2.0;
        distance(sim.agent().position, sim.objects()[self.object].position) < bodies + 0.5
    }

    /// The next step on the way, by the route that leads here, as speed, turn rate and interaction.
    pub(super) fn towards(&self, sim: SimRef, purpose: Purpose, route: &mut Route) -> [f64; 3] {
        let goal = sim.objects()[self.object].position;
        let [speed, turn, _] = walk(goal, sim, route);
        if purpose == Purpose::Interact && !interacts_on_the_way(sim) {
            // First it gets there and looks at it, then it interacts.
            return match self.is_in_reach(sim) {
                true if off(sim, goal).abs() < FACING => [0.0, 0.0, 1.0],
                true => [0.0, turn, 0.0],
                false => [speed, turn, 0.0],
            };
        }
        let interact = purpose == Purpose::Interact && distance(sim.agent().position, goal) < REACH;
        [speed, turn, if interact { 1.0 } else { 0.0 }]
    }
}

/// The next step of the way to a place to which the route leads, as speed, turn rate and no interaction.
pub(super) fn walk(goal: [f32; 2], sim: SimRef, route: &mut Route) -> [f64; 3] {
    let world = sim.world;
    let agent = sim.agent();
    // Beside what costs no corner is cut.
    let costs = is_narrow(sim);
    let ahead = if !costs {
        3
    } else if world.plan().is_some() {
        1
    } else {
        // As far as a cell of open ground, however fine the cells are: how fast it walks does not depend on them.
        (AHEAD_BESIDE_ZONES / route.occupancy.grid().side()).round().max(1.0) as usize
    };
    let near = if costs { NEAR_BESIDE_ZONES } else { NEAR };
    let straight = distance(agent.position, goal);
    // In a layout a wall may stand between.
    let mut is_open = || world.plan().is_none() || route.is_straight(agent.position, straight);
    let point = if straight < near && is_open() {
        goal
    } else {
        route.next(agent.position, ahead)
    };
    let (past, widest) = if costs { (0.0, 5.0) } else { (0.3, 25.0) };
    step_to(sim, point, past, widest)
}

/// A step towards a point, and so many metres past it, as speed, turn rate and no interaction: at no speed where it would
/// still be off by more than `widest` degrees after the step.
pub(super) fn step_to(sim: SimRef, point: [f32; 2], past: f32, widest: f32) -> [f64; 3] {
    let agent = &sim.world.agent_params;
    let (off, seconds) = (off(sim, point), seconds(sim));
    let reach = (distance(sim.agent().position, point) + past) / seconds;
    let after_turn = (off.abs() - agent.max_angular_speed as f32 * seconds).max(0.0);
    let speed = if after_turn > widest {
        0.0
    } else {
        reach.min(agent.max_linear_speed as f32)
    };
    [f64::from(speed), f64::from(off / seconds), 0.0]
}

/// How far a point is to the right of where the agent looks, in degrees, -180 to 180.
pub(super) fn off(sim: SimRef, point: [f32; 2]) -> f32 {
    let agent = sim.agent();
    let way = [point[0] - agent.position[0], point[1] - agent.position[1]];
    let wanted = libm::atan2f(way[0], way[1]).to_degrees();
    (wanted - agent.heading_deg + 540.0).rem_euclid(360.0) - 180.0
}

/// Seconds of a step of the agent.
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

/// The objects that are there and whose touch ends the episode as a failure.
pub(super) fn failing(sim: SimRef) -> impl Iterator<Item = usize> {
    let mut conditions = sim.world.rules.failure.iter();
    let has_any = conditions.any(|condition| matches!(condition, EndCondition::Touch(_)));
    let objects = if has_any { sim.world.objects.as_slice() } else { &[] };
    let is_there = move |(index, object): &(usize, &Object)| sim.objects()[*index].present && fails(sim.world, object);
    objects.iter().enumerate().filter(is_there).map(|(index, _)| index)
}

/// Whether no corner is to be cut: beside it may be a zone that costs, or what fails.
pub(super) fn is_narrow(sim: SimRef) -> bool {
    sim.world.environment_params.zones.iter().any(Zone::is_costly) || failing(sim).next().is_some()
}

/// The objects that a way to `goal` leads around: what stands fast and is solid, costs or fails. Without a goal all of them,
/// by rising index.
pub(super) fn avoided(sim: SimRef, goal: Option<usize>) -> Vec<u32> {
    let objects = sim.world.objects.iter().zip(sim.objects());
    let returns_elsewhere = |object: &Object| object.respawn.as_ref().is_some_and(|back| back.radius > 0.0);
    let stands = |object: &Object| {
        object.motion_model == MotionModel::Stationary && object.pushable.is_none() && !returns_elsewhere(object)
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

/// Whether an action can go and interact at once: in tables a row may do one of them alone.
fn interacts_on_the_way(sim: SimRef) -> bool {
    let agent = &sim.world.agent_params;
    agent.num_actions().is_none_or(|rows| {
        let mut rows = (0..rows).filter_map(|row| agent.action_row(row));
        rows.any(|[speed, _, interact]| interact > 0.5 && speed > 0.0)
    })
}

/// The action in the world's own space: the row of its table that comes nearest, if it has one.
pub(crate) fn in_space(numbers: [f64; 3], sim: SimRef) -> Action {
    in_space_where(numbers, sim, |_| true)
}

/// The same, and of the rows of a table rather one that is allowed.
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

impl Environment {
    /// The action of this world that comes nearest to a speed in m/s, a turn rate in °/s, clockwise, and whether to interact.
    pub fn action_near(&self, speed: f64, turn: f64, interact: bool) -> Action {
        in_space([speed, turn, if interact { 1.0 } else { 0.0 }], self.sim())
    }
}

/// A speed and a turn as a point to walk to: that which the velocity leads to in one step.
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

pub(super) fn distance(a: [f32; 2], b: [f32; 2]) -> f32 {
    let (dx, dy) = (a[0] - b[0], a[1] - b[1]);
    (dx * dx + dy * dy).sqrt()
}
