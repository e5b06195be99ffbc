//! Broad phase: finds the bodies around a position.
//!
//! Walls, solid bodies and ghosts have separate trees, so that other kinds do not slow down queries for one kind. The first few
//! bodies are also kept in a list. If there are no others, queries read the list instead of the trees, because that is faster.

use rapier3d::parry::partitioning::{Bvh, BvhBuildStrategy, BvhWorkspace};
use rapier3d::prelude::*;

use super::groups::{AGENT, GHOST, SOLID, WALL};
use crate::prefetch::prefetch;

/// The groups in each tree.
const TREE_GROUPS: [Group; 3] = [WALL, SOLID.union(AGENT), GHOST];

/// Maximum number of bodies in the list. With fewer bodies, a tree of any shape is fast, and a list is even faster.
const MAX_LISTED: usize = 64;

/// Number of moves per body after which a tree is rebuilt.
const MAX_MOVES_PER_BODY: usize = 4;

/// Trees of bounding boxes, by handle number.
#[derive(Default)]
pub(super) struct BroadPhase {
    trees: Box<[Tree; 3]>,
    /// Group and rectangle on the ground of the first [`MAX_LISTED`] bodies, by handle number; no group for those that were removed.
    listed: Vec<(Group, Rectangle)>,
    /// Whether there are more bodies than that.
    exceeds_list: bool,
    workspace: Box<BvhWorkspace>,
}

/// Minimum and maximum coordinates.
type Rectangle = [[f32; 2]; 2];

#[derive(Default)]
struct Tree {
    /// Replaces the engine's own broad phase, which is meant to run in the engine's steps: without them, it lost bodies that
    /// were removed and inserted many times.
    boxes: Bvh,
    /// Number of moves since the tree was built. Inner boxes only grow when bodies move, so without rebuilding, every query
    /// would eventually visit every body.
    moved: usize,
}

impl BroadPhase {
    /// Prefetches the memory that the next query reads.
    pub(super) fn prefetch(&self) {
        prefetch(self.listed.as_slice());
    }

    /// Records the current bounding box of a body in a group.
    pub(super) fn put(&mut self, group: Group, number: u32, area: Aabb) {
        let slot = number as usize;
        if slot < MAX_LISTED {
            let unused = (Group::NONE, [[0.0; 2]; 2]);
            self.listed.resize(self.listed.len().max(slot + 1), unused);
            self.listed[slot] = (group, [area.mins, area.maxs].map(|corner| [corner.x, corner.y]));
        }
        self.exceeds_list |= slot >= MAX_LISTED;
        let tree = &mut self.trees[tree_index(group)];
        tree.boxes.insert(area, number);
        tree.moved += 1;
        let count = tree.boxes.leaf_count() as usize;
        if count >= MAX_LISTED && tree.moved > MAX_MOVES_PER_BODY * count {
            tree.boxes.rebuild(&mut self.workspace, BvhBuildStrategy::default());
            tree.moved = 0;
        }
    }

    /// Removes a body from a group.
    pub(super) fn remove(&mut self, group: Group, number: u32) {
        self.trees[tree_index(group)].boxes.remove(number);
        if let Some((listed, _)) = self.listed.get_mut(number as usize) {
            *listed = Group::NONE;
        }
    }

    /// All bodies of these groups whose rectangles on the ground intersect this one, in no particular order. May include bodies
    /// of other groups.
    pub(super) fn around(&self, groups: Group, [low, high]: Rectangle) -> impl Iterator<Item = u32> {
        let listed = if self.exceeds_list { &[] } else { self.listed.as_slice() };
        let meets = move |&([from, to], _): &(Rectangle, u32)| {
            (0..2).all(|axis| from[axis] <= high[axis] && to[axis] >= low[axis])
        };
        let listed = listed
            .iter()
            .zip(0..)
            .filter(move |((group, _), _)| group.intersects(groups));
        let few = listed
            .map(|((_, rectangle), number)| (*rectangle, number))
            .filter(meets);
        let area = Aabb::new(Vector::new(low[0], low[1], -1e3), Vector::new(high[0], high[1], 1e3));
        let trees = self.exceeds_list.then(|| self.of(groups)).into_iter().flatten();
        let many = trees.flat_map(move |boxes| boxes.leaves(move |node| node.aabb().intersects(&area)));
        few.map(|(_, number)| number).chain(many)
    }

    /// The trees that contain any of these groups.
    pub(super) fn of(&self, groups: Group) -> impl Iterator<Item = &Bvh> {
        let held = TREE_GROUPS.into_iter().zip(self.trees.iter());
        held.filter(move |(held, _)| held.intersects(groups))
            .map(|(_, tree)| &tree.boxes)
    }
}

fn tree_index(group: Group) -> usize {
    TREE_GROUPS.iter().position(|held| held.contains(group)).unwrap_or(0)
}

#[cfg(test)]
mod tests {
    use super::*;
    use proptest::prelude::*;

    proptest! {
        #[test]
        fn list_finds_the_same_bodies_as_the_trees(
            bodies in prop::collection::vec((0..4_usize, -9.0..9.0_f32, -9.0..9.0_f32, 0.0..3.0_f32), 1..MAX_LISTED),
            removed in prop::collection::vec(0..MAX_LISTED, 0..6),
            [x, y, side] in [-9.0..9.0_f32, -9.0..9.0_f32, 0.0..6.0_f32],
        ) {
            let mut broad_phase = BroadPhase::default();
            let group = |at: usize| [WALL, SOLID, AGENT, GHOST][at];
            for (number, (kind, x, y, half)) in (0..).zip(&bodies) {
                broad_phase.put(group(*kind), number, Aabb::from_half_extents(Vector::new(*x, *y, 1.0), Vector::splat(*half)));
            }
            for number in removed.into_iter().filter(|number| *number < bodies.len()) {
                broad_phase.remove(group(bodies[number].0), number as u32);
            }
            for groups in [WALL, SOLID | WALL, GHOST, Group::ALL] {
                let found = |broad_phase: &BroadPhase| {
                    let around = broad_phase.around(groups, [[x, y], [x + side, y + side]]);
                    // A tree may contain bodies of other groups as well.
                    let mut found: Vec<u32> = around.filter(|number| group(bodies[*number as usize].0).intersects(groups)).collect();
                    found.sort_unstable();
                    found
                };
                let few = found(&broad_phase);
                broad_phase.exceeds_list = true;
                prop_assert_eq!(few, found(&broad_phase));
                broad_phase.exceeds_list = false;
            }
        }
    }
}
