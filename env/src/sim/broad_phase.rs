//! Broad phase: finds the bodies around a position.
//!
//! Walls, solid bodies and ghosts have separate trees, so that queries for one kind are not slowed down by the others. The
//! first bodies are also kept in one short list, which is read instead of the trees if there are no others, because that is
//! faster.

use rapier3d::parry::partitioning::{Bvh, BvhBuildStrategy, BvhWorkspace};
use rapier3d::prelude::*;

use super::groups::{AGENT, GHOST, SOLID, WALL};
use crate::prefetch::prefetch;

/// The trees, with the groups in each.
const HELD: [Group; 3] = [WALL, SOLID.union(AGENT), GHOST];

/// With fewer bodies, a tree of any shape is fast, and a list faster still.
const FEW: usize = 64;

/// A tree is rebuilt after this many moves per body.
const WORN: usize = 4;

/// Trees of bounding boxes, by handle number.
#[derive(Default)]
pub(super) struct BroadPhase {
    trees: Box<[Tree; 3]>,
    /// Group and rectangle on the ground of the first [`FEW`] bodies, by handle number; no group for those that were removed.
    listed: Vec<(Group, Rectangle)>,
    /// Whether there are more bodies than that.
    are_many: bool,
    workspace: Box<BvhWorkspace>,
}

/// Minimum and maximum coordinates.
type Rectangle = [[f32; 2]; 2];

#[derive(Default)]
struct Tree {
    /// The engine's own broad phase is meant to run in the engine's steps; without them, it lost bodies that were
    /// removed and inserted many times.
    boxes: Bvh,
    /// Number of moves since the tree was built. Inner boxes only grow when bodies move, so that eventually every query would
    /// visit every body.
    moved: usize,
}

impl BroadPhase {
    /// Prefetches what the next query reads.
    pub(super) fn prefetch(&self) {
        prefetch(self.listed.as_slice());
    }

    /// Records the current bounding box of a body of a group.
    pub(super) fn put(&mut self, group: Group, number: u32, area: Aabb) {
        let slot = number as usize;
        if slot < FEW {
            let unused = (Group::NONE, [[0.0; 2]; 2]);
            self.listed.resize(self.listed.len().max(slot + 1), unused);
            self.listed[slot] = (group, [area.mins, area.maxs].map(|corner| [corner.x, corner.y]));
        }
        self.are_many |= slot >= FEW;
        let tree = &mut self.trees[place_of(group)];
        tree.boxes.insert(area, number);
        tree.moved += 1;
        let count = tree.boxes.leaf_count() as usize;
        if count >= FEW && tree.moved > WORN * count {
            tree.boxes.rebuild(&mut self.workspace, BvhBuildStrategy::default());
            tree.moved = 0;
        }
    }

    /// Removes a body of a group.
    pub(super) fn remove(&mut self, group: Group, number: u32) {
        self.trees[place_of(group)].boxes.remove(number);
        if let Some((listed, _)) = self.listed.get_mut(number as usize) {
            *listed = Group::NONE;
        }
    }

    /// All bodies of these groups whose rectangles on the ground meet this one, and perhaps some of others, in no particular order.
    pub(super) fn around(&self, groups: Group, [least, most]: Rectangle) -> impl Iterator<Item = u32> {
        let listed = if self.are_many { &[] } else { self.listed.as_slice() };
        let meets = move |&([from, to], _): &(Rectangle, u32)| {
            (0..2).all(|axis| from[axis] <= most[axis] && to[axis] >= least[axis])
        };
        let listed = listed
            .iter()
            .zip(0..)
            .filter(move |((group, _), _)| group.intersects(groups));
        let few = listed
            .map(|((_, rectangle), number)| (*rectangle, number))
            .filter(meets);
        let area = Aabb::new(
            Vector::new(least[0], least[1], -1e3),
            Vector::new(most[0], most[1], 1e3),
        );
        let trees = self.are_many.then(|| self.of(groups)).into_iter().flatten();
        let many = trees.flat_map(move |boxes| boxes.leaves(move |node| node.aabb().intersects(&area)));
        few.map(|(_, number)| number).chain(many)
    }

    /// The trees that contain any of these groups.
    pub(super) fn of(&self, groups: Group) -> impl Iterator<Item = &Bvh> {
        let held = HELD.into_iter().zip(self.trees.iter());
        held.filter(move |(held, _)| held.intersects(groups))
            .map(|(_, tree)| &tree.boxes)
    }
}

fn place_of(group: Group) -> usize {
    HELD.iter().position(|held| held.contains(group)).unwrap_or(0)
}

#[cfg(test)]
mod tests {
    use super::*;
    use proptest::prelude::*;

    proptest! {
        #[test]
        fn list_of_few_bodies_finds_what_the_trees_find(
            bodies in prop::collection::vec((0..4_usize, -9.0..9.0_f32, -9.0..9.0_f32, 0.0..3.0_f32), 1..FEW),
            removed in prop::collection::vec(0..FEW, 0..6),
            [x, y, side] in [-9.0..9.0_f32, -9.0..9.0_f32, 0.0..6.0_f32],
        ) {
            let mut places = BroadPhase::default();
            let group = |at: usize| [WALL, SOLID, AGENT, GHOST][at];
            for (number, (kind, x, y, half)) in (0..).zip(&bodies) {
                places.put(group(*kind), number, Aabb::from_half_extents(Vector::new(*x, *y, 1.0), Vector::splat(*half)));
            }
            for number in removed.into_iter().filter(|number| *number < bodies.len()) {
                places.remove(group(bodies[number].0), number as u32);
            }
            for groups in [WALL, SOLID | WALL, GHOST, Group::ALL] {
                let found = |places: &BroadPhase| {
                    let around = places.around(groups, [[x, y], [x + side, y + side]]);
                    // A tree may have bodies of other groups, too.
                    let mut found: Vec<u32> = around.filter(|number| group(bodies[*number as usize].0).intersects(groups)).collect();
                    found.sort_unstable();
                    found
                };
                let few = found(&places);
                places.are_many = true;
                prop_assert_eq!(few, found(&places));
                places.are_many = false;
            }
        }
    }
}
