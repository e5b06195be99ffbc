//! An agent that knows the map and tours what pays: the ceiling that a learner may come near. How it goes to one object is in
//! `steering.rs`.

use driftworld_spec::{EndCondition, Object, RailsProgress, Stimulus, World};

use super::Agent;
use super::nearest::Goal;
use super::route::Route;
use super::steering::{Purpose, Target, avoided, distance, in_space};
use crate::scene::Scene;
use crate::sim::{Action, Environment};

/// Steps after which a target that was not reached is left for later.
const PATIENCE: u32 = 150;

/// How far from the edge of an object that will come back the agent waits for it, in metres.
const ASIDE: f32 = 1.5;

/// Tours all objects that pay, nearest first by the way around obstacles and surest first where rewards are uncertain, and then goes where the world's success lies.
///
/// It reads the world's state, not its pictures.
#[derive(Clone, Debug, Default)]
pub struct OnRailsAgent {
    target: Option<Target>,
    steps_on_target: u32,
    given_up: Vec<usize>,
    /// Leads to the target. Boxed: agents are moved about, and this is large.
    route: Box<Route>,
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
        let mut route = Box::<Route>::default();
        let target = progress.target.filter(known).map(|object| {
            let goal = progress.goal.map(|metres| metres as f32);
            let avoided: Vec<u32> = progress.avoided.iter().copied().filter(known).collect();
            route.lead(world, scene, goal, &avoided);
            Target {
                object: object as usize,
                goal,
                avoided,
            }
        });
        Self {
            target,
            steps_on_target: progress.patience,
            given_up: progress.given_up.iter().map(|index| *index as usize).collect(),
            route,
        }
    }

    /// An agent at the start of its tour.
    pub fn new() -> Self {
        Self::default()
    }

    /// Whether nothing is worth going to.
    pub(crate) fn is_done(environment: &Environment) -> bool {
        wanted(environment).is_empty()
    }

    fn choose(&mut self, environment: &Environment) {
        let here = environment.agent().position;
        let mut wanted = wanted(environment);
        let mut given_up = vec![false; environment.objects().len()];
        // What was written down may name objects that the world does not have.
        for index in &self.given_up {
            if let Some(given_up) = given_up.get_mut(*index) {
                *given_up = true;
            }
        }
        if wanted.iter().all(|index| given_up[*index]) {
            self.given_up.clear();
            given_up.fill(false);
        }
        wanted.retain(|index| !given_up[*index]);
        let (world, scene) = (environment.world(), environment.scene());
        let goals: Vec<Goal> = wanted
            .into_iter()
            .map(|index| Goal {
                object: index as u32,
                place: scene.items[index].position,
                probability: world.objects[index].reward_probability.max(0.01) as f32,
            })
            .collect();
        let nearest = self
            .route
            .nearest(world, scene, here, &goals, &avoided(environment, None));
        self.target = nearest.map(|number| Target::at(goals[number].object as usize, environment, &mut self.route));
        self.steps_on_target = 0;
    }

    fn towards(&mut self, environment: &Environment) -> [f64; 3] {
        let Some(target) = &self.target else {
            return if stands_in_the_way(environment) {
                back(environment)
            } else {
                [0.0; 3]
            };
        };
        let object = &environment.world().objects[target.object];
        if reacts_to(object, Stimulus::AgentInteract) {
            return target.towards(environment, Purpose::Interact, &mut self.route);
        }
        // A contact counts when it begins: what wants to be touched again is left first.
        if environment.touches(target.object) && reacts_to(object, Stimulus::AgentCollide) {
            return back(environment);
        }
        target.towards(environment, Purpose::Touch, &mut self.route)
    }
}

impl Agent for OnRailsAgent {
    fn act(&mut self, environment: &Environment) -> Action {
        in_space(self.steer(environment), environment)
    }

    fn begin(&mut self, _seed: u64) {
        // What the route knows of the ground it looks at again before it uses it.
        let route = std::mem::take(&mut self.route);
        *self = Self { route, ..Self::new() };
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
        if let Some(target) = self.target.as_mut().filter(|target| target.is_astray(environment)) {
            *target = Target::at(target.object, environment, &mut self.route);
        }
        self.towards(environment)
    }
}

/// The objects worth going to, by index: those that pay now; if there are none, those whose touch is a success.
fn wanted(environment: &Environment) -> Vec<usize> {
    let world = environment.world();
    let states = environment.objects();
    // In a sequence only what comes first of what is left pays.
    let left = world.objects.iter().zip(states).filter(|(_, state)| !state.collected);
    let first = left.filter_map(|(object, _)| object.order).min();
    let in_turn = |index: &usize| {
        let order = world.objects[*index].order;
        order.is_none_or(|own| first.is_none_or(|first| own <= first))
    };
    let pays =
        |index: &usize| world.objects[*index].is_target() && states[*index].present && states[*index].reward > 0.0;
    let paying: Vec<usize> = (0..states.len()).filter(pays).filter(in_turn).collect();
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

/// Whether the agent stands where something that pays would come back.
fn stands_in_the_way(environment: &Environment) -> bool {
    let here = environment.agent().position;
    let items = &environment.scene().items;
    let objects = environment.world().objects.iter().zip(environment.objects());
    let mut gone = objects
        .zip(items)
        .filter(|((object, state), _)| !state.present && object.respawn.is_some() && object.is_target());
    gone.any(|((object, _), item)| {
        let first_place = object.coordinates.map(|metres| metres as f32);
        distance(here, first_place) < ASIDE + item.asset.collider.radius() * item.scale
    })
}

fn back(environment: &Environment) -> [f64; 3] {
    [-environment.world().agent_params.max_linear_speed / 2.0, 0.0, 0.0]
}

fn reacts_to(object: &Object, stimulus: Stimulus) -> bool {
    object.reward_stimulus.contains(&stimulus) || object.reward_once_stimulus.contains(&stimulus)
}
