//! [`Ways`]: the way to the current targets, and the next point to walk to.

use super::floor::{BESIDE, Floor, FloorObject, Room, squared};
use super::ground_shape::GroundShape;
use crate::agents::flood::Flood;
use crate::sim::{SimRef, reacting_object};

/// How far beyond the agent's body and to its sides an interaction reaches, in metres.
const REACH: f32 = 1.0;
const SIDE_REACH: f32 = 0.5;

/// How and where to put a thing down.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(super) struct Delivery {
    /// Index of the object to put it near.
    pub(super) to: u32,
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
    /// The floor's version and the target cells.
    destination: Option<(u64, Vec<u32>)>,
    /// The floor's version and the delivery, if the targets are cells from which to put a thing down.
    delivery: Option<(u64, Delivery)>,
    /// Whether the checked part of the last path avoids all zones that cost.
    pub(super) avoids_costs: bool,
}

impl Ways {
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

    /// Sets the target cells of paths.
    pub(super) fn lead(&mut self, floor: &Floor, targets: Vec<u32>) {
        let is_same = |(version, old): &(u64, Vec<u32>)| *version == floor.version && *old == targets;
        if self.destination.as_ref().is_some_and(is_same) {
            return;
        }
        self.flood.begin(floor, &targets);
        self.delivery = None;
        self.destination = Some((floor.version, targets));
    }

    /// The next point to walk to: the farthest point on the path that can be reached in a straight line. `None` at a target,
    /// and if there is no path.
    pub(super) fn next(&mut self, floor: &Floor, from: [f32; 2]) -> Option<[f32; 2]> {
        let start = floor.cell_near(from)?;
        if matches!(self.flood.reach(floor, start), 0 | u32::MAX) {
            return None;
        }
        let (mut cell, mut best) = (start, floor.grid.centre(start));
        self.avoids_costs = true;
        let mut beside = None;
        for _ in 0..15 {
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
            beside.get_or_insert(nearest);
            if floor.is_clear(from, floor.grid.centre(cell)) {
                best = floor.grid.centre(cell);
            } else if best != floor.grid.centre(start) {
                break;
            }
        }
        // Straight walks onto costlier ground, such as a zone to enter, do not count as clear, so the agent walks cell by cell
        // there.
        if best == floor.grid.centre(start) && floor.grid.cell_at(from) == start {
            best = beside.map_or(best, |cell| floor.grid.centre(cell));
        }
        Some(best)
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

    /// Whether a straight walk is clear; its start may be beside an obstacle.
    fn is_clear(&self, from: [f32; 2], to: [f32; 2]) -> bool {
        let length = squared(from, to).sqrt();
        let num_samples = (length / (self.grid.side() / 2.0)) as usize;
        let start = self.grid.cell_at(from);
        let max_weight = self.weight[start].max(BESIDE);
        (1..=num_samples).all(|number| {
            let fraction = number as f32 / num_samples as f32;
            let at = [0, 1].map(|axis| from[axis] + (to[axis] - from[axis]) * fraction);
            let cell = self.grid.cell_at(at);
            let weight = self.weight[cell];
            let is_walked = (1..=max_weight).contains(&weight) && self.zone_costs.of(start, cell) == 0;
            is_walked || weight == 0 && fraction * length < 0.3
        })
    }
}

/// Whether a thing is present, portable and not yet delivered, so that it may be picked up next.
pub(super) fn is_to_collect(sim: SimRef, delivery: Delivery, index: u32) -> bool {
    let (object, own) = (&sim.world.objects[index as usize], &sim.objects()[index as usize]);
    let to = sim.objects()[delivery.to as usize].position;
    own.present && object.portable.is_some() && squared(own.position, to) > delivery.within * delivery.within
}
