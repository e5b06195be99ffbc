//! Keeps the bodies of objects up to date: their position, their presence, and whether they are solid.

use rapier3d::prelude::*;

use super::collision_world::{CollisionWorld, slot};
use super::groups::{GHOST, SOLID};
use crate::scene::Item;

impl CollisionWorld {
    /// Updates an object's body from its item: moves, adds or removes it.
    pub(super) fn sync_object(&mut self, index: u32, item: &Item, solid: bool, is_portable: bool) {
        let body = self.handles.get(index as usize).copied().flatten();
        match (body, item.visible) {
            (Some(handle), true) => {
                self.set_solid(handle, solid);
                self.put(handle, item.position, item.heading_deg);
            }
            (Some(handle), false) if is_portable => {
                self.handles[index as usize] = None;
                self.set_aside.push((index, handle));
                let group = self.colliders[handle].collision_groups().memberships;
                self.broad_phase.remove(group, slot(handle) as u32);
            }
            (Some(_), false) => self.remove(index),
            (None, true) => {
                if let Some(number) = self.set_aside.iter().position(|(other, _)| *other == index) {
                    let (_, handle) = self.set_aside.swap_remove(number);
                    self.handles[index as usize] = Some(handle);
                    self.set_solid(handle, solid);
                    self.put(handle, item.position, item.heading_deg);
                } else {
                    self.add_object(index, item, solid);
                }
            }
            (None, false) => {}
        }
    }

    /// Makes a body solid or a ghost.
    fn set_solid(&mut self, handle: ColliderHandle, solid: bool) {
        let group = if solid { SOLID } else { GHOST };
        let groups = self.colliders[handle].collision_groups();
        if groups.memberships != group {
            self.broad_phase.remove(groups.memberships, slot(handle) as u32);
            let groups = InteractionGroups::new(group, Group::ALL, InteractionTestMode::And);
            self.colliders[handle].set_collision_groups(groups);
        }
    }
}
