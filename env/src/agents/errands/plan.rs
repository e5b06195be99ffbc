//! What is done first to get somewhere or to get something: which door is opened, and before it which key is fetched or which
//! switch set off. How it is done is in `deed.rs`, where it is in `floor.rs`; which doors keys are spent on that open one door
//! only, in `spending.rs`.

use driftworld_spec::{ActionModel, ActionSpace, Object, Stimulus, SwitchAction, World, Zone};

use super::deed::{Deed, Task};
use super::floor::{Floor, Room};
use super::wishes::{Wish, toward};
use crate::sim::SimRef;

/// How a closed door can be got open.
#[derive(Clone, Copy, Debug, PartialEq)]
enum Means {
    /// By its stimuli.
    Hand,
    /// By its stimuli, once this object has been fetched.
    Key(u32),
    /// By setting off this object.
    Switch(u32),
    /// By waiting for its clock.
    Clock,
    /// Once this has had its turn in the sequence.
    After(Wish<'static>),
}

/// A door that can be got open: what leads to it is known before it.
#[derive(Clone, Copy, Debug)]
pub(super) struct Way {
    pub(super) door: u32,
    /// The room from which it is opened, or passed.
    from: Room,
    means: Means,
    /// The key that is gone when it has opened the door.
    pub(super) spends: Option<u32>,
}

/// What can be reached from where the agent is, door by door.
#[derive(Clone)]
pub(super) struct Plan<'a> {
    pub(super) sim: SimRef<'a>,
    floor: &'a Floor,
    here: Room,
    /// For each room that can be got to beyond this one, the door that leads there.
    entered: Vec<(Room, usize)>,
    pub(super) ways: Vec<Way>,
}

impl<'a> Plan<'a> {
    /// What can be reached for the sake of these wishes.
    pub(super) fn new(sim: SimRef<'a>, floor: &'a Floor, wishes: &[Vec<Wish>; 3]) -> Option<Self> {
        let here = floor.room_at(sim.agent().position)?;
        let mut plan = Self {
            sim,
            floor,
            here,
            entered: Vec::new(),
            ways: Vec::new(),
        };
        plan.open_what_is_free();
        Some(plan.with_keys_spent(wishes))
    }

    /// Opens all doors for which nothing is used up, in rounds: each with what is found without it.
    pub(super) fn open_what_is_free(&mut self) {
        loop {
            let found = self.ways_through();
            let free: Vec<Way> = found.into_iter().filter(|way| way.spends.is_none()).collect();
            if free.is_empty() {
                return;
            }
            for way in free {
                self.take(way);
            }
        }
    }

    /// The doors that can be got open next, by rising object.
    pub(super) fn ways_through(&self) -> Vec<Way> {
        let doors = self.floor.doors.iter();
        doors
            .filter_map(|door| self.way_through(door.object, door.rooms))
            .collect()
    }

    /// Opens a door.
    pub(super) fn take(&mut self, way: Way) {
        let number = self.ways.len();
        self.ways.push(way);
        let mut doors = self.floor.doors.iter();
        let rooms = doors
            .find(|door| door.object == way.door)
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

    /// How a door that cannot be passed yet can be got open with what can be reached.
    fn way_through(&self, door: u32, rooms: [Option<Room>; 2]) -> Option<Way> {
        if self.ways.iter().any(|way| way.door == door) {
            return None;
        }
        let from = rooms.into_iter().flatten().find(|room| self.can_reach(*room))?;
        let (means, spends) = self.means(door)?;
        Some(Way {
            door,
            from,
            means,
            spends,
        })
    }

    /// How a door is got open, and which key is gone then: rather by what is not used up.
    fn means(&self, door: u32) -> Option<(Means, Option<u32>)> {
        let by_hand = self.by_hand(door);
        match by_hand {
            Some((_, None)) => by_hand,
            _ => self.without_key(door).map(|means| (means, None)).or(by_hand),
        }
    }

    /// How a door is opened at the door.
    fn by_hand(&self, door: u32) -> Option<(Means, Option<u32>)> {
        let SimRef { world, state, .. } = self.sim;
        let object = &world.objects[door as usize];
        let own = object.door.as_ref()?;
        if !state.is_due(object.order) || usable(world, door, &own.opens_on).is_none() {
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
        self.ways.iter().any(|way| way.spends == Some(key))
    }

    /// How a door is opened without a key: by a switch, by its clock, or later in the sequence.
    fn without_key(&self, door: u32) -> Option<Means> {
        let SimRef { world, state, .. } = self.sim;
        let object = &world.objects[door as usize];
        let own = object.door.as_ref()?;
        let opens = |index: &u32| {
            let object_of = &world.objects[*index as usize];
            object_of.switch.as_ref().is_some_and(|switch| {
                let moves = Some(&switch.target) == object.tag.as_ref() && switch.action != SwitchAction::Close;
                let is_there = self.sim.objects()[*index as usize].present && state.is_due(object_of.order);
                moves && is_there && usable(world, *index, &switch.on).is_some()
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

    /// What has its turn in the sequence now and can be done, if a door waits for its own turn, or for that of what opens it.
    fn next_in_turn(&self, door: u32) -> Option<Wish<'static>> {
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
        let mut wishes = next.map(|index| {
            if world.objects[index as usize].is_used() {
                Wish::Move(index)
            } else {
                toward(self.sim, index)
            }
        });
        wishes.find(|wish| self.first(*wish).is_some())
    }

    /// Whether a thing lies where it can be reached, and can be picked up there.
    fn can_pick_up(&self, index: u32) -> bool {
        let SimRef { world, state, .. } = self.sim;
        let object = &world.objects[index as usize];
        let Some(portable) = &object.portable else { return false };
        self.sim.objects()[index as usize].present
            && world.agent_params.carry_limit > 0
            && state.is_due(object.order)
            && usable(world, index, &portable.on).is_some()
            && self.can_reach_object(index)
    }

    /// The rooms that can be got to, and whether each takes a door.
    pub(super) fn takes_doors(&self, object: u32) -> Option<usize> {
        let room = self.floor.room_of(self.sim, object)?;
        let mut doors = 0;
        let mut now = room;
        while now != self.here {
            let (_, number) = self.entered.iter().find(|(other, _)| *other == now)?;
            now = self.ways[*number].from;
            doors += 1;
        }
        Some(doors)
    }

    /// What is done first for the sake of a wish; `None` where there is no way to it.
    pub(super) fn first(&self, wish: Wish) -> Option<Task> {
        match wish {
            Wish::Touch(object) => self.at(object, Deed::Touch),
            Wish::Use(object) => self.at(object, Deed::Use),
            Wish::Move(object) => self.moved(object),
            Wish::Bring { thing, tag } => {
                if !self.sim.state.carried().contains(&thing) {
                    return self.picked_up(thing);
                }
                let world = self.sim.world;
                let objects = 0..world.objects.len() as u32;
                let mut places = objects.filter(|index| {
                    let is_there = self.sim.objects()[*index as usize].present;
                    is_there
                        && world.objects[*index as usize].tag.as_deref() == Some(tag)
                        && self.can_reach_object(*index)
                });
                self.at(places.next()?, Deed::Bring { thing })
            }
        }
    }

    /// How a zone is entered, or what is to be done first; `None` where there is no way to it.
    pub(super) fn zone_entered(&self, index: usize, zone: &Zone) -> Option<Task> {
        let rooms = self.floor.cells_in(zone).into_iter();
        let mut rooms: Vec<Room> = rooms.map(|cell| self.floor.room[cell as usize]).collect();
        rooms.sort_by_key(|room| (*room != self.here, *room));
        let room = rooms.into_iter().find(|room| self.can_reach(*room))?;
        let task = Task {
            object: index as u32,
            room,
            deed: Deed::Enter,
        };
        self.got_to(room, task)
    }

    /// A deed at an object, or what is to be done before the agent gets there.
    fn at(&self, object: u32, deed: Deed) -> Option<Task> {
        let room = self.floor.room_of(self.sim, object)?;
        self.got_to(room, Task { object, room, deed })
    }

    /// A task in a room, or what is to be done before the agent gets there. It ends: doors are opened with what was reached
    /// before them.
    fn got_to(&self, room: Room, task: Task) -> Option<Task> {
        if room == self.here {
            return Some(task);
        }
        let (_, number) = self.entered.iter().find(|(other, _)| *other == room)?;
        self.opened(self.ways[*number])
    }

    fn opened(&self, way: Way) -> Option<Task> {
        let at_door = |deed| {
            self.got_to(
                way.from,
                Task {
                    object: way.door,
                    room: way.from,
                    deed,
                },
            )
        };
        match way.means {
            Means::Hand => at_door(Deed::Move),
            Means::Clock => at_door(Deed::Wait),
            Means::Key(key) => match self.locked_before(way) {
                Some(earlier) => self.opened(earlier),
                None => self.picked_up(key),
            },
            Means::Switch(switch) => self.at(switch, Deed::Move),
            Means::After(wish) => self.first(wish),
        }
    }

    /// The first locked door on the way to a door, if the agent has no hand left once it has the door's key: it would put
    /// the one key down for the other, and back again. Doors once unlocked stay so, so that this comes to an end.
    fn locked_before(&self, way: Way) -> Option<Way> {
        let hands = self.sim.world.agent_params.carry_limit as usize;
        if self.sim.state.carried().len() + 1 < hands {
            return None;
        }
        let (mut first, mut room) = (None, way.from);
        while room != self.here {
            let (_, number) = self.entered.iter().find(|(other, _)| *other == room)?;
            let earlier = self.ways[*number];
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

    /// A door is opened, a switch set off, a thing picked up.
    fn moved(&self, object: u32) -> Option<Task> {
        let parts = &self.sim.world.objects[object as usize];
        if parts.door.is_some() && !self.sim.objects()[object as usize].open {
            let way = self.ways.iter().find(|way| way.door == object)?;
            return self.opened(*way);
        }
        if parts.portable.is_some() && parts.switch.is_none() {
            return self.picked_up(object);
        }
        self.at(object, Deed::Move)
    }

    fn picked_up(&self, thing: u32) -> Option<Task> {
        if !self.can_pick_up(thing) {
            return None;
        }
        let task = self.at(thing, Deed::Move)?;
        let hands_are_full = self.sim.state.carried().len() >= self.sim.world.agent_params.carry_limit as usize;
        // What is carried is put down where the thing is, for what is on the way to it may need it.
        let can_be_emptied = !hands_are_full || can_interact(self.sim.world);
        can_be_emptied.then_some(task)
    }
}

/// Whether the agent can interact at all.
pub(super) fn can_interact(world: &World) -> bool {
    let agent = &world.agent_params;
    let has_row = match &agent.actions {
        ActionSpace::Discrete(table) => {
            agent.action_model == ActionModel::OnRails || table.iter().any(|row| row[2] > 0.5)
        }
        _ => true,
    };
    agent.interact && agent.action_model != ActionModel::ByWaypoint && has_row
}

/// Which of some stimuli of an object the agent can bring about; an interaction if it can.
pub(super) fn usable(world: &World, object: u32, stimuli: &[Stimulus]) -> Option<Stimulus> {
    let has_range = world.objects[object as usize].range_stimulus_distance > 0.0;
    let can = |stimulus: &Stimulus| match stimulus {
        Stimulus::AgentInteract => can_interact(world),
        Stimulus::AgentCollide => true,
        Stimulus::AgentInRange => has_range,
    };
    let known = [Stimulus::AgentInteract, Stimulus::AgentCollide, Stimulus::AgentInRange];
    known
        .into_iter()
        .find(|stimulus| stimuli.contains(stimulus) && can(stimulus))
}
