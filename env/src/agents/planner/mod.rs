//! Plans the expert's path to rewards: around obstacles and through doors, with keys, switches and portable things. The planner
//! knows the map and the rules, but takes only actions that the episode allows.
//!
//! `goals.rs` lists the goals, `plan.rs` and `spending.rs` choose the next subgoal, `subgoal.rs` carries it out, and
//! `floor.rs`, `zone_costs.rs`, `flood.rs` and `ways.rs` find the path. The next step depends only on the state of the world
//! and on the stored progress, so a resumed episode continues as it would have.

mod flood;
mod floor;
mod goals;
mod ground_shape;
mod plan;
mod spending;
mod subgoal;
mod ways;
mod zone_costs;

use driftworld_spec::RailsProgress;

use floor::{Floor, moves_elsewhere};
pub(super) use goals::can_interact;
use goals::{Goal, goals};
use plan::Plan;
pub(super) use subgoal::Act;
use subgoal::{Subgoal, is_blocked_by_a_thing};
use ways::Ways;

use crate::agents::shield::Shield;
use crate::agents::steering::step_back;
use crate::agents::tiers::by_worth;
use crate::polygon::distance;
use crate::sim::SimRef;

/// Steps after which a goal that was not reached is postponed, if there are others.
const PATIENCE: u32 = 3000;

/// Unstick rule `(period, backoff)`: an agent that makes no headway backs up in the last steps of each period, longer every
/// time. After the first period, paths lead around pushable objects.
const STUCK: (u32, u32) = (100, 4);

/// Steps after which the rule also applies to an agent that walks forwards, since it may walk in a circle.
const CIRCLING: u32 = 1000;

/// Blocked rule `(first, each)`: after `first` steps on a target, look every `each` steps for a portable thing in the way.
const BLOCKED: (u32, u32) = (40, 5);

/// Distance in metres from the edge of a respawning object at which the agent waits for it.
const RESPAWN_CLEARANCE: f32 = 1.5;

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
    /// The rooms of the target, or without one of all goals, that can move or respawn elsewhere.
    rooms: Vec<Option<u32>>,
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
    /// Starts an episode. Keeps the floor and the paths over it, which are checked before they are used.
    pub(super) fn begin(&mut self) {
        self.ways.forget();
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

    /// The next action, as speed, turn rate and interaction.
    pub(super) fn steer(&mut self, sim: SimRef, progress: &mut RailsProgress) -> [f64; 3] {
        self.floor.update(sim, progress.steps_on_target >= STUCK.0);
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
                (progress.target, progress.steps_on_target) = (None, 0);
                let subgoal = self.idle.as_ref().and_then(|(_, subgoal)| *subgoal);
                return self.act(sim, subgoal, &mut progress.goal);
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
        let is_time_to_back = !is_waiting && progress.steps_on_target % round >= round - back;
        if is_time_to_back && subgoal.is_some() && (progress.steps_on_target > CIRCLING || !gets_ahead(sim)) {
            return step_back(sim);
        }
        self.act(sim, subgoal, &mut progress.goal)
    }

    /// The next action of a subgoal; without one, makes room for objects that respawn.
    fn act(&mut self, sim: SimRef, subgoal: Option<Subgoal>, place: &mut [f64; 2]) -> [f64; 3] {
        match subgoal {
            Some(subgoal) => subgoal.act(sim, &self.floor, &mut self.ways, place),
            None if blocks_a_respawn(sim) => step_back(sim),
            None => [0.0; 3],
        }
    }

    /// The next step to an object.
    pub(super) fn approach(&mut self, sim: SimRef, object: u32, act: Act) -> [f64; 3] {
        self.floor.update(sim, false);
        let room = self.floor.room_at(sim.agent().position).unwrap_or_default();
        let mut place = sim.objects()[object as usize].position.map(f64::from);
        Subgoal { object, room, act }.act(sim, &self.floor, &mut self.ways, &mut place)
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
    fn choose<'a>(&mut self, sim: SimRef, goals: &[Vec<Goal<'a>>; 3], given_up: &mut Vec<u32>) -> Option<Goal<'a>> {
        let plan = Plan::new(sim, &self.floor, goals)?;
        let is_possible = |goal: &&Goal| plan.first(**goal).is_some();
        let possible = goals
            .iter()
            .map(|list| list.iter().filter(is_possible).copied().collect::<Vec<_>>());
        let possible: Vec<Vec<Goal>> = possible.filter(|list| !list.is_empty()).collect();
        let is_left = |goal: &Goal| !given_up.contains(&goal.object());
        let mut list = if let Some(list) = possible.iter().find(|list| list.iter().any(is_left)) {
            list.iter().copied().filter(is_left).collect()
        } else {
            given_up.clear();
            possible.into_iter().next()?
        };
        let num_doors = |goal: &Goal| plan.num_doors_to(goal.object()).unwrap_or(0);
        let fewest = list.iter().map(num_doors).min()?;
        list.retain(|goal| num_doors(goal) == fewest);
        self.nearest(sim, list, fewest > 0)
    }

    /// The goal with the smallest ratio of path length to probability that it pays; ties go to the first. Behind doors, the
    /// straight-line distance counts.
    fn nearest<'a>(&mut self, sim: SimRef, goals: Vec<Goal<'a>>, is_behind_doors: bool) -> Option<Goal<'a>> {
        let here = sim.agent().position;
        let probability = |goal: &Goal| sim.world.objects[goal.object() as usize].reward_probability.max(0.01) as f32;
        let straight = |goal: &Goal| distance(here, sim.objects()[goal.object() as usize].position);
        let mut goals: Vec<(f32, Goal)> = goals
            .into_iter()
            .map(|goal| (straight(&goal) / probability(&goal), goal))
            .collect();
        goals.sort_by(|(a, _), (b, _)| a.total_cmp(b));
        self.ways.look_around(&self.floor, here);
        let mut best: Option<(f32, Goal)> = None;
        for (at_least, goal) in goals {
            if best.is_some_and(|(cost, _)| at_least >= cost) {
                break;
            }
            let cost = if is_behind_doors {
                at_least
            } else {
                self.ways.length_to(sim, &self.floor, goal.object()) / probability(&goal)
            };
            if best.is_none_or(|(least, _)| cost < least) {
                best = Some((cost, goal));
            }
        }
        best.map(|(_, goal)| goal)
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
        let moves = |index: &u32| moves_elsewhere(&sim.world.objects[*index as usize]);
        let goals = goals.iter().flatten().map(|goal| goal.object());
        let moving = goals
            .clone()
            .filter(|index| target.is_none_or(|target| target == *index) && moves(index));
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
            rooms: moving.map(|index| self.floor.room_of(sim, index)).collect(),
            unlocked: sim.state.unlocked().collect(),
            carried: sim.state.carried().to_vec(),
            things: used
                .clone()
                .filter(|(_, own)| own.present)
                .map(|(_, own)| own.position.map(f32::to_bits))
                .collect(),
            is_due: used.map(|(object, _)| sim.state.is_due(object.order)).collect(),
            goals: goals.collect(),
        }
    }
}

/// Whether the agent walks forwards, at a tenth of its maximum speed or more.
fn gets_ahead(sim: SimRef) -> bool {
    let agent = sim.agent();
    let heading = agent.heading_deg.to_radians();
    let [east, north] = agent.velocity;
    let forwards = east * libm::sinf(heading) + north * libm::cosf(heading);
    forwards >= sim.world.agent_params.max_linear_speed as f32 / 10.0
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
