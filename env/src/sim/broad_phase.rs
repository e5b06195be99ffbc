//! Where bodies are: which of them lie around a place. What they are is in `collision_world.rs`.
//!
//! Walls, what is solid and what is passed through have a tree each, so that who asks for some is not held up by the
//! others.

use rapier3d::parry::partitioning::{Bvh, BvhBuildStrategy, BvhWorkspace};
use rapier3d::prelude::*;

use super::groups::{AGENT, GHOST, SOLID, WALL};

/// The trees, and which groups each holds.
const HELD: [Group; 3] = [WALL, SOLID.union(AGENT), GHOST];

/// Bodies below which a tree is quick whatever its shape.
const FEW: usize = 64;

/// How often as many bodies as there are may have moved before a tree is built anew.
const WORN: usize = 4;

/// Trees of boxes around bodies, by the numbers of their handles.
#[derive(Default)]
pub(super) struct BroadPhase {
    trees: [Tree; 3],
    workspace: BvhWorkspace,
}

#[derive(Default)]
struct Tree {
    /// The engine's own broad phase, made for its step, lost bodies that were taken away and put back many times
    /// without one.
    boxes: Bvh,
    /// How often a body was put somewhere since the tree was built. The boxes around boxes only grow when one moves, so
    /// that in the end every question would lead to every body.
    moved: usize,
}

impl BroadPhase {
    /// Notes where a body of a group is now.
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

    /// Forgets a body of a group.
    pub(super) fn remove(&mut self, group: Group, number: u32) {
        self.trees[place_of(group)].boxes.remove(number);
    }

    /// The trees that hold any of these groups.
    pub(super) fn of(&self, groups: Group) -> impl Iterator<Item = &Bvh> {
        let held = HELD.into_iter().zip(&self.trees);
        held.filter(move |(held, _)| held.intersects(groups))
            .map(|(_, tree)| &tree.boxes)
    }
}

fn place_of(group: Group) -> usize {
    HELD.iter().position(|held| held.contains(group)).unwrap_or(0)
}
