//! [`OnRailsAgent`] knows the map and visits whatever pays: a practical ceiling for learners. It also steers worlds on rails.

use driftworld_spec::{Object, RailsProgress, Stimulus, World};

use super::Agent;
use super::nearest::Goal;
use super::planner::Planner;
use super::route::Route;
use super::steering::{Purpose, avoided, is_astray, step_back, towards, walk};
use super::tiers::{by_worth, reacts_to, tiers, wanted};
use crate::ground;
use crate::polygon::distance;
use crate::scene::Scene;
use crate::sim::{Action, Environment, SimRef};

/// Steps after which an unreached target is postponed.
const PATIENCE: u32 = 150;

/// Steps after which it checks again whether anything is reachable.
const RECHECK_INTERVAL: u32 = 20;

/// Distance in metres from the edge of a respawning object at which the agent waits for it.
const RESPAWN_CLEARANCE: f32 = 1.5;

/// Visits all objects that pay, along paths around obstacles, then goes to the object or zone that counts as success. Visits
/// the nearest first, where an uncertain reward counts as farther away.
///
/// Reads the world's state, not its images.
#[derive(Clone, Debug, Default)]
pub struct OnRailsAgent {
    /// The target and the path to it, and the targets given up.
    progress: RailsProgress,
    /// Where the route leads while the only target is a zone.
    zone_goal: Option<[f32; 2]>,
    /// Leads to the target. Boxed because agents are moved often and this is large.
    route: Box<Route>,
    /// Plans in worlds with doors and things, instead of the tour.
    planner: Box<Planner>,
}

impl OnRailsAgent {
    /// An agent at the start of its tour.
    pub fn new() -> Self {
        Self::default()
    }

    /// Its plan, for a snapshot.
    pub(crate) fn progress(&self) -> RailsProgress {
        self.progress.clone()
    }

    /// Resumes from a snapshot; ignores objects that the world does not have.
    pub(crate) fn resumed(progress: &RailsProgress, world: &World, scene: &Scene) -> Self {
        let mut agent = Self::new();
        let known = |index: &u32| (*index as usize) < world.objects.len();
        agent.progress.steps_on_target = progress.steps_on_target;
        agent.progress.given_up = progress.given_up.iter().copied().filter(known).collect();
        agent.progress.target = progress.target.filter(known);
        if agent.progress.target.is_some() && !world.objects.iter().any(Object::is_used) {
            agent.progress.goal = progress.goal;
            agent.progress.avoided = progress.avoided.iter().copied().filter(known).collect();
            let goal = progress.goal.map(|metres| metres as f32);
            agent.route.lead(world, scene, goal, &agent.progress.avoided);
        }
        agent
    }

    /// Whether nothing worth visiting is left.
    pub(crate) fn is_done(sim: SimRef) -> bool {
        if sim.state.has_things {
            return Planner::is_done(sim);
        }
        wanted(sim).is_empty()
    }

    fn choose(&mut self, sim: SimRef) {
        let tiers = tiers(sim);
        let given_up = self.given_up_of(sim);
        if tiers.iter().flatten().all(|index| given_up.contains(*index)) {
            self.progress.given_up.clear();
        }
        self.progress.steps_on_target = 0;
        self.drop_target();
        for wanted in tiers {
            if let Some(nearest) = self.nearest(sim, &wanted) {
                self.aim_at(nearest, sim);
                return;
            }
            // None of these objects can be reached.
            let given_up = self.given_up_of(sim);
            let unreached = wanted.into_iter().filter(|index| !given_up.contains(*index));
            self.progress.given_up.extend(unreached.map(|index| index as u32));
        }
    }

    /// Targets the object at its current position, and points the route there around everything present now.
    fn aim_at(&mut self, object: u32, sim: SimRef) {
        let goal = sim.objects()[object as usize].position;
        let progress = &mut self.progress;
        progress.target = Some(object);
        progress.goal = goal.map(f64::from);
        progress.avoided = avoided(sim, Some(object as usize));
        self.route.lead(sim.world, sim.scene(), goal, &progress.avoided);
    }

    fn drop_target(&mut self) {
        self.progress.target = None;
        self.progress.goal = [0.0; 2];
        self.progress.avoided.clear();
    }

    /// The nearest of these objects that was not given up; `None` if none can be reached.
    fn nearest(&mut self, sim: SimRef, wanted: &[usize]) -> Option<u32> {
        let here = sim.agent().position;
        let given_up = self.given_up_of(sim);
        let (world, scene) = (sim.world, sim.scene());
        let goals: Vec<Goal> = wanted
            .iter()
            .copied()
            .filter(|index| !given_up.contains(*index))
            .map(|index| Goal {
                object: index as u32,
                place: sim.objects()[index].position,
                probability: world.objects[index].reward_probability.max(0.01) as f32,
            })
            .collect();
        if goals.is_empty() {
            return None;
        }
        let nearest = self.route.nearest(world, scene, here, &goals, &avoided(sim, None));
        nearest.map(|number| goals[number].object)
    }

    fn given_up_of(&self, sim: SimRef) -> GivenUp {
        let mut given_up = Vec::new();
        if !self.progress.given_up.is_empty() {
            given_up.resize(sim.objects().len(), false);
        }
        // Ignores indices beyond the world's objects.
        for index in &self.progress.given_up {
            if let Some(given_up) = given_up.get_mut(*index as usize) {
                *given_up = true;
            }
        }
        GivenUp(given_up)
    }

    fn towards(&mut self, sim: SimRef) -> [f64; 3] {
        let Some(target) = self.progress.target else {
            if let Some(step) = self.towards_zone(sim) {
                return step;
            }
            return if blocks_a_respawn(sim) {
                step_back(sim)
            } else {
                [0.0; 3]
            };
        };
        let object = &sim.world.objects[target as usize];
        if reacts_to(object, Stimulus::AgentInteract) {
            return towards(sim, target, Purpose::Interact, &mut self.route);
        }
        // Contacts count when they begin, so it backs up before touching the object again.
        if sim.state.touches(target as usize) && reacts_to(object, Stimulus::AgentCollide) {
            return step_back(sim);
        }
        towards(sim, target, Purpose::Touch, &mut self.route)
    }

    /// The next step towards the best zone, zero once the agent is in it; `None` if there is no such zone.
    fn towards_zone(&mut self, sim: SimRef) -> Option<[f64; 3]> {
        let here = sim.agent().position;
        let zones = sim.world.environment_params.zones.iter();
        let wanted = zones.filter(|zone| zone.is_wanted());
        let goals = wanted.filter_map(|zone| Some((zone, ground::middle(zone)?.map(|metres| metres as f32))));
        // Ties go to the nearest.
        let (zone, goal) = goals.max_by(|(a, to_a), (b, to_b)| {
            by_worth(a, b).then(distance(here, *to_b).total_cmp(&distance(here, *to_a)))
        })?;
        if zone.contains(here.map(f64::from)) {
            return Some([0.0; 3]);
        }
        if self.zone_goal != Some(goal) {
            self.route.lead(sim.world, sim.scene(), goal, &avoided(sim, None));
            self.zone_goal = Some(goal);
        }
        Some(walk(goal, sim, &mut self.route))
    }

    /// Its next step as speed, turn rate and interaction, independent of the world's action space.
    pub(crate) fn steer(&mut self, sim: SimRef) -> [f64; 3] {
        let step = if sim.state.has_things {
            self.planner.steer(sim, &mut self.progress)
        } else {
            self.tour(sim)
        };
        self.planner.shield().slowed(sim, step)
    }

    fn tour(&mut self, sim: SimRef) -> [f64; 3] {
        let steps = self.progress.steps_on_target.saturating_add(1);
        self.progress.steps_on_target = steps;
        let target = self.progress.target;
        let given_up = self.given_up_of(sim);
        let wanted = given_up.tier(tiers(sim));
        let stale = target.is_none_or(|target| !wanted.contains(&(target as usize)));
        if !stale && steps > PATIENCE {
            self.progress.given_up.extend(target);
        }
        // If nothing can be reached, it checks again from time to time.
        let is_waiting =
            target.is_none() && steps < RECHECK_INTERVAL && wanted.iter().all(|index| given_up.contains(*index));
        if wanted.is_empty() {
            self.drop_target();
        } else if (stale || steps > PATIENCE) && !is_waiting {
            self.choose(sim);
        }
        if let Some(target) = self.progress.target {
            self.zone_goal = None;
            if is_astray(sim, target, self.progress.goal.map(|metres| metres as f32)) {
                self.aim_at(target, sim);
            }
        }
        self.towards(sim)
    }
}

impl Agent for OnRailsAgent {
    fn act(&mut self, environment: &Environment) -> Action {
        let sim = environment.sim();
        let step = self.steer(sim);
        self.planner.shield().in_space(step, sim)
    }

    // Keeps the route and the planner's floor: they are checked before they are used.
    fn begin(&mut self, _seed: u64) {
        self.progress = RailsProgress::default();
        self.zone_goal = None;
        self.planner.begin();
    }

    fn learns(&self) -> bool {
        false
    }

    fn frozen(&self) -> Option<Box<dyn Agent + Send>> {
        Some(Box::new(self.clone()))
    }
}

/// Whether each object was given up; empty if none was.
struct GivenUp(Vec<bool>);

impl GivenUp {
    fn contains(&self, index: usize) -> bool {
        self.0.get(index).is_some_and(|given_up| *given_up)
    }

    /// The first tier with objects that were not given up; all objects if there is none.
    fn tier(&self, mut tiers: [Vec<usize>; 3]) -> Vec<usize> {
        let is_left = |index: &usize| !self.contains(*index);
        match tiers.iter().position(|tier| tier.iter().any(is_left)) {
            Some(number) => std::mem::take(&mut tiers[number]),
            None => tiers.concat(),
        }
    }
}

/// Whether the agent stands where a paying object would respawn.
fn blocks_a_respawn(sim: SimRef) -> bool {
    let here = sim.agent().position;
    let objects = sim.world.objects.iter().zip(sim.objects()).enumerate();
    let mut absent =
        objects.filter(|(_, (object, state))| !state.present && object.respawn.is_some() && object.is_target());
    absent.any(|(index, (object, _))| {
        let start = object.coordinates.map(|metres| metres as f32);
        distance(here, start) < RESPAWN_CLEARANCE + sim.body_radius(index)
    })
}
