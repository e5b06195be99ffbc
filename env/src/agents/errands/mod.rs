//! Planning in worlds with doors, keys, switches and things that are carried. It knows the map and the rules, and does nothing
//! that an episode does not allow.
//!
//! What it wants is in `wishes.rs`, what it does first for it in `plan.rs` and `spending.rs`, how it does it in `deed.rs`, where
//! it walks in `floor.rs`, `tolls.rs` and `ways.rs`. What it does next follows from where things are and from the one object that it has set its mind on, so that
//! a world that was written down goes on as it would have.

mod deed;
mod floor;
mod leaf;
mod plan;
mod spending;
mod tolls;
mod ways;
mod wishes;

use driftworld_spec::{MotionModel, Zone};

use deed::{Deed, Task, is_blocked_by_a_thing};
use floor::Floor;
use plan::Plan;
use wishes::{Wish, wishes};

use crate::agents::shield::Shield;
use crate::sim::SimRef;

/// Steps after which a wish that did not come true is left for later.
const PATIENCE: u32 = 3000;

/// Of every so many steps on a target, the last few are steps back, and as many more each time: who got caught somewhere gets
/// free, and does not come back to the very same place for ever.
const STUCK: (u32, u32) = (200, 4);

/// From which step on a target, and then every how many steps, it looks whether a thing that can be carried lies in its way.
const BLOCKED: (u32, u32) = (40, 5);

/// The errands of an agent.
#[derive(Clone, Debug, Default)]
pub(super) struct Errands {
    /// The object that the agent has set its mind on.
    pub(super) target: Option<u32>,
    pub(super) steps_on_target: u32,
    pub(super) given_up: Vec<u32>,
    floor: Floor,
    /// What was to be done first when all was as it says.
    known: Option<(Situation, Option<Task>)>,
    /// Where no wish could come true, and the zone to be in then.
    idle: Option<(Situation, Option<Task>)>,
    /// Whether more can be brought along.
    gathers: Option<(Situation, bool)>,
}

/// All that a plan follows from.
#[derive(Clone, Debug, PartialEq)]
struct Situation {
    version: u64,
    room: Option<u32>,
    target: Option<u32>,
    /// Where the target is, if that can change.
    target_room: Option<u32>,
    /// For each door whether it is unlocked, and what is carried.
    unlocked: Vec<bool>,
    carried: Vec<u32>,
    /// Where portable things and switches are that may be walked through.
    things: Vec<[u32; 2]>,
    is_due: Vec<bool>,
    /// What is wished for.
    wishes: Vec<u32>,
}

impl Errands {
    /// Begins anew. What is known of the ground is looked at again before it is used.
    pub(super) fn begin(&mut self) {
        *self = Self {
            floor: std::mem::take(&mut self.floor),
            ..Self::default()
        };
    }

    /// Whether nothing is left to be done.
    pub(super) fn is_done(sim: SimRef) -> bool {
        wishes(sim).iter().all(Vec::is_empty)
    }

    /// Which zones the last step keeps out of.
    pub(super) fn shield(&self) -> Shield {
        if self.floor.keeps_out {
            Shield::Cost
        } else {
            Shield::Failure
        }
    }

    /// What is done next, as speed, turn rate and interaction.
    pub(super) fn steer(&mut self, sim: SimRef) -> [f64; 3] {
        self.floor.update(sim);
        self.floor.keeps_out = false;
        let wishes = wishes(sim);
        let find = |target: u32| wishes.iter().flatten().copied().find(|wish| wish.object() == target);
        let mut wish = self.target.and_then(find);
        let mut task = wish.and_then(|wish| self.first(sim, wish, &wishes));
        if task.is_some() && wish.is_some_and(|wish| wishes[2].contains(&wish)) && self.can_gather(sim, &wishes) {
            task = None;
        }
        let is_waiting = task.is_some_and(|task| task.deed == Deed::Wait);
        self.steps_on_target = self.steps_on_target.saturating_add(u32::from(!is_waiting));
        let is_tired = self.steps_on_target > PATIENCE;
        if is_tired {
            self.given_up.extend(self.target);
        }
        if task.is_none() || is_tired {
            if self.is_known_to_be_idle(sim, &wishes) {
                let task = self.idle.as_ref().and_then(|(_, task)| *task);
                return task.map_or([0.0; 3], |task| task.act(sim, &mut self.floor));
            }
            wish = self.choose(sim, &wishes);
            self.target = wish.map(Wish::object);
            self.steps_on_target = 0;
            task = wish.and_then(|wish| self.first(sim, wish, &wishes));
            if task.is_none() {
                task = self.rest(sim, &wishes);
            }
        }
        let (least, each) = BLOCKED;
        if !is_waiting
            && self.steps_on_target >= least
            && self.steps_on_target.is_multiple_of(each)
            && is_blocked_by_a_thing(sim)
        {
            return [0.0, 0.0, 1.0];
        }
        let (round, more) = STUCK;
        let back = (more * (1 + self.steps_on_target / round)).min(round / 2);
        let is_stuck = !is_waiting && self.steps_on_target % round >= round - back;
        if is_stuck && task.is_some() {
            return [-sim.world.agent_params.max_linear_speed / 2.0, 0.0, 0.0];
        }
        task.map_or([0.0; 3], |task| task.act(sim, &mut self.floor))
    }

    /// Whether it was found before that no wish can come true in this situation.
    fn is_known_to_be_idle(&self, sim: SimRef, wishes: &[Vec<Wish>; 3]) -> bool {
        let known = self.idle.as_ref().map(|(known, _)| known);
        known.is_some_and(|known| *known == self.situation(sim, None, wishes))
    }

    /// What is done where no wish can come true: the agent goes to the zone that is best to be in, of those to which there is a
    /// way: that which ends the episode well, then that which pays most.
    fn rest(&mut self, sim: SimRef, wishes: &[Vec<Wish>; 3]) -> Option<Task> {
        let plan = Plan::new(sim, &self.floor, wishes);
        let zones = sim.world.environment_params.zones.iter().enumerate();
        let wanted = zones.filter(|(_, zone)| zone.is_wanted());
        let ways = wanted.filter_map(|(index, zone)| Some((zone, plan.as_ref()?.zone_entered(index, zone)?)));
        let value = |zone: &Zone| (zone.ends.is_some(), zone.reward_per_second, zone.reward_on_entering);
        let best = ways.reduce(|best, other| if value(other.0) > value(best.0) { other } else { best });
        let task = best.map(|(_, task)| task);
        self.idle = Some((self.situation(sim, None, wishes), task));
        task
    }

    /// Whether an agent that brings something has a hand free for something else that can be brought along.
    fn can_gather(&mut self, sim: SimRef, wishes: &[Vec<Wish>; 3]) -> bool {
        let situation = self.situation(sim, None, wishes);
        if let Some((known, gathers)) = &self.gathers
            && *known == situation
        {
            return *gathers;
        }
        let plan = Plan::new(sim, &self.floor, wishes);
        let can_be = |wish: &Wish| plan.as_ref().is_some_and(|plan| plan.first(*wish).is_some());
        let gathers = wishes[1]
            .iter()
            .any(|wish| matches!(wish, Wish::Bring { .. }) && can_be(wish));
        self.gathers = Some((situation, gathers));
        gathers
    }

    /// The cheapest wish that can come true, of those that come first.
    fn choose<'a>(&mut self, sim: SimRef, wishes: &[Vec<Wish<'a>>; 3]) -> Option<Wish<'a>> {
        let plan = Plan::new(sim, &self.floor, wishes)?;
        let can_be = |wish: &&Wish| plan.first(**wish).is_some();
        let possible = wishes
            .iter()
            .map(|list| list.iter().filter(can_be).copied().collect::<Vec<_>>());
        let mut possible = possible.filter(|list| !list.is_empty());
        let mut list = possible.next()?;
        if list.iter().all(|wish| self.given_up.contains(&wish.object())) {
            self.given_up.clear();
        }
        list.retain(|wish| !self.given_up.contains(&wish.object()));
        // First the doors on the way, then the way as the crow flies over how likely it pays.
        let here = sim.agent().position;
        let cost = |wish: &Wish| {
            let index = wish.object() as usize;
            let [x, y] = sim.objects()[index].position;
            let far = ((x - here[0]).powi(2) + (y - here[1]).powi(2)).sqrt();
            let odds = sim.world.objects[index].reward_probability.max(0.01) as f32;
            let doors = plan.takes_doors(wish.object()).unwrap_or(0);
            (doors, far / odds)
        };
        list.into_iter().min_by(|a, b| {
            let (a, b) = (cost(a), cost(b));
            a.0.cmp(&b.0).then(a.1.total_cmp(&b.1))
        })
    }

    /// What is done first for a wish. Only looked for where something is other than it was.
    fn first(&mut self, sim: SimRef, wish: Wish, wishes: &[Vec<Wish>; 3]) -> Option<Task> {
        let situation = self.situation(sim, Some(wish.object()), wishes);
        if let Some((known, task)) = &self.known
            && *known == situation
        {
            return *task;
        }
        let task = Plan::new(sim, &self.floor, wishes).and_then(|plan| plan.first(wish));
        self.known = Some((situation, task));
        task
    }

    fn situation(&self, sim: SimRef, target: Option<u32>, wishes: &[Vec<Wish>; 3]) -> Situation {
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
            wishes: wishes.iter().flatten().map(|wish| wish.object()).collect(),
        }
    }
}
