//! [`OnRailsAgent`] knows the map and visits whatever pays: a practical ceiling for learners. It also steers worlds on rails.

mod agent;

use driftworld_spec::{Object, RailsProgress, Stimulus, World, Zone};

use super::nearest::Goal;
use super::planner::Planner;
use super::route::Route;
use super::steering::{Purpose, Target, avoided, distance, walk};
use super::tiers::{reacts_to, tiers, wanted};
use crate::ground;
use crate::scene::Scene;
use crate::sim::SimRef;

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
    target: Option<Target>,
    steps_on_target: u32,
    given_up: Vec<usize>,
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
        let target = self.target.as_ref();
        let planner = &self.planner;
        if planner.target.is_some() || !planner.given_up.is_empty() {
            return RailsProgress {
                target: planner.target,
                steps_on_target: planner.steps_on_target,
                given_up: planner.given_up.clone(),
                ..RailsProgress::default()
            };
        }
        RailsProgress {
            target: target.map(|target| target.object as u32),
            goal: target.map_or([0.0; 2], |target| target.goal.map(f64::from)),
            avoided: target.map_or_else(Vec::new, |target| target.avoided.clone()),
            steps_on_target: self.steps_on_target,
            given_up: self.given_up.iter().map(|index| *index as u32).collect(),
        }
    }

    /// Resumes from a snapshot; ignores objects that the world does not have.
    pub(crate) fn resumed(progress: &RailsProgress, world: &World, scene: &Scene) -> Self {
        let known = |index: &u32| (*index as usize) < world.objects.len();
        if world.objects.iter().any(Object::is_used) {
            let mut planner = Box::<Planner>::default();
            planner.target = progress.target.filter(known);
            planner.steps_on_target = progress.steps_on_target;
            planner.given_up = progress.given_up.iter().copied().filter(known).collect();
            return Self {
                planner,
                ..Self::default()
            };
        }
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
            steps_on_target: progress.steps_on_target,
            given_up: progress.given_up.iter().map(|index| *index as usize).collect(),
            zone_goal: None,
            route,
            planner: Box::default(),
        }
    }

    /// Whether nothing is left that is worth going to.
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
            self.given_up.clear();
        }
        (self.target, self.steps_on_target) = (None, 0);
        for mut wanted in tiers {
            self.target = self.nearest(sim, &wanted);
            if self.target.is_some() {
                return;
            }
            // None of these objects can be reached.
            let given_up = self.given_up_of(sim);
            wanted.retain(|index| !given_up.contains(*index));
            self.given_up.append(&mut wanted);
        }
    }

    /// The nearest of these objects that was not given up; `None` if none can be reached.
    fn nearest(&mut self, sim: SimRef, wanted: &[usize]) -> Option<Target> {
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
        nearest.map(|number| Target::at(goals[number].object as usize, sim, &mut self.route))
    }

    fn given_up_of(&self, sim: SimRef) -> GivenUp {
        let mut given_up = Vec::new();
        if !self.given_up.is_empty() {
            given_up.resize(sim.objects().len(), false);
        }
        // Ignores indices beyond the world's objects.
        for index in &self.given_up {
            if let Some(given_up) = given_up.get_mut(*index) {
                *given_up = true;
            }
        }
        GivenUp(given_up)
    }

    fn towards(&mut self, sim: SimRef) -> [f64; 3] {
        let Some(target) = &self.target else {
            if let Some(step) = self.towards_zone(sim) {
                return step;
            }
            return if blocks_a_respawn(sim) {
                step_back(sim)
            } else {
                [0.0; 3]
            };
        };
        let object = &sim.world.objects[target.object];
        if reacts_to(object, Stimulus::AgentInteract) {
            return target.towards(sim, Purpose::Interact, &mut self.route);
        }
        // Contacts count when they begin, so it backs up before touching the object again.
        if sim.state.touches(target.object) && reacts_to(object, Stimulus::AgentCollide) {
            return step_back(sim);
        }
        target.towards(sim, Purpose::Touch, &mut self.route)
    }

    /// The next step towards the best zone, zero once the agent is in it; `None` if there is no such zone.
    fn towards_zone(&mut self, sim: SimRef) -> Option<[f64; 3]> {
        let here = sim.agent().position;
        let zones = sim.world.environment_params.zones.iter();
        let wanted = zones.filter(|zone| zone.is_wanted());
        let goals = wanted.filter_map(|zone| Some((zone, ground::middle(zone)?.map(|metres| metres as f32))));
        // Zones that end the episode in success come first, then those that pay most; ties go to the nearest.
        let value = |zone: &Zone| (zone.ends.is_some(), zone.reward_per_second, zone.reward_on_entering);
        let (zone, goal) = goals.max_by(|(a, to_a), (b, to_b)| {
            let (a, b) = (value(a), value(b));
            let pay = a.0.cmp(&b.0).then(a.1.total_cmp(&b.1)).then(a.2.total_cmp(&b.2));
            pay.then(distance(here, *to_b).total_cmp(&distance(here, *to_a)))
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
            self.planner.steer(sim)
        } else {
            self.tour(sim)
        };
        self.planner.shield().slowed(sim, step)
    }

    fn tour(&mut self, sim: SimRef) -> [f64; 3] {
        self.steps_on_target = self.steps_on_target.saturating_add(1);
        let given_up = self.given_up_of(sim);
        let wanted = given_up.tier(tiers(sim));
        let stale = self
            .target
            .as_ref()
            .is_none_or(|target| !wanted.contains(&target.object));
        if !stale && self.steps_on_target > PATIENCE {
            self.given_up.extend(self.target.as_ref().map(|target| target.object));
        }
        // If nothing can be reached, it checks again from time to time.
        let is_waiting = self.target.is_none()
            && self.steps_on_target < RECHECK_INTERVAL
            && wanted.iter().all(|index| given_up.contains(*index));
        if wanted.is_empty() {
            self.target = None;
        } else if (stale || self.steps_on_target > PATIENCE) && !is_waiting {
            self.choose(sim);
        }
        if self.target.is_some() {
            self.zone_goal = None;
        }
        if let Some(target) = self.target.as_mut().filter(|target| target.is_astray(sim)) {
            *target = Target::at(target.object, sim, &mut self.route);
        }
        self.towards(sim)
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

fn step_back(sim: SimRef) -> [f64; 3] {
    [-sim.world.agent_params.max_linear_speed / 2.0, 0.0, 0.0]
}
