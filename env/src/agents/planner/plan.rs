//! [`Plan`] chooses the next subgoal: which door to open, and which key or switch comes first. `subgoal.rs` carries it out.
//! `spending.rs` chooses the doors on which to spend single-use keys.

use driftworld_spec::{Object, SwitchAction, Zone};

use super::floor::{Floor, Room};
use super::goals::{Goal, can_interact, goal_at, usable_stimulus};
use super::subgoal::{Act, Subgoal};
use crate::sim::SimRef;

/// How a closed door can be opened.
#[derive(Clone, Copy, Debug, PartialEq)]
enum Means {
    /// By its own stimuli.
    Hand,
    /// By its own stimuli, after fetching this key.
    Key(u32),
    /// By setting off this switch.
    Switch(u32),
    /// By waiting for its clock.
    Clock,
    /// By achieving this goal, whose turn comes first in the sequence.
    After(Goal<'static>),
}

/// Opening a door; doors that must be passed first have earlier steps.
#[derive(Clone, Copy, Debug)]
pub(super) struct DoorStep {
    pub(super) door: u32,
    /// The room from which it is opened.
    from: Room,
    means: Means,
    /// The key that is used up by opening it.
    pub(super) spends: Option<u32>,
}

/// The rooms that the agent can reach, door by door.
#[derive(Clone)]
pub(super) struct Plan<'a> {
    pub(super) sim: SimRef<'a>,
    floor: &'a Floor,
    here: Room,
    /// For each other reachable room, the index of the step that opens the door to it.
    entered: Vec<(Room, usize)>,
    pub(super) steps: Vec<DoorStep>,
}

impl<'a> Plan<'a> {
    /// Opens every door that uses up no key, then spends keys to serve these goals.
    pub(super) fn new(sim: SimRef<'a>, floor: &'a Floor, goals: &[Vec<Goal>; 3]) -> Option<Self> {
        let here = floor.room_at(sim.agent().position)?;
        let mut plan = Self {
            sim,
            floor,
            here,
            entered: Vec::new(),
            steps: Vec::new(),
        };
        plan.open_free_doors();
        Some(plan.with_keys_spent(goals))
    }

    /// Opens all doors that use up no key, in rounds: each round uses only what earlier rounds reached.
    pub(super) fn open_free_doors(&mut self) {
        loop {
            let found = self.openable_doors();
            let free: Vec<DoorStep> = found.into_iter().filter(|step| step.spends.is_none()).collect();
            if free.is_empty() {
                return;
            }
            for step in free {
                self.add_door(step);
            }
        }
    }

    /// The doors that can be opened next, in ascending order of object.
    pub(super) fn openable_doors(&self) -> Vec<DoorStep> {
        let doors = self.floor.doors.iter();
        doors
            .filter_map(|door| self.step_through(door.object, door.rooms))
            .collect()
    }

    /// Adds a step that opens a door.
    pub(super) fn add_door(&mut self, step: DoorStep) {
        let number = self.steps.len();
        self.steps.push(step);
        let mut doors = self.floor.doors.iter();
        let rooms = doors
            .find(|door| door.object == step.door)
            .map_or([None; 2], |door| door.rooms);
        for room in rooms.into_iter().flatten() {
            if !self.can_reach(room) {
                self.entered.push((room, number));
            }
        }
    }

    fn can_reach(&self, room: Room) -> bool {
        room == self.here || self.entered.iter().any(|(other, _)| *other == room)
    }

    fn can_reach_object(&self, object: u32) -> bool {
        self.floor
            .room_of(self.sim, object)
            .is_some_and(|room| self.can_reach(room))
    }

    /// The step that opens a door with what is reachable; `None` if there is none or the plan has it already.
    fn step_through(&self, door: u32, rooms: [Option<Room>; 2]) -> Option<DoorStep> {
        if self.steps.iter().any(|step| step.door == door) {
            return None;
        }
        let from = rooms.into_iter().flatten().find(|room| self.can_reach(*room))?;
        let (means, spends) = self.means(door)?;
        Some(DoorStep {
            door,
            from,
            means,
            spends,
        })
    }

    /// How to open a door, and the key that this uses up, if any; prefers means that use up none.
    fn means(&self, door: u32) -> Option<(Means, Option<u32>)> {
        let by_hand = self.by_hand(door);
        match by_hand {
            Some((_, None)) => by_hand,
            _ => self.without_key(door).map(|means| (means, None)).or(by_hand),
        }
    }

    /// How to open a door by its own stimuli, with a key if it needs one.
    fn by_hand(&self, door: u32) -> Option<(Means, Option<u32>)> {
        let SimRef { world, state, .. } = self.sim;
        let object = &world.objects[door as usize];
        let own = object.door.as_ref()?;
        if !state.is_due(object.order) || usable_stimulus(world, door, &own.opens_on).is_none() {
            return None;
        }
        let Some(tag) = own.key.as_ref().filter(|_| !state.is_unlocked(door as usize)) else {
            return Some((Means::Hand, None));
        };
        let has_tag = |index: &u32| world.objects[*index as usize].tag.as_ref() == Some(tag) && !self.is_spent(*index);
        let spent = |key: u32| {
            let thing = world.objects[key as usize].portable.as_ref();
            thing.is_some_and(|thing| thing.consumed).then_some(key)
        };
        if let Some(key) = state.carried().iter().copied().find(has_tag) {
            return Some((Means::Hand, spent(key)));
        }
        let keys = (0..world.objects.len() as u32).filter(has_tag);
        let key = keys
            .filter(|key| self.can_pick_up(*key))
            .min_by_key(|key| spent(*key))?;
        Some((Means::Key(key), spent(key)))
    }

    fn is_spent(&self, key: u32) -> bool {
        self.steps.iter().any(|step| step.spends == Some(key))
    }

    /// How to open a door without a key: by a switch, by its clock, or later in the sequence.
    fn without_key(&self, door: u32) -> Option<Means> {
        let SimRef { world, state, .. } = self.sim;
        let object = &world.objects[door as usize];
        let own = object.door.as_ref()?;
        let opens = |index: &u32| {
            let candidate = &world.objects[*index as usize];
            candidate.switch.as_ref().is_some_and(|switch| {
                let moves = Some(&switch.target) == object.tag.as_ref() && switch.action != SwitchAction::Close;
                let is_there = self.sim.objects()[*index as usize].present && state.is_due(candidate.order);
                moves && is_there && usable_stimulus(world, *index, &switch.on).is_some()
            })
        };
        let mut switches = (0..world.objects.len() as u32).filter(opens);
        if let Some(switch) = switches.find(|switch| self.can_reach_object(*switch)) {
            return Some(Means::Switch(switch));
        }
        if own.period.is_some() {
            return Some(Means::Clock);
        }
        self.next_in_turn(door).map(Means::After)
    }

    /// The achievable goal whose turn it is in the sequence, if the door, its key or its switch must wait for its own turn.
    fn next_in_turn(&self, door: u32) -> Option<Goal<'static>> {
        let SimRef { world, state, .. } = self.sim;
        let object = &world.objects[door as usize];
        let key = object.door.as_ref().and_then(|own| own.key.as_ref());
        let waits = |other: &Object| {
            let moves = other
                .switch
                .as_ref()
                .is_some_and(|switch| Some(&switch.target) == object.tag.as_ref());
            !state.is_due(other.order) && (moves || key.is_some() && other.tag.as_ref() == key)
        };
        if state.is_due(object.order) && !world.objects.iter().any(waits) {
            return None;
        }
        let is_next = |index: &u32| {
            let (object, own) = (&world.objects[*index as usize], &self.sim.objects()[*index as usize]);
            object.order.is_some() && state.is_due(object.order) && own.present && !own.collected
        };
        let next = (0..world.objects.len() as u32).filter(is_next);
        let mut goals = next.map(|index| {
            if world.objects[index as usize].is_used() {
                Goal::Activate(index)
            } else {
                goal_at(self.sim, index)
            }
        });
        goals.find(|goal| self.first(*goal).is_some())
    }

    /// Whether a thing is reachable and can be picked up.
    fn can_pick_up(&self, index: u32) -> bool {
        let SimRef { world, state, .. } = self.sim;
        let object = &world.objects[index as usize];
        let Some(portable) = &object.portable else { return false };
        self.sim.objects()[index as usize].present
            && world.agent_params.carry_limit > 0
            && state.is_due(object.order)
            && usable_stimulus(world, index, &portable.on).is_some()
            && self.can_reach_object(index)
    }

    /// Number of doors on the way to an object; `None` if it cannot be reached.
    pub(super) fn num_doors_to(&self, object: u32) -> Option<usize> {
        let room = self.floor.room_of(self.sim, object)?;
        let mut doors = 0;
        let mut current = room;
        while current != self.here {
            let (_, number) = self.entered.iter().find(|(other, _)| *other == current)?;
            current = self.steps[*number].from;
            doors += 1;
        }
        Some(doors)
    }

    /// The first subgoal of a goal; `None` if it cannot be reached.
    pub(super) fn first(&self, goal: Goal) -> Option<Subgoal> {
        match goal {
            Goal::Touch(object) => self.subgoal_at(object, Act::Touch),
            Goal::Use(object) => self.subgoal_at(object, Act::Use),
            Goal::Activate(object) => self.subgoal_to_activate(object),
            Goal::Bring { thing, tag } => {
                if !self.sim.state.carried().contains(&thing) {
                    return self.subgoal_to_pick_up(thing);
                }
                let world = self.sim.world;
                let objects = 0..world.objects.len() as u32;
                let mut recipients = objects.filter(|index| {
                    let is_there = self.sim.objects()[*index as usize].present;
                    is_there
                        && world.objects[*index as usize].tag.as_deref() == Some(tag)
                        && self.can_reach_object(*index)
                });
                self.subgoal_at(recipients.next()?, Act::Bring { thing })
            }
        }
    }

    /// The first subgoal on the way into a zone; `None` if the zone cannot be reached.
    pub(super) fn subgoal_to_enter(&self, index: usize, zone: &Zone) -> Option<Subgoal> {
        let rooms = self.floor.cells_in(zone).into_iter();
        let mut rooms: Vec<Room> = rooms.map(|cell| self.floor.room[cell as usize]).collect();
        rooms.sort_by_key(|room| (*room != self.here, *room));
        let room = rooms.into_iter().find(|room| self.can_reach(*room))?;
        let subgoal = Subgoal {
            object: index as u32,
            room,
            act: Act::Enter,
        };
        self.subgoal_in_room(room, subgoal)
    }

    /// The subgoal of an act at an object, or the one that comes before it.
    fn subgoal_at(&self, object: u32, act: Act) -> Option<Subgoal> {
        let room = self.floor.room_of(self.sim, object)?;
        self.subgoal_in_room(room, Subgoal { object, room, act })
    }

    /// A subgoal in a room, or the one that comes before it. Terminates, because each door is opened only with what was reached
    /// before it.
    fn subgoal_in_room(&self, room: Room, subgoal: Subgoal) -> Option<Subgoal> {
        if room == self.here {
            return Some(subgoal);
        }
        let (_, number) = self.entered.iter().find(|(other, _)| *other == room)?;
        self.subgoal_to_open(self.steps[*number])
    }

    fn subgoal_to_open(&self, step: DoorStep) -> Option<Subgoal> {
        let at_door = |act| {
            self.subgoal_in_room(
                step.from,
                Subgoal {
                    object: step.door,
                    room: step.from,
                    act,
                },
            )
        };
        match step.means {
            Means::Hand => at_door(Act::Activate),
            Means::Clock => at_door(Act::Wait),
            Means::Key(key) => match self.locked_before(step) {
                Some(earlier) => self.subgoal_to_open(earlier),
                None => self.subgoal_to_pick_up(key),
            },
            Means::Switch(switch) => self.subgoal_at(switch, Act::Activate),
            Means::After(goal) => self.first(goal),
        }
    }

    /// The first locked door on the way to a door, if the latter's key would fill the agent's hands. Without this rule, the
    /// agent would swap the two keys forever. Terminates, because an unlocked door stays unlocked.
    fn locked_before(&self, step: DoorStep) -> Option<DoorStep> {
        let hands = self.sim.world.agent_params.carry_limit as usize;
        if self.sim.state.carried().len() + 1 < hands {
            return None;
        }
        let (mut first, mut room) = (None, step.from);
        while room != self.here {
            let (_, number) = self.entered.iter().find(|(other, _)| *other == room)?;
            let earlier = self.steps[*number];
            let door = earlier.door as usize;
            let has_key = self.sim.world.objects[door]
                .door
                .as_ref()
                .is_some_and(|door| door.key.is_some());
            if has_key && matches!(earlier.means, Means::Hand | Means::Key(_)) && !self.sim.state.is_unlocked(door) {
                first = Some(earlier);
            }
            room = earlier.from;
        }
        first
    }

    /// The first subgoal for opening a door, setting off a switch or picking up a thing.
    fn subgoal_to_activate(&self, object: u32) -> Option<Subgoal> {
        let parts = &self.sim.world.objects[object as usize];
        if parts.door.is_some() && !self.sim.objects()[object as usize].open {
            let step = self.steps.iter().find(|step| step.door == object)?;
            return self.subgoal_to_open(*step);
        }
        if parts.portable.is_some() && parts.switch.is_none() {
            return self.subgoal_to_pick_up(object);
        }
        self.subgoal_at(object, Act::Activate)
    }

    fn subgoal_to_pick_up(&self, thing: u32) -> Option<Subgoal> {
        if !self.can_pick_up(thing) {
            return None;
        }
        let subgoal = self.subgoal_at(thing, Act::Activate)?;
        let hands_are_full = self.sim.state.carried().len() >= self.sim.world.agent_params.carry_limit as usize;
        // Drops the held thing only on reaching the new one, because it may be needed on the way.
        let hands_can_be_emptied = !hands_are_full || can_interact(self.sim.world);
        hands_can_be_emptied.then_some(subgoal)
    }
}
