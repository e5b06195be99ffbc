//! [`Floor`]: the cells where the agent's centre can be, divided into rooms by closed doors. `flood.rs` and `ways.rs` find paths.

use driftworld_spec::{MotionModel, Object, World, Zone};

use super::flood::{DIAGONAL, STRAIGHT};
use super::ground_shape::GroundShape;
use super::zone_costs::{COSTS, ZoneCosts, costs_of_time};
use crate::agents::grid::Grid;
use crate::agents::steering::fails;
use crate::ground;
use crate::polygon::is_near_or_inside;
use crate::sim::SimRef;

/// Side of a cell in metres where there are doors, things or plain walls; where something costs or fails; and elsewhere. Larger
/// where the arena is too large for it.
const SIDE: f32 = 0.2;
const SIDE_BESIDE_COSTS: f32 = 0.25;
const OPEN_SIDE: f32 = 0.4;

/// Minimum and preferred distance of the agent's body from walls, in metres.
const MIN_CLEARANCE: f32 = 0.04;
const PREFERRED_CLEARANCE: f32 = 0.25;

/// Clearance from closed doors, from obstacles, and from objects that fail the episode when touched, in metres. The last exceeds
/// the distance that `shield.rs` keeps from them.
const DOOR_CLEARANCE: f32 = 0.02;
const OBSTACLE_CLEARANCE: f32 = 0.15;
const FAILURE_CLEARANCE: f32 = 0.15;

/// Weights of cells: closed, open ground, near walls, near obstacles, under obstacles. Near objects that cost: `COSTS`.
const CLOSED: u16 = 0;
const OPEN: u16 = 1;
pub(super) const BESIDE: u16 = 2;
pub(super) const BESIDE_OBSTACLE: u16 = 6;
const OBSTACLE: u16 = 40;

/// Maximum distance beyond contact, in metres, at which a position still counts as beside an object.
const NEAR: f32 = 0.3;

/// The number of a room.
pub(super) type Room = u32;
/// The room of closed cells.
const NO_ROOM: Room = 0;

/// An object that affects paths.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(super) struct FloorObject {
    object: u32,
    pub(super) shape: GroundShape,
    /// Whether it is a closed door, which divides rooms.
    is_door: bool,
    weight: u16,
}

/// A closed door and the rooms on its two sides.
#[derive(Clone, Debug)]
pub(super) struct ClosedDoor {
    pub(super) object: u32,
    pub(super) rooms: [Option<Room>; 2],
}

/// The current ground of a world, derived from the world and the positions of its objects.
#[derive(Clone, Debug, Default)]
pub(super) struct Floor {
    pub(super) grid: Grid,
    arena_size: [f32; 2],
    costs_of_time: [f64; 2],
    /// The highest cost of a step.
    pub(super) max_cost: u32,
    pub(super) body: f32,
    regions: Vec<Vec<[f64; 2]>>,
    zones: Vec<Zone>,
    /// The weight of each cell from walls and zones alone; 0 where it is closed.
    pub(super) bare: Vec<u16>,
    /// The weight of each cell, objects included.
    pub(super) weight: Vec<u16>,
    /// Costs of entering zones, and which cells are in zones that cost.
    pub(super) zone_costs: ZoneCosts,
    pub(super) room: Vec<Room>,
    pub(super) objects: Vec<FloorObject>,
    pub(super) doors: Vec<ClosedDoor>,
    /// Counts changes, so that plans can tell whether they are out of date.
    pub(super) version: u64,
}

impl Floor {
    /// Ground with these weights, and nothing on it.
    #[cfg(test)]
    pub(super) fn of(grid: Grid, weight: Vec<u16>) -> Self {
        let max_cost = DIAGONAL * weight.iter().copied().max().map_or(0, u32::from);
        Self {
            grid,
            max_cost,
            weight,
            ..Self::default()
        }
    }

    /// The cost of spreading from a cell to its neighbour at this offset, where a step on open ground costs `open`; `None` if no
    /// step leads from there. Floods spread against the walk, or outward with it.
    pub(super) fn cost(&self, from: usize, step: isize, open: u32, is_outward: bool) -> Option<u32> {
        let other = from.wrapping_add_signed(step);
        let weight = u32::from(self.weight[other]);
        let is_walked = weight > 0 && (open == STRAIGHT || self.is_corner_open(from, step));
        let [start, end] = if is_outward { [from, other] } else { [other, from] };
        is_walked.then(|| open * weight + self.zone_costs.of(start, end))
    }

    /// Updates the floor to the current positions of objects. Pushable objects are obstacles only if paths should lead around
    /// them.
    pub(super) fn update(&mut self, sim: SimRef, around_pushable: bool) {
        let has_moved = self.refresh_walls(sim.world, sim.scene().arena_size());
        let objects = floor_objects(sim, around_pushable);
        if !has_moved && objects == self.objects && self.version > 0 {
            return;
        }
        self.objects = objects;
        self.version += 1;
        self.weight.clone_from(&self.bare);
        for number in 0..self.objects.len() {
            let FloorObject {
                shape, is_door, weight, ..
            } = self.objects[number];
            let clearance = match weight {
                _ if is_door => DOOR_CLEARANCE,
                CLOSED => FAILURE_CLEARANCE,
                _ => OBSTACLE_CLEARANCE,
            };
            let margin = self.body + clearance;
            let at = shape.at;
            let reach = shape.reach() + margin;
            for cell in self.grid.near(at, reach) {
                if shape.distance(self.grid.centre(cell)) < margin && self.weight[cell] > 0 {
                    self.weight[cell] = match weight {
                        CLOSED => CLOSED,
                        BESIDE_OBSTACLE if shape.distance(self.grid.centre(cell)) < self.body => {
                            self.weight[cell].max(OBSTACLE)
                        }
                        weight => self.weight[cell].max(weight),
                    };
                }
            }
        }
        let max_weight = self.weight.iter().copied().max().unwrap_or(OPEN);
        self.max_cost = DIAGONAL * u32::from(max_weight) + self.zone_costs.max_entry();
        self.number_rooms();
        self.doors = self
            .objects
            .iter()
            .filter(|object| object.is_door)
            .map(|object| ClosedDoor {
                object: object.object,
                rooms: [-1.0, 1.0].map(|side| self.room_beside(&object.shape, Some(side))),
            })
            .collect();
    }

    /// Rebuilds the grid if walls or zones have changed, and returns whether they have.
    fn refresh_walls(&mut self, world: &World, arena_size: [f32; 2]) -> bool {
        let body = world.agent_params.agent_width as f32 / 2.0;
        let regions = || world.obstacles();
        let costs_of_time = costs_of_time(world);
        let is_same = !self.bare.is_empty()
            && (self.arena_size, self.body, self.costs_of_time) == (arena_size, body, costs_of_time);
        let zones = &world.environment_params.zones;
        let [low, high] = region(world, arena_size);
        let grid = Grid::over(low, high, side(world, [low, high], body));
        if is_same && self.grid == grid && self.zones == *zones && self.regions.iter().map(Vec::as_slice).eq(regions())
        {
            return false;
        }
        self.grid = grid;
        // An agent in a corner of its cell is nearer to walls than its centre.
        let min_clearance = MIN_CLEARANCE.max(0.3 * self.grid.side() - 0.02);
        (self.arena_size, self.body, self.costs_of_time) = (arena_size, body, costs_of_time);
        self.bare.clear();
        self.bare.resize(self.grid.num_cells(), 0);
        let half = arena_size.map(|metres| metres / 2.0);
        for cell in self.grid.within(half.map(|metres| -metres), half) {
            let at = self.grid.centre(cell);
            let room = (0..2)
                .map(|axis| half[axis] - at[axis].abs())
                .fold(f32::INFINITY, f32::min);
            self.bare[cell] = weight_for(room - body, min_clearance);
        }
        for corners in regions() {
            let near = self.grid.near_polygon(corners, body + PREFERRED_CLEARANCE);
            let corners = corners.iter().map(|corner| corner.map(|metres| metres as f32));
            for cell in near {
                let at = self.grid.centre(cell);
                if self.bare[cell] > 0 && is_near_or_inside(corners.clone(), at, body + min_clearance) {
                    self.bare[cell] = CLOSED;
                } else if self.bare[cell] == OPEN && is_near_or_inside(corners.clone(), at, body + PREFERRED_CLEARANCE)
                {
                    self.bare[cell] = BESIDE;
                }
            }
        }
        self.regions = regions().map(<[[f64; 2]]>::to_vec).collect();
        self.zones.clone_from(zones);
        self.zone_costs = ZoneCosts::new(world, self.grid, &mut self.bare);
        true
    }

    /// Whether a round body at a position fits between the walls.
    pub(super) fn is_off_walls(&self, at: [f32; 2], radius: f32) -> bool {
        let is_inside = (0..2).all(|axis| at[axis].abs() + radius <= self.arena_size[axis] / 2.0);
        // The centre of an open cell is at least the body's radius from walls.
        if !is_inside || radius + self.grid.side() <= self.body && self.bare[self.grid.cell_at(at)] > 0 {
            return is_inside;
        }
        let is_near = |corners: &Vec<[f64; 2]>| {
            let corners = corners.iter().map(|corner| corner.map(|metres| metres as f32));
            is_near_or_inside(corners, at, radius)
        };
        !self.regions.iter().any(is_near)
    }

    /// Whether a diagonal step cuts no corner.
    pub(super) fn is_corner_open(&self, cell: usize, step: isize) -> bool {
        let row = self.grid.stride() as isize * step.signum();
        let column = step - row;
        self.weight[cell.wrapping_add_signed(row)] > 0 && self.weight[cell.wrapping_add_signed(column)] > 0
    }

    fn number_rooms(&mut self) {
        self.room.clear();
        self.room.resize(self.weight.len(), NO_ROOM);
        let stride = self.grid.stride();
        let mut queue = Vec::new();
        let mut number = NO_ROOM;
        for start in 0..self.weight.len() {
            if self.weight[start] == 0 || self.room[start] != NO_ROOM {
                continue;
            }
            number += 1;
            self.room[start] = number;
            queue.push(start);
            while let Some(cell) = queue.pop() {
                for other in [cell - 1, cell + 1, cell - stride, cell + stride] {
                    if self.weight[other] > 0 && self.room[other] == NO_ROOM {
                        self.room[other] = number;
                        queue.push(other);
                    }
                }
            }
        }
    }

    /// The open cell nearest to a position.
    pub(super) fn cell_near(&self, at: [f32; 2]) -> Option<usize> {
        let reach = self.body + 2.0 * self.grid.side();
        let open = self.grid.near(at, reach).filter(|cell| self.weight[*cell] > 0);
        let squared = |cell: usize| squared(self.grid.centre(cell), at);
        open.map(|cell| (cell, squared(cell)))
            .min_by(|(_, a), (_, b)| a.total_cmp(b))
            .map(|(cell, _)| cell)
    }

    /// The room of a position.
    pub(super) fn room_at(&self, at: [f32; 2]) -> Option<Room> {
        self.cell_near(at).map(|cell| self.room[cell])
    }

    /// How far beyond contact, in metres, the nearest open cell of an object may be.
    fn beside(&self) -> f32 {
        0.6_f32.max(self.grid.side())
    }

    /// The open cells in a zone that no obstacle covers; if there are none, its open cells; failing that, the one nearest to its
    /// middle.
    pub(super) fn cells_in(&self, zone: &Zone) -> Vec<u32> {
        let Some([low, high]) = zone.bounds() else {
            return Vec::new();
        };
        let [low, high] = [low, high].map(|place| place.map(|metres| metres as f32));
        let is_near = |object: &&FloorObject| {
            let (at, reach) = (object.shape.at, object.shape.reach() + self.body);
            let is_within = |axis: usize| (low[axis] - reach..=high[axis] + reach).contains(&at[axis]);
            object.weight == BESIDE_OBSTACLE && is_within(0) && is_within(1)
        };
        let near: Vec<&FloorObject> = self.objects.iter().filter(is_near).collect();
        let is_in = |cell: &usize| self.weight[*cell] > 0 && zone.contains(self.grid.centre(*cell).map(f64::from));
        let cells = self.grid.within(low, high).filter(is_in);
        let cells: Vec<u32> = cells.map(|cell| cell as u32).collect();
        if cells.is_empty() {
            // It is smaller than a cell, or lies along a wall.
            let middle = ground::middle(zone).map(|at| at.map(|metres| metres as f32));
            let nearest = middle.and_then(|at| self.cell_near(at));
            return nearest.map(|cell| cell as u32).into_iter().collect();
        }
        let covers =
            |object: &FloorObject, cell: u32| object.shape.distance(self.grid.centre(cell as usize)) < self.body;
        let is_free = |cell: &u32| !near.iter().any(|object| covers(object, *cell));
        let free: Vec<u32> = cells.iter().copied().filter(is_free).collect();
        if free.is_empty() { cells } else { free }
    }

    /// The room from which an object can be reached.
    pub(super) fn room_of(&self, sim: SimRef, object: u32) -> Option<Room> {
        self.room_beside(&GroundShape::of(sim, object as usize), None)
    }

    /// The room of the nearest open cell beside a body, on the given side of it, if any.
    fn room_beside(&self, shape: &GroundShape, side: Option<f32>) -> Option<Room> {
        let reach = shape.reach() + self.body + self.beside();
        let cells = self.grid.near(shape.at, reach);
        let is_beside = |cell: &usize| {
            let [along, across] = shape.own_axes(self.grid.centre(*cell));
            self.weight[*cell] > 0
                && side.is_none_or(|side| across * side > 0.0 && along.abs() <= shape.half[0].max(0.1))
        };
        let near = cells
            .filter(is_beside)
            .map(|cell| (cell, shape.distance(self.grid.centre(cell))));
        let nearest = near
            .filter(|(_, distance)| *distance < self.body + self.beside())
            .min_by(|(_, a), (_, b)| a.total_cmp(b));
        nearest.map(|(cell, _)| self.room[cell])
    }

    /// The cells of a room from which the agent can walk straight to an object.
    pub(super) fn cells_beside(&self, shape: &GroundShape, room: Room) -> Vec<u32> {
        let reach = shape.reach() + self.body + self.beside();
        let cells = self.grid.near(shape.at, reach);
        let in_room: Vec<(usize, f32)> = cells
            .filter(|cell| self.weight[*cell] > 0 && self.room[*cell] == room)
            .filter(|cell| {
                shape.own_axes(self.grid.centre(*cell))[0].abs() <= shape.half[0] * 0.5 + 0.3 || !shape.is_long()
            })
            .map(|cell| (cell, shape.distance(self.grid.centre(cell))))
            .collect();
        let nearest = in_room
            .iter()
            .map(|(_, distance)| *distance)
            .fold(f32::INFINITY, f32::min);
        let limit = nearest.max(self.body + NEAR) + 1e-3;
        in_room
            .into_iter()
            .filter(|(_, distance)| *distance <= limit)
            .map(|(cell, _)| cell as u32)
            .collect()
    }
}

/// Whether an object moves by itself, can be pushed, or respawns elsewhere.
pub(super) fn moves_elsewhere(object: &Object) -> bool {
    let respawns_elsewhere = object.respawn.as_ref().is_some_and(|back| back.radius > 0.0);
    object.motion_model != MotionModel::Stationary || object.pushable.is_some() || respawns_elsewhere
}

/// The part of the arena that matters: around everything in the world. All of it if something may move away.
fn region(world: &World, arena_size: [f32; 2]) -> [[f32; 2]; 2] {
    let half = arena_size.map(|metres| metres / 2.0);
    if world.plan().is_none() && world.objects.iter().any(moves_elsewhere) {
        return [half.map(|metres| -metres), half];
    }
    let margin = 3.0 + world.agent_params.agent_width as f32;
    let (mut low, mut high) = ([f64::INFINITY; 2], [f64::NEG_INFINITY; 2]);
    let mut include = |place: [f64; 2]| {
        for axis in 0..2 {
            low[axis] = low[axis].min(place[axis]);
            high[axis] = high[axis].max(place[axis]);
        }
    };
    for object in &world.objects {
        include(object.coordinates);
    }
    for corners in world.obstacles() {
        corners.iter().copied().for_each(&mut include);
    }
    for bounds in world.environment_params.zones.iter().filter_map(Zone::bounds) {
        bounds.into_iter().for_each(&mut include);
    }
    include(world.agent_params.coordinates);
    let low = [0, 1].map(|axis| (low[axis] as f32 - margin).max(-half[axis]));
    let high = [0, 1].map(|axis| (high[axis] as f32 + margin).min(half[axis]));
    [low, high]
}

/// The side of a cell in metres over a region: finer in layouts, and beside doors, things and whatever costs or fails.
fn side(world: &World, [low, high]: [[f32; 2]; 2], body: f32) -> f32 {
    let corridor = world.plan().map(|plan| plan.corridor as f32);
    let narrow = corridor.map_or(f32::INFINITY, |corridor| {
        ((corridor / 2.0 - body - 0.05).min(body / 1.45)).max(0.1)
    });
    let is_used = world.objects.iter().any(Object::is_used);
    let costs = world.environment_params.zones.iter().any(Zone::is_costly) || !world.rules.failure.is_empty();
    // Large cells would close gaps between plain walls that the agent fits through.
    let has_gaps = !world.environment_params.walls.is_empty();
    let plain = match (is_used || has_gaps, costs) {
        (true, _) => SIDE,
        (false, true) => SIDE_BESIDE_COSTS,
        (false, false) => OPEN_SIDE,
    };
    let long = (high[0] - low[0]).max(high[1] - low[1]);
    // In cells no larger than the body, no path leads through a wall, however thin.
    let plain = plain.min((2.0 * body).max(0.1));
    plain.max(long / 256.0).min(narrow.max(long / 1024.0))
}

/// The weight of a cell, given the agent's clearance from walls there.
fn weight_for(clearance: f32, min_clearance: f32) -> u16 {
    match clearance {
        clearance if clearance < min_clearance => CLOSED,
        clearance if clearance < PREFERRED_CLEARANCE => BESIDE,
        _ => OPEN,
    }
}

/// The objects that affect paths, in ascending order of index.
fn floor_objects(sim: SimRef, around_pushable: bool) -> Vec<FloorObject> {
    let objects = sim.world.objects.iter().zip(sim.objects()).enumerate();
    let floor_objects = objects.filter_map(|(index, (object, own))| {
        let is_still = object.motion_model == MotionModel::Stationary && (around_pushable || object.pushable.is_none());
        if !own.present || own.open || !is_still {
            return None;
        }
        let is_door = object.door.is_some() && object.solid;
        let weight = match (own.reward < 0.0, object.solid) {
            _ if is_door || fails(sim.world, object) => CLOSED,
            (true, _) => COSTS,
            (false, true) => BESIDE_OBSTACLE,
            (false, false) => return None,
        };
        let shape = GroundShape::of(sim, index);
        Some(FloorObject {
            object: index as u32,
            shape: if object.pushable.is_some() {
                shape.roughly()
            } else {
                shape
            },
            is_door,
            weight,
        })
    });
    floor_objects.collect()
}

pub(super) fn squared(a: [f32; 2], b: [f32; 2]) -> f32 {
    (a[0] - b[0]).powi(2) + (a[1] - b[1]).powi(2)
}
