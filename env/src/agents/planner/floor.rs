//! [`Floor`]: the cells that the agent's centre can be on, divided into rooms by closed doors. `ways.rs` finds paths on it.

use driftworld_spec::{MotionModel, World, Zone};

use super::leaf::Leaf;
use super::ways::{Bringing, Waiting};
use super::zone_costs::ZoneCosts;
use crate::agents::grid::Grid;
use crate::agents::steering::fails;
use crate::polygon::is_near_or_inside;
use crate::sim::SimRef;

/// Side of a cell in metres, in arenas that are not too large for it.
const SIDE: f32 = 0.2;

/// How far the agent's body must keep from walls, and prefers to keep, in metres.
const MIN_CLEARANCE: f32 = 0.04;
const PREFERRED_CLEARANCE: f32 = 0.25;

/// Clearance from closed doors, and from objects whose touch is a failure, in metres; the latter is larger than the
/// extra distance that `shield.rs` keeps from them.
const DOOR_CLEARANCE: f32 = 0.02;
const FAILURE_CLEARANCE: f32 = 0.15;

/// Weights of cells: closed, open ground, beside walls, beside obstacles, beside objects that cost.
const CLOSED: u16 = 0;
const OPEN: u16 = 1;
pub(super) const BESIDE: u16 = 2;
const BESIDE_OBSTACLE: u16 = 6;
pub(super) const COSTS: u16 = 20;

/// A place up to this far beyond touching distance, in metres, still counts as beside an object.
const NEAR: f32 = 0.3;

/// The number of a room; closed cells have none.
pub(super) type Room = u32;
const NO_ROOM: Room = 0;

/// An object that affects where paths lead.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(super) struct Standing {
    object: u32,
    pub(super) leaf: Leaf,
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

/// The ground of a world as it is now, derived from the world and from where things are.
#[derive(Clone, Debug, Default)]
pub(super) struct Floor {
    pub(super) grid: Grid,
    arena_size: [f32; 2],
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
    pub(super) standing: Vec<Standing>,
    pub(super) doors: Vec<ClosedDoor>,
    /// Counts changes, so that a plan knows whether it is out of date.
    pub(super) version: u64,
    pub(super) field: Vec<u32>,
    pub(super) open: Waiting,
    /// The version and the cells that `field` leads to.
    pub(super) leads: Option<(u64, Vec<u32>)>,
    /// Whether the checked part of the last path enters no zone that costs.
    pub(super) keeps_out: bool,
    /// The version and the delivery, if `field` leads to a place to put a thing down.
    pub(super) brings: Option<(u64, Bringing)>,
}

impl Floor {
    /// Updates the floor to where things are now.
    pub(super) fn update(&mut self, sim: SimRef) {
        let has_moved = self.refresh_walls(sim.world, sim.scene().arena_size());
        let standing = standing(sim);
        if !has_moved && standing == self.standing && self.version > 0 {
            return;
        }
        self.standing = standing;
        self.version += 1;
        self.weight.clone_from(&self.bare);
        for number in 0..self.standing.len() {
            let Standing {
                leaf, is_door, weight, ..
            } = self.standing[number];
            let away = match weight {
                _ if is_door => DOOR_CLEARANCE,
                CLOSED => FAILURE_CLEARANCE,
                _ => MIN_CLEARANCE,
            };
            let margin = self.body + away;
            let at = leaf.at;
            let reach = leaf.reach() + margin;
            for cell in self.grid.near(at, reach) {
                if leaf.distance(self.grid.centre(cell)) < margin && self.weight[cell] > 0 {
                    self.weight[cell] = match weight {
                        CLOSED => CLOSED,
                        dear => self.weight[cell].max(dear),
                    };
                }
            }
        }
        self.number_rooms();
        self.doors = self
            .standing
            .iter()
            .filter(|standing| standing.is_door)
            .map(|standing| ClosedDoor {
                object: standing.object,
                rooms: [-1.0, 1.0].map(|side| self.room_beside(&standing.leaf, Some(side))),
            })
            .collect();
    }

    /// Rebuilds the grid if walls or zones have changed; returns whether it did.
    fn refresh_walls(&mut self, world: &World, arena_size: [f32; 2]) -> bool {
        let body = world.agent_params.agent_width as f32 / 2.0;
        let regions = || world.obstacles();
        let is_same = !self.bare.is_empty() && (self.arena_size, self.body) == (arena_size, body);
        let zones = &world.environment_params.zones;
        if is_same && self.zones == *zones && self.regions.iter().map(Vec::as_slice).eq(regions()) {
            return false;
        }
        self.grid = Grid::of_side(arena_size, SIDE);
        (self.arena_size, self.body) = (arena_size, body);
        self.bare.clear();
        self.bare.resize(self.grid.num_cells(), 0);
        let half = arena_size.map(|metres| metres / 2.0);
        for cell in self.grid.within(half.map(|metres| -metres), half) {
            let at = self.grid.centre(cell);
            let room = (0..2)
                .map(|axis| half[axis] - at[axis].abs())
                .fold(f32::INFINITY, f32::min);
            self.bare[cell] = by_room(room - body);
        }
        for corners in regions() {
            let near = self.grid.near_polygon(corners, body + PREFERRED_CLEARANCE);
            let corners = corners.iter().map(|corner| corner.map(|metres| metres as f32));
            for cell in near {
                let at = self.grid.centre(cell);
                if self.bare[cell] > 0 && is_near_or_inside(corners.clone(), at, body + MIN_CLEARANCE) {
                    self.bare[cell] = 0;
                } else if self.bare[cell] == OPEN && is_near_or_inside(corners.clone(), at, body + PREFERRED_CLEARANCE)
                {
                    self.bare[cell] = BESIDE;
                }
            }
        }
        self.regions = regions().map(<[[f64; 2]]>::to_vec).collect();
        self.zones.clone_from(zones);
        self.zone_costs = ZoneCosts::lay(world, self.grid, &mut self.bare);
        true
    }

    /// Whether a round body has room between the walls at a place.
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

    fn number_rooms(&mut self) {
        self.room.clear();
        self.room.resize(self.weight.len(), NO_ROOM);
        let stride = self.grid.stride();
        let mut waiting = Vec::new();
        let mut number = NO_ROOM;
        for start in 0..self.weight.len() {
            if self.weight[start] == 0 || self.room[start] != NO_ROOM {
                continue;
            }
            number += 1;
            self.room[start] = number;
            waiting.push(start);
            while let Some(cell) = waiting.pop() {
                for other in [cell - 1, cell + 1, cell - stride, cell + stride] {
                    if self.weight[other] > 0 && self.room[other] == NO_ROOM {
                        self.room[other] = number;
                        waiting.push(other);
                    }
                }
            }
        }
    }

    /// The open cell nearest to a place.
    pub(super) fn cell_near(&self, at: [f32; 2]) -> Option<usize> {
        let reach = self.body + 2.0 * self.grid.side();
        let of_all = self.grid.near(at, reach).filter(|cell| self.weight[*cell] > 0);
        let squared = |cell: usize| squared(self.grid.centre(cell), at);
        of_all
            .map(|cell| (cell, squared(cell)))
            .min_by(|(_, a), (_, b)| a.total_cmp(b))
            .map(|(cell, _)| cell)
    }

    /// The room that a place is in.
    pub(super) fn room_at(&self, at: [f32; 2]) -> Option<Room> {
        self.cell_near(at).map(|cell| self.room[cell])
    }

    /// The open cells in a zone.
    pub(super) fn cells_in(&self, zone: &Zone) -> Vec<u32> {
        let Some([low, high]) = zone.bounds() else {
            return Vec::new();
        };
        let [low, high] = [low, high].map(|place| place.map(|metres| metres as f32));
        let is_in = |cell: &usize| self.weight[*cell] > 0 && zone.contains(self.grid.centre(*cell).map(f64::from));
        self.grid
            .within(low, high)
            .filter(is_in)
            .map(|cell| cell as u32)
            .collect()
    }

    /// The room from which an object can be reached.
    pub(super) fn room_of(&self, sim: SimRef, object: u32) -> Option<Room> {
        self.room_beside(&Leaf::of(sim, object as usize), None)
    }

    /// The room of the nearest open cell beside a body, on one side of it if given.
    fn room_beside(&self, leaf: &Leaf, side: Option<f32>) -> Option<Room> {
        let reach = leaf.reach() + self.body + 0.6;
        let cells = self.grid.near(leaf.at, reach);
        let counts = |cell: &usize| {
            let [along, across] = leaf.own_axes(self.grid.centre(*cell));
            self.weight[*cell] > 0
                && side.is_none_or(|side| across * side > 0.0 && along.abs() <= leaf.half[0].max(0.1))
        };
        let near = cells
            .filter(counts)
            .map(|cell| (cell, leaf.distance(self.grid.centre(cell))));
        let nearest = near
            .filter(|(_, distance)| *distance < self.body + 0.6)
            .min_by(|(_, a), (_, b)| a.total_cmp(b));
        nearest.map(|(cell, _)| self.room[cell])
    }

    /// The cells of a room from which the agent can walk straight to an object.
    pub(super) fn cells_beside(&self, sim: SimRef, object: u32, room: Room) -> Vec<u32> {
        let leaf = Leaf::of(sim, object as usize);
        let reach = leaf.reach() + self.body + 0.6;
        let cells = self.grid.near(leaf.at, reach);
        let in_room: Vec<(usize, f32)> = cells
            .filter(|cell| self.weight[*cell] > 0 && self.room[*cell] == room)
            .filter(|cell| {
                leaf.own_axes(self.grid.centre(*cell))[0].abs() <= leaf.half[0] * 0.5 + 0.3 || !leaf.is_long()
            })
            .map(|cell| (cell, leaf.distance(self.grid.centre(cell))))
            .collect();
        let nearest = in_room
            .iter()
            .map(|(_, distance)| *distance)
            .fold(f32::INFINITY, f32::min);
        let most = nearest.max(self.body + NEAR) + 1e-3;
        in_room
            .into_iter()
            .filter(|(_, distance)| *distance <= most)
            .map(|(cell, _)| cell as u32)
            .collect()
    }
}

/// The weight of a cell, given the room that walls leave beyond the agent's body.
fn by_room(metres: f32) -> u16 {
    match metres {
        room if room < MIN_CLEARANCE => 0,
        room if room < PREFERRED_CLEARANCE => BESIDE,
        _ => OPEN,
    }
}

/// The objects that affect where paths lead, in ascending order of index.
fn standing(sim: SimRef) -> Vec<Standing> {
    let objects = sim.world.objects.iter().zip(sim.objects()).enumerate();
    let stands = objects.filter_map(|(index, (object, own))| {
        let is_still = object.motion_model == MotionModel::Stationary && object.pushable.is_none();
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
        Some(Standing {
            object: index as u32,
            leaf: Leaf::of(sim, index),
            is_door,
            weight,
        })
    });
    stands.collect()
}

pub(super) fn squared(a: [f32; 2], b: [f32; 2]) -> f32 {
    (a[0] - b[0]).powi(2) + (a[1] - b[1]).powi(2)
}
