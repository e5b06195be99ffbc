//! [`Views`]: data derived from the state: the scene for renderers, and the bodies for motion.

use driftworld_spec::{Object, World};

use super::areas::Zones;
use super::collision_world::CollisionWorld;
use super::state::{ObjectState, SimState};
use crate::assets::Catalogue;
use crate::scene::Scene;

/// Data derived from a state.
pub(crate) struct Views {
    pub(crate) scene: Scene,
    pub(super) bodies: CollisionWorld,
    pub(crate) zones: Zones,
}

impl Views {
    /// Views of a world at its start, with assets from a catalogue.
    pub(super) fn new(world: &World, catalogue: &Catalogue) -> Self {
        let scene = Scene::from_world_with(world, catalogue);
        let bodies = CollisionWorld::new(world, &scene);
        Self {
            scene,
            bodies,
            zones: Zones::new(world),
        }
    }

    /// Updates an object's item and body from its state. Must be called after every change of the state; nothing else changes
    /// the views.
    pub(super) fn sync_object(&mut self, index: usize, object: &Object, state: &ObjectState) {
        let item = &mut self.scene.items[index];
        (item.position, item.heading_deg) = (state.position, state.heading_deg);
        (item.reward, item.visible) = (state.reward as f32, state.present);
        let solid = object.solid && !state.open;
        self.bodies
            .sync_object(index as u32, item, solid, object.portable.is_some());
        if state.open {
            item.open_door();
        }
    }

    /// Updates all objects.
    pub(super) fn sync_objects(&mut self, world: &World, state: &SimState) {
        for (index, (object, state)) in world.objects.iter().zip(&state.objects).enumerate() {
            self.sync_object(index, object, state);
        }
    }
}
