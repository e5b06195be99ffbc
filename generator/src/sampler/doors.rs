//! Puts doors into the doorways of rooms, and places their keys, as plain objects of the sampled world.

use std::collections::BTreeSet;

use driftworld_spec::{Color, Door, Layout, Object, Plan, Portable, RoomDoors, WorldDraft};

use super::Sampler;
use super::groups::Draft;
use crate::GeneratorError;
use crate::clearance::FreeSpace;
use crate::stream::Rng;

/// The tag of every door.
const DOOR: &str = "door";

/// The colours of locked doors, all clearly different. If there are more doors than colours, doors share colours, and a key
/// opens every door of its colour.
const COLORS: [&str; 8] = ["red", "blue", "yellow", "lime", "magenta", "cyan", "orange", "white"];

/// Minimum distance of a key from walls, in metres; smaller in small cells.
const WALL_DISTANCE: f64 = 0.4;

/// Minimum distance of a key from objects and the agent, in metres; smaller in small cells.
const OBJECT_DISTANCE: f64 = 0.8;

/// Number of cells to try at random before going through them one by one.
const RANDOM_TRIES: usize = 32;

/// Number of positions to try in a cell, the centre first.
const TRIES_IN_CELL: usize = 8;

impl Sampler {
    /// One door per doorway of the layout's rooms, in the order of the doorways; no doors if the layout has none.
    pub(super) fn doors(&self, world: &WorldDraft, free_space: &FreeSpace, index: u64) -> Vec<Object> {
        let kind = doors_of(world);
        let Some(plan) = free_space.plan.as_deref().filter(|_| kind != RoomDoors::None) else {
            return Vec::new();
        };
        let colors = colors(&mut self.doors.at(index, 0, 0));
        let door = |(number, doorway): (usize, &driftworld_spec::Doorway)| {
            let name = colors[number % colors.len()];
            let is_keyed = kind == RoomDoors::Keyed;
            Object {
                heading: doorway.heading,
                // The model is 1 m wide.
                scale: doorway.width,
                color: if is_keyed { Color::from_name(name) } else { None },
                tag: Some(DOOR.to_owned()),
                door: Some(Door {
                    key: is_keyed.then(|| format!("{name}_key")),
                    open: kind == RoomDoors::Open,
                    ..Door::default()
                }),
                ..Object::new("door", doorway.center)
            }
        };
        plan.doorways.iter().enumerate().map(door).collect()
    }

    /// The keys of `doors`, as returned by [`Sampler::doors`]. No key lies behind its own door: from the agent's start, all
    /// doors can be opened one after another.
    pub(super) fn keys(&self, doors: &[Object], draft: &mut Draft) -> Result<Vec<Object>, GeneratorError> {
        let locked = |door: &Object| door.door.as_ref().and_then(|door| door.key.clone());
        let plan = draft
            .context
            .plan()
            .filter(|_| doors.iter().any(|door| locked(door).is_some()));
        let Some(plan) = plan else {
            return Ok(Vec::new());
        };
        let start = plan.cell_at(draft.world.agent_params.coordinates).unwrap_or(0);
        let order = Order::random(plan, start, &mut self.doors.at(draft.index, 1, 0));
        let mut keys = Vec::with_capacity(doors.len());
        for (number, reached) in order.doors {
            let door = &doors[number];
            let mut rng = self.doors.at(draft.index, 2 + number as u64, 0);
            let free = &order.cells[..reached];
            let coordinates = free_place(plan, free, draft, &mut rng).ok_or_else(|| GeneratorError::NoPlace {
                world: self.id(draft.index),
                group: "keys of the layout's doors".to_owned(),
                object: keys.len() as u32 + 1,
                count: doors.len() as u32,
                tries: (free.len() * TRIES_IN_CELL) as u32,
                reason: format!(
                    "all {} cells that can be reached before its door is opened are taken; lower the counts of groups, or make \
                     the rooms larger",
                    free.len()
                ),
            })?;
            draft.context.occupy(coordinates);
            keys.push(Object {
                color: door.color,
                // Keys never block a path.
                solid: false,
                tag: locked(door),
                portable: Some(Portable::default()),
                ..Object::new("key", coordinates)
            });
        }
        Ok(keys)
    }
}

/// The kind of doors in a world's rooms.
fn doors_of(world: &WorldDraft) -> RoomDoors {
    let layout: Option<&Layout> = world.environment_params.layout.as_ref();
    let rooms = layout.and_then(|layout| layout.rooms.as_ref());
    rooms.map_or(RoomDoors::None, |rooms| rooms.doors)
}

/// Whether a body of this radius in metres stands in a doorway that has a door.
pub(super) fn stands_in_door(world: &WorldDraft, free_space: &FreeSpace, [x, y]: [f64; 2], radius: f64) -> bool {
    let plan = free_space
        .plan
        .as_deref()
        .filter(|_| doors_of(world) != RoomDoors::None);
    plan.into_iter().flat_map(|plan| &plan.doorways).any(|doorway| {
        let [across, along] = if doorway.heading == 0.0 { [0, 1] } else { [1, 0] };
        let offset = [(x - doorway.center[0]).abs(), (y - doorway.center[1]).abs()];
        offset[across] < doorway.width / 2.0 && offset[along] < doorway.depth / 2.0 + radius
    })
}

fn colors(rng: &mut Rng) -> [&'static str; COLORS.len()] {
    let mut colors = COLORS;
    for last in (1..colors.len()).rev() {
        colors.swap(last, rng.below(last + 1));
    }
    colors
}

/// An order in which all doors can be opened.
struct Order {
    /// The cells, in the order in which they are reached.
    cells: Vec<usize>,
    /// The doors by index, each with the number of cells reached before it is opened.
    doors: Vec<(usize, usize)>,
}

impl Order {
    fn random(plan: &Plan, start: usize, rng: &mut Rng) -> Self {
        // The cells on both sides of each doorway, which is in the middle of their common side.
        let sides: Vec<[Option<usize>; 2]> = plan
            .doorways
            .iter()
            .map(|doorway| {
                let axis = usize::from(doorway.heading == 0.0);
                [-0.5, 0.5].map(|share| {
                    let mut at = doorway.center;
                    at[axis] += share * plan.cell[axis];
                    plan.cell_at(at)
                })
            })
            .collect();
        let shut: BTreeSet<[Option<usize>; 2]> = sides.iter().flat_map(|[a, b]| [[*a, *b], [*b, *a]]).collect();
        let mut doors_of_cell: Vec<Vec<usize>> = vec![Vec::new(); plan.cells.len()];
        for (number, cells) in sides.iter().enumerate() {
            cells
                .iter()
                .flatten()
                .for_each(|cell| doors_of_cell[*cell].push(number));
        }
        let mut is_reached = vec![false; plan.cells.len()];
        let (mut cells, mut near, mut doors) = (Vec::new(), Vec::new(), Vec::new());
        let mut is_done = vec![false; sides.len()];
        let mut reach = |first: usize, cells: &mut Vec<usize>, near: &mut Vec<usize>| {
            if std::mem::replace(&mut is_reached[first], true) {
                return;
            }
            let mut next = cells.len();
            cells.push(first);
            while let Some(&cell) = cells.get(next) {
                next += 1;
                near.extend(&doors_of_cell[cell]);
                for other in plan.neighbours(cell) {
                    if !shut.contains(&[Some(cell), Some(other)]) && !std::mem::replace(&mut is_reached[other], true) {
                        cells.push(other);
                    }
                }
            }
        };
        reach(start, &mut cells, &mut near);
        while !near.is_empty() {
            let door = near.swap_remove(rng.below(near.len()));
            if std::mem::replace(&mut is_done[door], true) {
                continue;
            }
            doors.push((door, cells.len()));
            for side in sides[door].into_iter().flatten() {
                reach(side, &mut cells, &mut near);
            }
        }
        Self { cells, doors }
    }
}

/// A position in one of these cells that is clear of walls, objects and the agent: tries cells at random, then all in turn.
fn free_place(plan: &Plan, cells: &[usize], draft: &Draft, rng: &mut Rng) -> Option<[f64; 2]> {
    let side = plan.cell[0].min(plan.cell[1]);
    let (walls, others) = (WALL_DISTANCE.min(side / 4.0), OBJECT_DISTANCE.min(side / 2.0));
    let mut first = 0;
    (0..RANDOM_TRIES + cells.len()).find_map(|turn| {
        if turn < RANDOM_TRIES {
            first = rng.below(cells.len());
        }
        let cell = cells[(first + turn.saturating_sub(RANDOM_TRIES - 1)) % cells.len()];
        let middle = plan.cells[cell].center;
        (0..TRIES_IN_CELL).find_map(|number| {
            let mut jittered = |axis: usize| {
                let share = if number == 0 { 0.0 } else { rng.unit() - 0.5 };
                middle[axis] + share * plan.cell[axis]
            };
            let place = [jittered(0), jittered(1)];
            draft.context.is_clear(place, walls, others).then_some(place)
        })
    })
}
