//! Plans in worlds with doors, keys, switches and portable things. The planner knows the map and the rules, and acts only as an
//! episode allows.
//!
//! `goals.rs` lists the goals, `plan.rs` and `spending.rs` choose the next subgoal, `subgoal.rs` carries it out, and
//! `floor.rs`, `zone_costs.rs` and `ways.rs` find the path. The next step depends only on the state of the world and on the
//! current target, so a resumed episode continues as it would have.

mod floor;
mod goals;
mod ground_shape;
mod plan;
mod spending;
mod subgoal;
mod ways;
mod zone_costs;

use driftworld_spec::{MotionModel, RailsProgress};

use floor::Floor;
use goals::{Goal, goals};
use plan::Plan;
use subgoal::{Act, Subgoal, is_blocked_by_a_thing};
use ways::Ways;

use crate::agents::shield::Shield;
use crate::agents::steering::step_back;
use crate::agents::tiers::by_worth;
use crate::sim::SimRef;

/// Steps after which a goal that was not reached is postponed.
const PATIENCE: u32 = 3000;

/// Unstick rule `(period, backoff)`: back up for the last steps of each period, longer every time.
const STUCK: (u32, u32) = (200, 4);

/// Blocked rule `(first, each)`: from step `first` on a target, look every `each` steps for a portable thing in the way.
const BLOCKED: (u32, u32) = (40, 5);

/// Chooses and follows goals in one episode.
#[derive(Clone, Debug, Default)]
pub(super) struct Planner {
    floor: Floor,
    ways: Ways,
    /// The first subgoal found in this situation.
    known: Option<(Situation, Option<Subgoal>)>,
    /// A situation in which no goal can be reached, and the zone to enter then.
    idle: Option<(Situation, Option<Subgoal>)>,
    /// Whether the agent can pick up another thing to deliver in this situation.
    gathers: Option<(Situation, bool)>,
}

/// Everything on which a plan depends.
#[derive(Clone, Debug, PartialEq)]
struct Situation {
    version: u64,
    room: Option<u32>,
    target: Option<u32>,
    /// The target's room, if the target can move.
    target_room: Option<u32>,
    /// For each door, whether it is unlocked.
    unlocked: Vec<bool>,
    carried: Vec<u32>,
    /// Positions of the doors, switches and portable things that are present, as bits.
    things: Vec<[u32; 2]>,
    is_due: Vec<bool>,
    /// The objects of all goals.
    goals: Vec<u32>,
}

impl Planner {
    /// Starts an episode. Keeps the floor, which is checked before it is used.
    pub(super) fn begin(&mut self) {
        *self = Self {
            floor: std::mem::take(&mut self.floor),
            ways: std::mem::take(&mut self.ways),
            ..Self::default()
        };
    }

    /// Whether no goal is left.
    pub(super) fn is_done(sim: SimRef) -> bool {
        goals(sim).iter().all(Vec::is_empty)
    }

    /// Which zones the next step must not enter.
    pub(super) fn shield(&self) -> Shield {
        if self.ways.avoids_costs {
            Shield::Cost
        } else {
            Shield::Failure
        }
    }

    /// The next action towards the target or a new one, as speed, turn rate and interaction.
    pub(super) fn steer(&mut self, sim: SimRef, progress: &mut RailsProgress) -> [f64; 3] {
        self.floor.update(sim);
        self.ways.avoids_costs = false;
        let goals = goals(sim);
        let find = |target: u32| goals.iter().flatten().copied().find(|goal| goal.object() == target);
        let mut goal = progress.target.and_then(find);
        let mut subgoal = goal.and_then(|goal| self.first(sim, goal, &goals));
        if subgoal.is_some() && goal.is_some_and(|goal| goals[2].contains(&goal)) && self.can_gather(sim, &goals) {
            subgoal = None;
        }
        let is_waiting = subgoal.is_some_and(|subgoal| subgoal.act == Act::Wait);
        let is_on_the_way = progress.target.is_some() && !is_waiting;
        progress.steps_on_target = progress.steps_on_target.saturating_add(u32::from(is_on_the_way));
        let budget_exhausted = progress.steps_on_target > PATIENCE;
        if budget_exhausted {
            progress.given_up.extend(progress.target);
        }
        if subgoal.is_none() || budget_exhausted {
            if self.is_known_to_be_idle(sim, &goals) {
                let subgoal = self.idle.as_ref().and_then(|(_, subgoal)| *subgoal);
                return subgoal.map_or([0.0; 3], |subgoal| subgoal.act(sim, &self.floor, &mut self.ways));
            }
            goal = self.choose(sim, &goals, &mut progress.given_up);
            progress.target = goal.map(Goal::object);
            progress.steps_on_target = 0;
            subgoal = goal.and_then(|goal| self.first(sim, goal, &goals));
            if subgoal.is_none() {
                subgoal = self.subgoal_without_goals(sim, &goals);
            }
        }
        let (first, each) = BLOCKED;
        if !is_waiting
            && progress.steps_on_target >= first
            && progress.steps_on_target.is_multiple_of(each)
            && is_blocked_by_a_thing(sim)
        {
            return [0.0, 0.0, 1.0];
        }
        let (round, more) = STUCK;
        let back = (more * (1 + progress.steps_on_target / round)).min(round / 2);
        let is_stuck = !is_waiting && progress.steps_on_target % round >= round - back;
        if is_stuck && subgoal.is_some() {
            return step_back(sim);
        }
        subgoal.map_or([0.0; 3], |subgoal| subgoal.act(sim, &self.floor, &mut self.ways))
    }

    /// Whether this situation is known to be one in which no goal can be reached.
    fn is_known_to_be_idle(&self, sim: SimRef, goals: &[Vec<Goal>; 3]) -> bool {
        let known = self.idle.as_ref().map(|(known, _)| known);
        known.is_some_and(|known| *known == self.situation(sim, None, goals))
    }

    /// The subgoal if no goal can be reached: to enter the best zone within reach. Zones that end the episode in success come
    /// first, then those that pay most.
    fn subgoal_without_goals(&mut self, sim: SimRef, goals: &[Vec<Goal>; 3]) -> Option<Subgoal> {
        let plan = Plan::new(sim, &self.floor, goals);
        let zones = sim.world.environment_params.zones.iter().enumerate();
        let wanted = zones.filter(|(_, zone)| zone.is_wanted());
        let subgoals = wanted.filter_map(|(index, zone)| Some((zone, plan.as_ref()?.subgoal_to_enter(index, zone)?)));
        let best = subgoals.reduce(|best, other| if by_worth(other.0, best.0).is_gt() { other } else { best });
        let subgoal = best.map(|(_, subgoal)| subgoal);
        self.idle = Some((self.situation(sim, None, goals), subgoal));
        subgoal
    }

    /// Whether an agent that is delivering a thing can pick up another one to deliver on the same trip.
    fn can_gather(&mut self, sim: SimRef, goals: &[Vec<Goal>; 3]) -> bool {
        let situation = self.situation(sim, None, goals);
        if let Some((known, gathers)) = &self.gathers
            && *known == situation
        {
            return *gathers;
        }
        let plan = Plan::new(sim, &self.floor, goals);
        let is_possible = |goal: &Goal| plan.as_ref().is_some_and(|plan| plan.first(*goal).is_some());
        let gathers = goals[1]
            .iter()
            .any(|goal| matches!(goal, Goal::Bring { .. }) && is_possible(goal));
        self.gathers = Some((situation, gathers));
        gathers
    }

    /// The cheapest goal that can be reached, from the first list that has one.
    fn choose<'a>(&self, sim: SimRef, goals: &[Vec<Goal<'a>>; 3], given_up: &mut Vec<u32>) -> Option<Goal<'a>> {
        let plan = Plan::new(sim, &self.floor, goals)?;
        let is_possible = |goal: &&Goal| plan.first(**goal).is_some();
        let possible = goals
            .iter()
            .map(|list| list.iter().filter(is_possible).copied().collect::<Vec<_>>());
        let mut possible = possible.filter(|list| !list.is_empty());
        let mut list = possible.next()?;
        if list.iter().all(|goal| given_up.contains(&goal.object())) {
            given_up.clear();
        }
        list.retain(|goal| !given_up.contains(&goal.object()));
        // Fewest doors first, then the straight-line distance divided by the probability that it pays.
        let here = sim.agent().position;
        let cost = |goal: &Goal| {
            let index = goal.object() as usize;
            let [x, y] = sim.objects()[index].position;
            let distance = ((x - here[0]).powi(2) + (y - here[1]).powi(2)).sqrt();
            let probability = sim.world.objects[index].reward_probability.max(0.01) as f32;
            let doors = plan.num_doors_to(goal.object()).unwrap_or(0);
            (doors, distance / probability)
        };
        list.into_iter().min_by(|a, b| {
            let (a, b) = (cost(a), cost(b));
            a.0.cmp(&b.0).then(a.1.total_cmp(&b.1))
        })
    }

    /// The first subgoal of a goal; plans again only if the situation has changed.
    fn first(&mut self, sim: SimRef, goal: Goal, goals: &[Vec<Goal>; 3]) -> Option<Subgoal> {
        let situation = self.situation(sim, Some(goal.object()), goals);
        if let Some((known, subgoal)) = &self.known
            && *known == situation
        {
            return *subgoal;
        }
        let subgoal = Plan::new(sim, &self.floor, goals).and_then(|plan| plan.first(goal));
        self.known = Some((situation, subgoal));
        subgoal
    }

    fn situation(&self, sim: SimRef, target: Option<u32>, goals: &[Vec<Goal>; 3]) -> Situation {
        let moves = |index: &u32| {
            let object = &sim.world.objects[*index as usize];
            object.motion_model != MotionModel::Stationary || object.pushable.is_some()
        };
        let used = sim
            .world
            .objects
            .iter()
            .zip(sim.objects())
            .filter(|(object, _)| object.is_used());
        Situation {
            version: self.floor.version,
            room: self.floor.room_at(sim.agent().position),
            target,
            target_room: target.filter(moves).and_then(|index| self.floor.room_of(sim, index)),
            unlocked: sim.state.unlocked().collect(),
            carried: sim.state.carried().to_vec(),
            things: used
                .clone()
                .filter(|(_, own)| own.present)
                .map(|(_, own)| own.position.map(f32::to_bits))
                .collect(),
            is_due: used.map(|(object, _)| sim.state.is_due(object.order)).collect(),
            goals: goals.iter().flatten().map(|goal| goal.object()).collect(),
        }
    }
}
