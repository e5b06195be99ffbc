//! Broad phase: finds the bodies around a place.
//!
//! Walls, solid bodies and ghosts have separate trees, so that queries for one kind are not slowed down by the others.

use rapier3d::parry::partitioning::{Bvh, BvhBuildStrategy, BvhWorkspace};
use rapier3d::prelude::*;

use super::groups::{AGENT, GHOST, SOLID, WALL};

/// The trees, with the groups in each.
const HELD: [Group; 3] = [WALL, SOLID.union(AGENT), GHOST];

/// With fewer bodies, a tree of any shape is fast.
const FEW: usize = 64;

/// A tree is rebuilt after this many moves per body.
const WORN: usize = 4;

/// Trees of bounding boxes, by handle number.
#[derive(Default)]
pub(super) struct BroadPhase {
    trees: [Tree; 3],
    workspace: BvhWorkspace,
}

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
    /// Records the current bounding box of a body of a group.
    pub(super) fn put(&mut self, group: Group, number: u32, area: Aabb) {
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
    }

    /// The trees that contain any of these groups.
    pub(super) fn of(&self, groups: Group) -> impl Iterator<Item = &Bvh> {
        let held = HELD.into_iter().zip(&self.trees);
        held.filter(move |(held, _)| held.intersects(groups))
            .map(|(_, tree)| &tree.boxes)
    }
}

fn place_of(group: Group) -> usize {
    HELD.iter().position(|held| held.contains(group)).unwrap_or(0)
}
