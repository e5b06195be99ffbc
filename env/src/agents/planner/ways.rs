//! [`Ways`]: the way to the current targets, and the next point to walk to.

use driftworld_spec::Zone;

use super::flood::{Flood, STRAIGHT};
use super::floor::{BESIDE, BESIDE_OBSTACLE, Floor, FloorObject, Room, squared};
use super::ground_shape::GroundShape;
use crate::polygon::distance;
use crate::sim::{SimRef, reacting_object};

/// How far beyond the agent's body and to its sides an interaction reaches, in metres.
const REACH: f32 = 1.0;
const SIDE_REACH: f32 = 0.5;

/// Distance from contact with an object, in metres, at which the ground counts as beside it.
const BESIDE_OBJECT: f32 = 0.3;

/// Length of the path, in metres, that is searched for the farthest point to walk straight to.
const LOOK_AHEAD: f32 = 6.0;

/// Fraction of the distance to an object by which the object may move before the path is recomputed.
const ASTRAY: f32 = 0.2;

/// How and where to put a thing down.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(super) struct Delivery {
    /// Index of the object to put it near.
    pub(super) to: u32,
    /// Where that object is.
    pub(super) at: [f32; 2],
    /// The room of the agent.
    pub(super) room: Room,
    /// Radius of the thing in metres.
    pub(super) radius: f32,
    /// How far in front of the agent's centre it will lie, in metres.
    pub(super) ahead: f32,
    /// Minimum and maximum distance of the agent from the object, in metres.
    pub(super) from: [f32; 2],
    /// Maximum distance of the thing from the object, in metres.
    pub(super) within: f32,
    /// Number of things that the agent carries: with a free hand, it would pick up what lies in front of it.
    pub(super) carried: usize,
}

/// The way to the cells that are the current targets.
#[derive(Clone, Debug, Default)]
pub(super) struct Ways {
    flood: Flood,
    /// From the agent, to compare distances.
    around: Flood,
    /// The floor's version and the target cells.
    destination: Option<(u64, Vec<u32>)>,
    /// The floor's version, a room and the outline of an object in it, if the targets are cells beside that.
    object: Option<(u64, Room, GroundShape)>,
    /// The floor's version, a zone and its room, if the targets are cells in it and its equals.
    zone: Option<(u64, u32, Room)>,
    /// The floor's version and the delivery, if the targets are cells from which to put a thing down.
    delivery: Option<(u64, Delivery)>,
    /// Whether the checked part of the last path avoids all zones that cost.
    pub(super) avoids_costs: bool,
}

impl Ways {
    /// Forgets what the targets are, but not the paths to their cells.
    pub(super) fn forget(&mut self) {
        (self.delivery, self.object, self.zone) = (None, None, None);
    }

    /// Leads to the cells from which an agent that faces the object can put the thing down near it.
    pub(super) fn lead_to_delivery(&mut self, sim: SimRef, floor: &Floor, delivery: Delivery) {
        if self.delivery == Some((floor.version, delivery)) {
            return;
        }
        // Tries a generous margin first, since the agent may stand anywhere in a cell.
        let mut goals = [0.15, 0.03]
            .into_iter()
            .map(|margin| floor.cells_to_deliver_from(sim, delivery, margin));
        let goals = goals.find(|goals| !goals.is_empty()).unwrap_or_default();
        self.lead(floor, goals);
        self.delivery = Some((floor.version, delivery));
    }

    /// Prepares to compare path lengths from a position.
    pub(super) fn look_around(&mut self, floor: &Floor, from: [f32; 2]) {
        let start = floor.cell_near(from).map(|cell| cell as u32);
        self.around.begin(floor, start.as_slice(), true);
    }

    /// Length in metres of the path from the position given to [`Self::look_around`] to an object in the same room; costly ground
    /// counts as longer.
    pub(super) fn length_to(&mut self, sim: SimRef, floor: &Floor, object: u32) -> f32 {
        let here = sim.agent().position;
        let shape = GroundShape::of(sim, object as usize);
        if floor.is_open_to(here, &shape) {
            return distance(here, shape.at);
        }
        let Some(room) = floor.room_at(here) else {
            return f32::INFINITY;
        };
        let cells = floor.cells_beside(&shape, room).into_iter();
        let lengths = cells.map(|cell| {
            let cost = self.around.reach(floor, cell as usize);
            cost as f32 / STRAIGHT as f32 * floor.grid.side() + distance(floor.grid.centre(cell as usize), shape.at)
        });
        lengths.fold(f32::INFINITY, f32::min)
    }

    /// Leads to an object, or to `place`, its earlier position: the movement of a distant object is followed only roughly.
    pub(super) fn lead_to(&mut self, sim: SimRef, floor: &Floor, object: u32, room: Room, place: &mut [f64; 2]) {
        let (here, now) = (sim.agent().position, sim.objects()[object as usize].position);
        let known = |place: &[f64; 2]| place.map(|metres| metres as f32);
        let is_near = distance(known(place), now) <= (ASTRAY * distance(here, now) - 0.2).max(0.0);
        let mut shape = GroundShape::of(sim, object as usize);
        if is_near {
            shape.at = known(place);
            if self.object == Some((floor.version, room, shape)) {
                return;
            }
        }
        let mut cells = floor.cells_beside(&shape, room);
        if cells.is_empty() && is_near {
            shape.at = now;
            cells = floor.cells_beside(&shape, room);
        }
        *place = shape.at.map(f64::from);
        self.lead(floor, cells);
        self.object = Some((floor.version, room, shape));
    }

    /// Leads to the cells of a room in these zones, all worth as much as the zone with this index.
    pub(super) fn lead_into<'a>(
        &mut self,
        floor: &Floor,
        zones: impl Iterator<Item = &'a Zone>,
        index: u32,
        room: Room,
    ) {
        if self.zone == Some((floor.version, index, room)) {
            return;
        }
        let cells = zones.flat_map(|zone| floor.cells_in(zone));
        self.lead(floor, cells.filter(|cell| floor.room[*cell as usize] == room).collect());
        self.zone = Some((floor.version, index, room));
    }

    /// Sets the target cells of paths.
    pub(super) fn lead(&mut self, floor: &Floor, targets: Vec<u32>) {
        let is_old = |(version, old): &(u64, Vec<u32>)| *version == floor.version && *old == targets;
        self.forget();
        if self.destination.as_ref().is_some_and(is_old) {
            return;
        }
        self.flood.begin(floor, &targets, false);
        self.destination = Some((floor.version, targets));
    }

    /// The next point to walk to: the farthest point on the path that can be reached in a straight line. `None` at a target,
    /// and if there is no path.
    pub(super) fn next(&mut self, floor: &Floor, from: [f32; 2]) -> Option<[f32; 2]> {
        let start = floor.cell_near(from)?;
        if matches!(self.flood.reach(floor, start), 0 | u32::MAX) {
            return None;
        }
        // An agent beside a wall may have to step away from it first.
        let is_off = floor.grid.cell_at(from) != start;
        let (mut cell, mut best) = (start, is_off.then(|| floor.grid.centre(start)));
        self.avoids_costs = true;
        let num_cells = (LOOK_AHEAD / floor.grid.side()) as usize;
        for _ in 0..num_cells {
            let around = floor.grid.around().into_iter();
            let open = around.filter(|(step, is_diagonal)| !is_diagonal || floor.is_corner_open(cell, *step));
            let nearest = open
                .map(|(step, _)| cell.wrapping_add_signed(step))
                .min_by_key(|other| {
                    self.flood
                        .cost(*other)
                        .saturating_add(floor.zone_costs.of(cell, *other))
                });
            let Some(nearest) = nearest.filter(|other| self.flood.cost(*other) < self.flood.cost(cell)) else {
                break;
            };
            cell = nearest;
            self.avoids_costs &= !floor.zone_costs.is_in_costly_zone(cell);
            let to = floor.grid.centre(cell);
            // The agent may stand anywhere in its cell.
            let most = self.flood.cost(start) - self.flood.cost(cell) + STRAIGHT * u32::from(floor.weight[start]);
            if best.is_none() || floor.is_clear(from, to, most) {
                best = Some(to);
            } else {
                break;
            }
        }
        best
    }
}

impl Floor {
    fn cells_to_deliver_from(&self, sim: SimRef, delivery: Delivery, margin: f32) -> Vec<u32> {
        let Delivery {
            to,
            room,
            radius,
            ahead,
            from: [least, most],
            ..
        } = delivery;
        let at = sim.objects()[to as usize].position;
        // The nearest thing reacts to an interaction, so nothing else that reacts or must be picked up may be within reach.
        let answers = |index: &u32| reacting_object(sim, &[*index]).is_some() || is_to_collect(sim, delivery, *index);
        let others: Vec<GroundShape> = (0..sim.objects().len() as u32)
            .filter(answers)
            .map(|index| GroundShape::of(sim, index as usize))
            .collect();
        let is_free = |cell: &usize| {
            let cell = self.grid.centre(*cell);
            let away = squared(cell, at).sqrt();
            if !(least..=most).contains(&away) {
                return false;
            }
            let [east, north] = [0, 1].map(|axis| (at[axis] - cell[axis]) / away);
            // The thing must fit where it would lie, and halfway there.
            let has_room = [ahead, ahead / 2.0].into_iter().all(|metres| {
                let point = [cell[0] + east * metres, cell[1] + north * metres];
                let is_clear = |object: &FloorObject| object.shape.distance(point) > radius + margin;
                self.objects.iter().all(is_clear) && self.is_off_walls(point, radius + margin)
            });
            let is_out_of_reach = |shape: &GroundShape| {
                let [dx, dy] = [shape.at[0] - cell[0], shape.at[1] - cell[1]];
                let (before, aside) = (dx * east + dy * north, (dx * north - dy * east).abs());
                let spare = shape.reach() + margin;
                before < -spare || before > self.body + REACH + spare || aside > SIDE_REACH + spare
            };
            has_room && others.iter().all(is_out_of_reach)
        };
        let around = self.grid.near(at, most);
        around
            .filter(|cell| self.room[*cell] == room && is_free(cell))
            .map(|cell| cell as u32)
            .collect()
    }

    /// Whether the agent can walk straight up to an object, around nothing and through no zone that costs.
    pub(super) fn is_open_to(&self, from: [f32; 2], shape: &GroundShape) -> bool {
        let length = distance(from, shape.at);
        let num_samples = (length / (self.grid.side() / 2.0)) as usize;
        let start = self.grid.cell_at(from);
        let max_weight = self.weight[start].clamp(BESIDE, BESIDE_OBSTACLE);
        for number in 1..=num_samples {
            let fraction = number as f32 / num_samples as f32;
            let at = [0, 1].map(|axis| from[axis] + (shape.at[axis] - from[axis]) * fraction);
            let gap = shape.distance(at) - self.body;
            if gap < 0.1 {
                return true;
            }
            let cell = self.grid.cell_at(at);
            // The ground beside the object itself may weigh more.
            let most = if gap < BESIDE_OBJECT {
                max_weight.max(BESIDE_OBSTACLE)
            } else {
                max_weight
            };
            if !(1..=most).contains(&self.weight[cell])
                || self.zone_costs.of(start, cell) > 0
                || self.zone_costs.is_in_costly_zone(cell)
            {
                return false;
            }
        }
        true
    }

    /// Whether a straight walk is clear: over open ground, or at no more than this cost, in fifths of a cell. Its start may be
    /// beside an obstacle.
    fn is_clear(&self, from: [f32; 2], to: [f32; 2], most: u32) -> bool {
        let length = distance(from, to);
        let num_samples = (length / (self.grid.side() / 2.0)).ceil().max(1.0) as usize;
        let start = self.grid.cell_at(from);
        let open = self.weight[start].clamp(BESIDE, BESIDE_OBSTACLE);
        let (mut last, mut is_open, mut weights, mut entering) = (start, true, 0, 0);
        for number in 1..=num_samples {
            let fraction = number as f32 / num_samples as f32;
            let at = [0, 1].map(|axis| from[axis] + (to[axis] - from[axis]) * fraction);
            let cell = self.grid.cell_at(at);
            let is_beside_start = fraction * length < 0.3;
            if self.weight[cell] == 0 && !is_beside_start {
                return false;
            }
            weights += u32::from(self.weight[cell]);
            entering += self.zone_costs.of(last, cell);
            is_open &= self.weight[cell] <= open;
            last = cell;
        }
        let cost = STRAIGHT as f32 * weights as f32 * length / num_samples as f32 / self.grid.side();
        is_open && entering == 0 || cost as u32 + entering <= most
    }
}

/// Whether a thing is present, portable and not yet delivered, so that it may be picked up next.
pub(super) fn is_to_collect(sim: SimRef, delivery: Delivery, index: u32) -> bool {
    let (object, own) = (&sim.world.objects[index as usize], &sim.objects()[index as usize]);
    let to = sim.objects()[delivery.to as usize].position;
    own.present && object.portable.is_some() && squared(own.position, to) > delivery.within * delivery.within
}
