//! Operations on two worlds with the same objects: copies the state of one into the other, converts a command for both, and
//! finds differences between their states.

use driftworld_spec::{World, Zone};
use driftworld_text::shortened;

use super::action::{Action, Intent};
use super::environment::Environment;
use super::mover::Mover;
use super::sequence::Sequence;
use super::state::{SimState, entry};
use super::walls::agent_obstacle;
use crate::EnvError;

/// Maximum number of characters of a value in a message, because lists of corners may be arbitrarily long.
const MAX_CHARACTERS: usize = 200;

/// A difference, as text, with the value on each side.
#[derive(Clone, Debug, PartialEq)]
pub(crate) struct Difference {
    pub(crate) what: String,
    pub(crate) own: String,
    pub(crate) other: String,
}

impl Difference {
    pub(crate) fn new(what: impl Into<String>, own: impl std::fmt::Debug, other: impl std::fmt::Debug) -> Self {
        let [own, other] = [format!("{own:?}"), format!("{other:?}")].map(|text| shortened(&text, MAX_CHARACTERS));
        Self {
            what: what.into(),
            own,
            other,
        }
    }

    /// `None` if both are equal.
    pub(crate) fn of<T: PartialEq + std::fmt::Debug>(what: impl Into<String>, own: &T, other: &T) -> Option<Self> {
        (own != other).then(|| Self::new(what, own, other))
    }
}

impl Environment {
    /// Copies the states of the agent and the objects, their random numbers and the clock from another environment. This
    /// world keeps its own rewards, bodies and rules.
    ///
    /// Both worlds must have the same number of objects, with counterparts at the same index.
    pub(crate) fn copy_state_from(&mut self, other: &Self) {
        let (theirs, seconds) = (&other.state, self.world.agent_params.time_step);
        let has_same_zones = have_same_zones(&self.world, &other.world);
        let own = &mut self.state;
        let their_time_step = other.world.agent_params.time_step;
        let ticks = |theirs: u64| {
            if seconds == their_time_step {
                theirs
            } else {
                (theirs as f64 * their_time_step / seconds).round() as u64
            }
        };
        own.agent = theirs.agent;
        (own.steps, own.ticks) = (theirs.steps, ticks(theirs.ticks));
        (own.earned, own.unshaped) = (theirs.earned, theirs.unshaped);
        (own.last_reward, own.last_event, own.ended) = (theirs.last_reward, theirs.last_event, theirs.ended);
        for (index, object) in own.objects.iter_mut().enumerate() {
            let their = &theirs.objects[index];
            let is_spent = their.reward == 0.0 && other.world.objects[index].reward != 0.0;
            let reward = if is_spent {
                0.0
            } else {
                self.world.objects[index].reward
            };
            object.clone_from(their);
            object.reward = reward;
            object.open &= self.world.objects[index].door.is_some();
        }
        own.carried.clone_from(&theirs.carried);
        for door in &mut own.doors {
            if let Some(their) = theirs.door_of(door.object) {
                door.unlocked = their.unlocked;
                door.closes_at = their.closes_at.map(ticks);
            }
        }
        own.energy = theirs.energy;
        own.contacts.clone_from(&theirs.contacts);
        if has_same_zones {
            self.views.zones.resume(&other.views.zones.entered(theirs), own);
        } else {
            self.views.zones.locate(own);
        }
        own.returning.clear();
        own.returning
            .extend(theirs.returning.iter().map(|(index, tick)| (*index, ticks(*tick))));
        copy_matching(&mut own.movers, &theirs.movers, |mover| mover.object);
        copy_matching(&mut own.rngs, &theirs.rngs, |rng| rng.object);
        copy_matching(&mut own.pushed, &theirs.pushed, |body| body.object);
        own.sequence = Sequence::of(&self.world.objects);
        own.advance_sequence();
        self.views.sync_objects(&self.world, &self.state);
    }

    /// Sets an object's reward to 0.
    pub(crate) fn clear_reward(&mut self, object: usize) {
        self.state.objects[object].reward = 0.0;
    }

    /// Sets the clock to the last step before a world's step or time limit; returns whether it has one.
    pub(crate) fn advance_clock_to_limit_of(&mut self, limited: &World) -> bool {
        let Some(limit) = limited.step_limit().filter(|limit| *limit > 0) else {
            return false;
        };
        let agent = &limited.agent_params;
        let seconds = f64::from(limit - 1) * f64::from(agent.frame_skip.max(1)) * agent.time_step;
        self.state.steps = limit - 1;
        self.state.ticks = (seconds / self.world.agent_params.time_step).round() as u64;
        true
    }

    /// Whether the agent's body fits at its current position.
    pub(crate) fn agent_has_room(&self) -> bool {
        agent_obstacle(self.sim(), self.state.agent.position.map(f64::from)).is_none()
    }

    /// The body's commands for an action: in this world, and in a world with the same action space but time steps of `seconds`.
    pub(crate) fn commands(&mut self, action: Action, seconds: f64) -> Result<[Intent; 2], EnvError> {
        let numbers = self.numbers(action)?;
        let own = self.intent(numbers);
        let share = (seconds / self.world.agent_params.time_step) as f32;
        let other = if seconds == self.world.agent_params.time_step {
            own
        } else {
            Intent {
                turn_deg: own.turn_deg * share,
                ahead: own.ahead * share,
                towards: own.towards.map(|(point, reach)| (point, reach * share)),
                interact: own.interact,
            }
        };
        Ok([own, other])
    }

    /// The first difference between the states of two worlds with the same objects, ignoring rewards.
    pub(crate) fn state_difference(&self, other: &Self) -> Option<Difference> {
        let (own, their) = (&self.state, &other.state);
        let (agent, its) = (&own.agent, &their.agent);
        Difference::of("the agent's position in metres", &agent.position, &its.position)
            .or_else(|| Difference::of("the agent's heading in degrees", &agent.heading_deg, &its.heading_deg))
            .or_else(|| Difference::of("the agent's velocity in m/s", &agent.velocity, &its.velocity))
            .or_else(|| Difference::of("the elapsed time in seconds", &self.seconds(), &other.seconds()))
            .or_else(|| (0..own.objects.len()).find_map(|index| self.object_difference(other, index)))
            .or_else(|| Difference::of("the objects that the agent touches", &own.contacts, &their.contacts))
            .or_else(|| {
                // If the zones differ, being inside one follows from the agent's position instead of being part of the state.
                let [own, their] = [self, other].map(|one| one.views.zones.entered(&one.state));
                let difference = Difference::of("the zones that the agent is in", &own, &their);
                difference.filter(|_| have_same_zones(&self.world, &other.world))
            })
            .or_else(|| Difference::of("the objects that the agent carries", &own.carried, &their.carried))
            .or_else(|| Difference::of("the agent's energy", &own.energy, &their.energy))
            .or_else(|| Difference::of("the motion of pushed objects", &own.pushed, &their.pushed))
            .or_else(|| Difference::of("the times at which objects respawn", &self.returns(), &other.returns()))
    }

    /// Respawning objects: their indices, and the times in seconds at which they are due.
    fn returns(&self) -> Vec<(usize, f64)> {
        let seconds = |ticks: u64| ticks as f64 * self.world.agent_params.time_step;
        let returning = self.state.returning.iter();
        returning.map(|(index, tick)| (*index, seconds(*tick))).collect()
    }

    /// The time in seconds at which an open door closes.
    fn closes_at(&self, index: usize) -> Option<f64> {
        let ticks = self.state.door_of(index)?.closes_at?;
        Some(ticks as f64 * self.world.agent_params.time_step)
    }

    fn object_difference(&self, other: &Self, index: usize) -> Option<Difference> {
        let (own, their) = (&self.state.objects[index], &other.state.objects[index]);
        let is_ordered = |world: &World| world.objects[index].order.is_some();
        let counts = is_ordered(&self.world) || is_ordered(&other.world);
        let of = |what: &str| format!("{what} of object {index} ({})", name(&self.world, index));
        let mover_progress = |state: &SimState| entry(&state.movers, index, |mover| mover.object).map(Mover::progress);
        Difference::of(of("the presence"), &own.present, &their.present)
            .or_else(|| Difference::of(of("the open state"), &own.open, &their.open))
            .or_else(|| {
                let [own, their] = [self, other].map(|one| one.state.is_unlocked(index));
                Difference::of(of("the unlocked state"), &own, &their)
            })
            .or_else(|| {
                let [own, their] = [self, other].map(|one| one.closes_at(index));
                Difference::of(of("the closing time in seconds"), &own, &their)
            })
            .or_else(|| Difference::of(of("the position in metres"), &own.position, &their.position))
            .or_else(|| Difference::of(of("the heading in degrees"), &own.heading_deg, &their.heading_deg))
            .or_else(|| {
                let collected = Difference::of(of("the collected state"), &own.collected, &their.collected);
                collected.filter(|_| counts)
            })
            .or_else(|| {
                let (own, their) = (mover_progress(&self.state)?, mover_progress(&other.state)?);
                Difference::of(of("the next goal"), &own, &their)
            })
    }
}

/// Copies the other list's entries for the same objects; both lists are sorted by object.
fn copy_matching<T: Clone>(own: &mut [T], theirs: &[T], object: impl Fn(&T) -> usize) {
    for one in own {
        if let Ok(place) = theirs.binary_search_by_key(&object(one), &object) {
            one.clone_from(&theirs[place]);
        }
    }
}

/// Whether two worlds have the same zones, in the same order.
fn have_same_zones(a: &World, b: &World) -> bool {
    let [own, other] = [a, b].map(|world| &world.environment_params.zones);
    let is_same = |(own, other): (&Zone, &Zone)| own.disc == other.disc && own.polygon == other.polygon;
    own.len() == other.len() && own.iter().zip(other).all(is_same)
}

/// An object's name in messages: its tag, otherwise its class.
fn name(world: &World, index: usize) -> &str {
    let object = &world.objects[index];
    object.tag.as_deref().unwrap_or(&object.class)
}
