//! Edits a running world: adds and removes objects, and moves the agent.

use std::sync::Arc;

use driftworld_spec::{MAX_OBJECTS, Object};

use super::environment::Environment;
use super::interactions::init_contacts;
use super::state::wrapped;
use super::things::follow;
use super::walls;
use crate::EnvError;

impl Environment {
    /// The index of the object with this `unique_name`, whether it is present or not.
    pub fn find(&self, unique_name: &str) -> Option<usize> {
        let has_name = |object: &Object| object.unique_name.as_deref() == Some(unique_name);
        self.world.objects.iter().position(has_name)
    }

    /// Adds a new object to the running world and returns its index, the next free number. Existing indices do not change.
    ///
    /// The object is placed at its coordinates, even in a wall. If it touches the agent, contact begins in the next step.
    ///
    /// # Errors
    /// [`EnvError::BadObject`] if a document containing this object would be rejected, [`EnvError::NameTaken`] if another
    /// object has its `unique_name`, and [`EnvError::TooManyObjects`] beyond [`MAX_OBJECTS`], where destroyed objects count as
    /// well. On error nothing is changed.
    pub fn spawn(&mut self, object: Object) -> Result<usize, EnvError> {
        let index = self.world.objects.len();
        if index >= MAX_OBJECTS {
            return Err(EnvError::TooManyObjects { limit: MAX_OBJECTS });
        }
        if let Some(name) = &object.unique_name
            && let Some(existing) = self.find(name)
            && object.check().is_ok()
        {
            let name = name.clone();
            return Err(EnvError::NameTaken { name, object: existing });
        }
        // Without a seed, random numbers depend on the initial positions of the objects. If that seed is not known yet, nothing
        // has used it, so it is computed before the new object is added.
        let mut seed = self.seed.clone();
        seed.resolve(&self.world);
        let refused = |problem| EnvError::BadObject { problem };
        Arc::make_mut(&mut self.world).push(object).map_err(refused)?;
        self.seed = seed;
        let object = &self.world.objects[index];
        self.state.add_object(object, &self.seed, &mut self.identities);
        self.state.sequence.add(index, object.order);
        self.views.scene.add(object);
        self.views.sync_object(index, object, &self.state.objects[index]);
        self.tags.push(object.tag.as_deref().map(Arc::from));
        self.had_targets |= object.is_target();
        Ok(index)
    }

    /// Removes an object from the running world for good: it pays nothing and does not respawn. It counts as collected, so that
    /// its sequence, if any, can continue. Its index is not reused.
    ///
    /// # Errors
    /// [`EnvError::NoSuchObject`] if there is no such object, and [`EnvError::AlreadyGone`] if it is already gone. On error
    /// nothing is changed.
    pub fn destroy(&mut self, object: usize) -> Result<(), EnvError> {
        let count = self.state.objects.len();
        if object >= count {
            return Err(EnvError::NoSuchObject { found: object, count });
        }
        let is_pending = |(index, _): &(usize, u64)| *index == object;
        let state = &mut self.state;
        let is_carried = state.objects[object].carried;
        if !state.objects[object].present && !is_carried && !state.returning.iter().any(is_pending) {
            return Err(EnvError::AlreadyGone { object });
        }
        state.carried.retain(|carried| *carried as usize != object);
        state.objects[object].carried = false;
        state.returning.retain(|pending| !is_pending(pending));
        (state.objects[object].present, state.objects[object].collected) = (false, true);
        state.advance_sequence();
        state.contacts.retain(|contact| *contact as usize != object);
        self.views
            .sync_object(object, &self.world.objects[object], &state.objects[object]);
        Ok(())
    }

    /// Moves the agent to another position, with a heading in degrees clockwise from +y (values beyond a full turn are
    /// allowed).
    ///
    /// It arrives at rest. Objects and zones that it touches, is near or is inside on arrival trigger no events: only contacts
    /// made by the agent's own motion give rewards.
    ///
    /// # Errors
    /// [`EnvError::NoRoom`] for positions outside the arena, in walls, in regions that cannot be entered and in solid objects;
    /// [`EnvError::NoHeading`] for a heading that is not finite. On error the agent stays where it is.
    pub fn teleport(&mut self, position: [f64; 2], heading_deg: f64) -> Result<(), EnvError> {
        if !heading_deg.is_finite() {
            return Err(EnvError::NoHeading { found: heading_deg });
        }
        if let Some(found) = walls::agent_obstacle(self.sim(), position) {
            let width = self.world.agent_params.agent_width;
            return Err(EnvError::NoRoom { position, found, width });
        }
        let agent = &mut self.state.agent;
        agent.position = position.map(|metres| metres as f32);
        agent.heading_deg = wrapped(heading_deg.rem_euclid(360.0) as f32);
        agent.velocity = [0.0; 2];
        follow(&mut self.state);
        init_contacts(&self.world, &mut self.state, &mut self.views);
        self.views.zones.locate(&mut self.state);
        Ok(())
    }
}
