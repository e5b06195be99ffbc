//! An agent that knows the map and tours what pays: the ceiling that a learner may come near. How it finds its way is in `route.rs`.

use driftworld_spec::{ActionModel, ActionSpace, EndCondition, MotionModel, Object, RailsProgress, Stimulus, World};

use super::Agent;
use super::route::Route;
use crate::scene::Scene;
use crate::sim::{Action, Environment};

/// Steps after which a target that was not reached is left for later.
const PATIENCE: u32 = 150;

/// Tours all objects that pay, nearest first by the way around obstacles, and then goes where the world's success lies.
///
/// It reads the world's state, not its pictures.
#[derive(Clone, Debug, Default)]
pub struct OnRailsAgent {
    target: Option<Target>,
    steps_on_target: u32,
    given_up: Vec<usize>,
}

/// Where the agent is going.
#[derive(Clone, Debug)]
struct Target {
    /// Index of the object.
    object: usize,
    /// Where it stood when it was chosen.
    goal: [f32; 2],
    /// What the way leads around.
    avoided: Vec<u32>,
    route: Route,
}

impl Target {
    fn new(object: usize, goal: [f32; 2], avoided: Vec<u32>, world: &World, scene: &Scene) -> Self {
        let route = Route::to(world, scene, goal, &avoided);
        Self {
            object,
            goal,
            avoided,
            route,
        }
    }
}

impl OnRailsAgent {
    /// What it is about to do, to be written down.
    pub(crate) fn progress(&self) -> RailsProgress {
        let target = self.target.as_ref();
        RailsProgress {
            target: target.map(|target| target.object as u32),
            goal: target.map_or([0.0; 2], |target| target.goal.map(f64::from)),
            avoided: target.map_or_else(Vec::new, |target| target.avoided.clone()),
            patience: self.steps_on_target,
            given_up: self.given_up.iter().map(|index| *index as u32).collect(),
        }
    }

    /// Goes on from what was written down. A checked world names none but its own objects.
    pub(crate) fn resumed(progress: &RailsProgress, world: &World, scene: &Scene) -> Self {
        let known = |index: &u32| (*index as usize) < world.objects.len();
        let target = progress.target.filter(known).map(|object| {
            let goal = progress.goal.map(|metres| metres as f32);
            let avoided = progress.avoided.iter().copied().filter(known).collect();
            Target::new(object as usize, goal, avoided, world, scene)
        });
        Self {
            target,
            steps_on_target: progress.patience,
            given_up: progress.given_up.iter().map(|index| *index as usize).collect(),
        }
    }

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
        let (world, scene) = (environment.world(), environment.scene());
        let targets = wanted.into_iter().map(|index| {
            let goal = scene.items[index].position;
            Target::new(index, goal, avoided(environment, index), world, scene)
        });
        self.target = targets.min_by(|a, b| a.route.length(here).total_cmp(&b.route.length(here)));
        self.steps_on_target = 0;
    }

    fn towards(&self, environment: &Environment) -> [f64; 3] {
        let Some(Target {
            object: index, route, ..
        }) = &self.target
        else {
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
        let seconds = world.agent_params.time_step as f32 * world.agent_params.frame_skip as f32;
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
        in_space(self.steer(environment), environment)
    }

    fn begin(&mut self, _seed: u64) {
        *self = Self::new();
    }

    fn learns(&self) -> bool {
        false
    }

    fn frozen(&self) -> Option<Box<dyn Agent + Send>> {
        Some(Box::new(self.clone()))
    }
}

impl OnRailsAgent {
    /// What it does next, as speed, turn rate and interaction, whatever actions the world takes.
    pub(crate) fn steer(&mut self, environment: &Environment) -> [f64; 3] {
        self.steps_on_target = self.steps_on_target.saturating_add(1);
        let wanted = wanted(environment);
        let stale = self
            .target
            .as_ref()
            .is_none_or(|target| !wanted.contains(&target.object));
        if !stale && self.steps_on_target > PATIENCE {
            self.given_up.extend(self.target.as_ref().map(|target| target.object));
        }
        if (stale || self.steps_on_target > PATIENCE) && !wanted.is_empty() {
            self.choose(environment);
        } else if wanted.is_empty() {
            self.target = None;
        }
        self.towards(environment)
    }
}

/// The objects that a way to `goal` leads around: what stands fast and is solid or costs.
fn avoided(environment: &Environment, goal: usize) -> Vec<u32> {
    let objects = environment.world().objects.iter().zip(environment.objects());
    let stands = |object: &Object| {
        object.motion_model == MotionModel::Stationary && object.pushable.is_none() && object.respawn.is_none()
    };
    objects
        .enumerate()
        .filter(|(index, (object, state))| {
            *index != goal && state.present && stands(object) && (object.solid || object.reward < 0.0)
        })
        .map(|(index, _)| index as u32)
        .collect()
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
    let velocity = |numbers: [f64; 3]| match agent.action_model {
        ActionModel::ByWaypoint => waypoint(numbers, environment),
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
                let [width, depth] = environment.world().environment_params.arena_size();
                [a / width * 2.0, b / depth * 2.0, c / turn]
            }
            _ => [a / speed, b / turn, c * 2.0 - 1.0],
        });
    };
    let scale = [speed, turn, 1.0];
    let wanted = [numbers[0], numbers[1].clamp(-scale[1], scale[1]), numbers[2]];
    let miss = |row: [f64; 3]| (0..3).map(|k| ((row[k] - wanted[k]) / scale[k]).powi(2)).sum::<f64>();
    let misses = (0..rows).filter_map(|row| Some((row, miss(agent.action_row(row)?))));
    let nearest = misses.min_by(|(_, a), (_, b)| a.total_cmp(b));
    Action::Discrete(nearest.map_or(0, |(row, _)| row))
}

/// A speed and a turn as a point to walk to: that which the velocity leads to in one step.
fn waypoint([speed, turn, _]: [f64; 3], environment: &Environment) -> [f64; 3] {
    let agent = environment.agent();
    let agent_params = &environment.world().agent_params;
    let seconds = agent_params.time_step * f64::from(agent_params.frame_skip);
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
