//! Shortest paths over the floor: the cost from each cell to the target, and where to walk next.

use std::cmp::Reverse;
use std::collections::BinaryHeap;

use super::floor::{BESIDE, Floor, Room, Standing, squared};
use super::leaf::Leaf;
use crate::sim::{SimRef, answering};

/// Cells still to be expanded, the cheapest first.
pub(super) type Waiting = BinaryHeap<Reverse<(u32, u32)>>;

/// How far beyond the agent's body and to its sides an interaction reaches, in metres.
const REACH: f32 = 1.0;
const ASIDE: f32 = 0.5;

/// Where to put a thing down.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(super) struct Bringing {
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
    /// How many things the agent carries: a free hand picks up what lies in front of it.
    pub(super) carried: usize,
}

impl Floor {
    /// Leads to where a thing can be put down near an object by an agent that faces it from a distance in `from`.
    pub(super) fn lead_to_bring(&mut self, sim: SimRef, bringing: Bringing) {
        if self.brings == Some((self.version, bringing)) {
            return;
        }
        // Tries with room to spare first, since the agent may stand anywhere in a cell.
        let mut goals = [0.15, 0.03]
            .into_iter()
            .map(|margin| self.places_to_bring(sim, bringing, margin));
        let goals = goals.find(|goals| !goals.is_empty()).unwrap_or_default();
        self.lead(goals);
        self.brings = Some((self.version, bringing));
    }

    fn places_to_bring(&self, sim: SimRef, bringing: Bringing, margin: f32) -> Vec<u32> {
        let Bringing {
            to,
            room,
            radius,
            ahead,
            from: [least, most],
            ..
        } = bringing;
        let at = sim.objects()[to as usize].position;
        // The nearest thing answers an interaction: nothing else that answers, or is still to be picked up, may be within reach.
        let answers = |index: &u32| answering(sim, &[*index]).is_some() || is_left(sim, bringing, *index);
        let others: Vec<Leaf> = (0..sim.objects().len() as u32)
            .filter(answers)
            .map(|index| Leaf::of(sim, index as usize))
            .collect();
        let is_free = |cell: &usize| {
            let cell = self.grid.centre(*cell);
            let away = squared(cell, at).sqrt();
            if !(least..=most).contains(&away) {
                return false;
            }
            let [east, north] = [0, 1].map(|axis| (at[axis] - cell[axis]) / away);
            // Where it would lie, and halfway there.
            let has_room = [ahead, ahead / 2.0].into_iter().all(|metres| {
                let point = [cell[0] + east * metres, cell[1] + north * metres];
                let is_room = |standing: &Standing| standing.leaf.distance(point) > radius + margin;
                self.standing.iter().all(is_room) && self.is_off_walls(point, radius + margin)
            });
            let is_out_of_reach = |leaf: &Leaf| {
                let [dx, dy] = [leaf.at[0] - cell[0], leaf.at[1] - cell[1]];
                let (before, aside) = (dx * east + dy * north, (dx * north - dy * east).abs());
                let spare = leaf.reach() + margin;
                before < -spare || before > self.body + REACH + spare || aside > ASIDE + spare
            };
            has_room && others.iter().all(is_out_of_reach)
        };
        let around = self.grid.near(at, most);
        around
            .filter(|cell| self.room[*cell] == room && is_free(cell))
            .map(|cell| cell as u32)
            .collect()
    }

    /// Sets the cells that paths lead to.
    pub(super) fn lead(&mut self, goals: Vec<u32>) {
        if self
            .leads
            .as_ref()
            .is_some_and(|(version, old)| *version == self.version && *old == goals)
        {
            return;
        }
        self.field.clear();
        self.field.resize(self.weight.len(), u32::MAX);
        self.open.clear();
        for cell in &goals {
            self.field[*cell as usize] = 0;
            self.open.push(Reverse((0, *cell)));
        }
        self.brings = None;
        self.leads = Some((self.version, goals));
    }

    /// Expands cells until the cost from this cell is known, and no farther.
    fn reach(&mut self, asked: usize) {
        while let Some(Reverse((here, cell))) = self.open.peek().copied()
            && here <= self.field[asked]
        {
            self.open.pop();
            let cell = cell as usize;
            if here > self.field[cell] {
                continue;
            }
            for (step, is_slanting) in self.grid.around() {
                let other = cell.wrapping_add_signed(step);
                if self.weight[other] == 0 || is_slanting && !self.is_corner_open(cell, step) {
                    continue;
                }
                let ground = u32::from(self.weight[other]) * if is_slanting { 7 } else { 5 };
                let through = here.saturating_add(ground + self.zone_costs.of(other, cell));
                if through < self.field[other] {
                    self.field[other] = through;
                    self.open.push(Reverse((through, other as u32)));
                }
            }
        }
    }

    /// Whether a diagonal step cuts no corner.
    fn is_corner_open(&self, cell: usize, step: isize) -> bool {
        let row = self.grid.stride() as isize * step.signum();
        let column = step - row;
        self.weight[cell.wrapping_add_signed(row)] > 0 && self.weight[cell.wrapping_add_signed(column)] > 0
    }

    /// Where to walk next from a place: the farthest point on the way that can be walked to straight. `None` at the goal, and
    /// if there is no way.
    pub(super) fn next(&mut self, from: [f32; 2]) -> Option<[f32; 2]> {
        let start = self.cell_near(from)?;
        self.reach(start);
        if self.field[start] == 0 || self.field[start] == u32::MAX {
            return None;
        }
        let (mut cell, mut best) = (start, self.grid.centre(start));
        self.keeps_out = true;
        let mut beside = None;
        for _ in 0..15 {
            let around = self.grid.around().into_iter();
            let open = around.filter(|(step, is_slanting)| !is_slanting || self.is_corner_open(cell, *step));
            let nearest = open
                .map(|(step, _)| cell.wrapping_add_signed(step))
                .min_by_key(|other| self.field[*other].saturating_add(self.zone_costs.of(cell, *other)));
            let Some(nearest) = nearest.filter(|other| self.field[*other] < self.field[cell]) else {
                break;
            };
            cell = nearest;
            self.keeps_out &= !self.zone_costs.is_in_what_costs(cell);
            beside.get_or_insert(nearest);
            if self.is_clear(from, self.grid.centre(cell)) {
                best = self.grid.centre(cell);
            } else if best != self.grid.centre(start) {
                break;
            }
        }
        // Straight walks onto costlier ground, such as a zone to enter, are not clear: the agent walks cell by cell there.
        if best == self.grid.centre(start) && self.grid.cell_at(from) == start {
            best = beside.map_or(best, |cell| self.grid.centre(cell));
        }
        Some(best)
    }

    /// Whether a straight walk is clear, except where it begins.
    fn is_clear(&self, from: [f32; 2], to: [f32; 2]) -> bool {
        let length = squared(from, to).sqrt();
        let count = (length / (self.grid.side() / 2.0)) as usize;
        let start = self.grid.cell_at(from);
        let dear = self.weight[start].max(BESIDE);
        (1..=count).all(|number| {
            let share = number as f32 / count as f32;
            let at = [0, 1].map(|axis| from[axis] + (to[axis] - from[axis]) * share);
            let cell = self.grid.cell_at(at);
            let weight = self.weight[cell];
            let is_walked = (1..=dear).contains(&weight) && self.zone_costs.of(start, cell) == 0;
            is_walked || weight == 0 && share * length < 0.3
        })
    }
}

/// Whether a thing is present, not yet delivered, and may be picked up next.
pub(super) fn is_left(sim: SimRef, bringing: Bringing, index: u32) -> bool {
    let (object, own) = (&sim.world.objects[index as usize], &sim.objects()[index as usize]);
    let to = sim.objects()[bringing.to as usize].position;
    own.present && object.portable.is_some() && squared(own.position, to) > bringing.within * bringing.within
}
