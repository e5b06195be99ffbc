//! An agent that knows the map and tours what pays: the ceiling that a learner may come near. How it finds its way is in `route.rs`.

use driftworld_spec::{ActionModel, ActionSpace, EndCondition, Object, Stimulus};

use super::Agent;
use super::route::Route;
use crate::sim::{Action, Environment};

/// Steps after which a target that was not reached is left for later.
const PATIENCE: u32 = 150;

/// Tours all objects that pay, nearest first by the way around obstacles, and then goes where the world's success lies.
///
/// It reads the world's state, not its pictures.
#[derive(Clone, Debug, Default)]
pub struct OnRailsAgent {
    target: Option<(usize, Route)>,
    steps_on_target: u32,
    given_up: Vec<usize>,
}

impl OnRailsAgent {
    /// An agent at the start of its tour.
    pub fn new() -> Self {
        Self::default()
    }

    fn choose(&mut self, environment: &Environment) {
        let here = environment.agent().position;
        let mut wanted = wanted(environment);
        if wanted.iter().all(|index| self.given_up.contains(index)) {
            self.given_up.clear();
        }
        wanted.retain(|index| !self.given_up.contains(index));
        let routes = wanted.into_iter().map(|index| (index, Route::to(environment, index)));
        self.target = routes.min_by(|(_, a), (_, b)| a.length(here).total_cmp(&b.length(here)));
        self.steps_on_target = 0;
    }

    fn towards(&self, environment: &Environment) -> [f64; 3] {
        let Some((index, route)) = &self.target else {
            return [0.0; 3];
        };
        let world = environment.world();
        let agent = environment.agent();
        let goal = environment.scene().items[*index].position;
        let straight = distance(agent.position, goal);
        let point = if straight < 2.0 {
            goal
        } else {
            route.next(agent.position, 3)
        };
        let way = [point[0] - agent.position[0], point[1] - agent.position[1]];
        let wanted = libm::atan2f(way[0], way[1]).to_degrees();
        let off = (wanted - agent.heading_deg + 540.0).rem_euclid(360.0) - 180.0;
        let seconds = world.agent_params.time_step as f32;
        // Not past the next point, and not at full speed into a turn.
        let reach = (distance(agent.position, point) + 0.3) / seconds;
        let after_turn = (off.abs() - world.agent_params.max_angular_speed as f32 * seconds).max(0.0);
        let speed = if after_turn > 25.0 {
            0.0
        } else {
            reach.min(world.agent_params.max_linear_speed as f32)
        };
        let interact = reacts_to(&world.objects[*index], Stimulus::AgentInteract) && straight < 3.0;
        [
            f64::from(speed),
            f64::from(off / seconds),
            if interact { 1.0 } else { 0.0 },
        ]
    }
}

impl Agent for OnRailsAgent {
    fn act(&mut self, environment: &Environment) -> Action {
        self.steps_on_target += 1;
        let wanted = wanted(environment);
        let stale = self.target.as_ref().is_none_or(|(index, _)| !wanted.contains(index));
        if !stale && self.steps_on_target > PATIENCE {
            self.given_up.extend(self.target.as_ref().map(|(index, _)| *index));
        }
        if (stale || self.steps_on_target > PATIENCE) && !wanted.is_empty() {
            self.choose(environment);
        } else if wanted.is_empty() {
            self.target = None;
        }
        in_space(self.towards(environment), environment)
    }

    fn begin(&mut self, _seed: u64) {
        *self = Self::new();
    }
}

/// The objects worth going to, by index: those that pay now; if there are none, those whose touch is a success.
fn wanted(environment: &Environment) -> Vec<usize> {
    let world = environment.world();
    let states = environment.objects();
    let lowest = |index: &usize| {
        let order = world.objects[*index].order;
        order.is_none_or(|own| {
            let earlier = world
                .objects
                .iter()
                .zip(states)
                .filter(|(object, state)| object.order.is_some_and(|o| o < own) && !state.collected);
            earlier.count() == 0
        })
    };
    let pays =
        |index: &usize| world.objects[*index].is_target() && states[*index].present && states[*index].reward > 0.0;
    let paying: Vec<usize> = (0..states.len()).filter(pays).filter(lowest).collect();
    if !paying.is_empty() {
        return paying;
    }
    let ends = |object: &Object| {
        world.rules.success.iter().any(|condition| match condition {
            EndCondition::Touch(tag) => object.tag.as_ref() == Some(tag),
            _ => false,
        })
    };
    (0..states.len())
        .filter(|&index| states[index].present && ends(&world.objects[index]))
        .collect()
}

fn reacts_to(object: &Object, stimulus: Stimulus) -> bool {
    object.reward_stimulus.contains(&stimulus) || object.reward_once_stimulus.contains(&stimulus)
}

/// The action in the world's own space: the row of its table that comes nearest, if it has one.
fn in_space(numbers: [f64; 3], environment: &Environment) -> Action {
    let agent = &environment.world().agent_params;
    let ActionSpace::Discrete(table) = &agent.actions else {
        return Action::Continuous(match agent.action_model {
            ActionModel::ByWaypoint => waypoint(numbers, environment),
            _ => numbers,
        });
    };
    let scale = [agent.max_linear_speed.max(1e-9), agent.max_angular_speed.max(1e-9), 1.0];
    let wanted = [numbers[0], numbers[1].clamp(-scale[1], scale[1]), numbers[2]];
    let miss = |row: &[f64; 3]| (0..3).map(|k| ((row[k] - wanted[k]) / scale[k]).powi(2)).sum::<f64>();
    let nearest = table
        .iter()
        .enumerate()
        .min_by(|(_, a), (_, b)| miss(a).total_cmp(&miss(b)));
    Action::Discrete(nearest.map_or(0, |(row, _)| row))
}

/// A speed and a turn as a point to walk to: that which the velocity leads to in one step.
fn waypoint([speed, turn, _]: [f64; 3], environment: &Environment) -> [f64; 3] {
    let agent = environment.agent();
    let seconds = environment.world().agent_params.time_step;
    let heading = (agent.heading_deg + (turn * seconds) as f32).to_radians();
    let reach = (environment.world().agent_params.max_linear_speed.min(speed.max(1.0)) * seconds) as f32;
    let [x, y] = agent.position;
    [
        f64::from(x + libm::sinf(heading) * reach),
        f64::from(y + libm::cosf(heading) * reach),
        turn,
    ]
}

fn distance(a: [f32; 2], b: [f32; 2]) -> f32 {
    let (dx, dy) = (a[0] - b[0], a[1] - b[1]);
    (dx * dx + dy * dy).sqrt()
}
