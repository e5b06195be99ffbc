//! Changing a world while it runs, from outside: new objects, fewer objects, another place for the agent. What the
//! agent itself changes is in `interactions.rs`.

use std::sync::Arc;

use driftworld_spec::{MAX_OBJECTS, Object};

use super::environment::Environment;
use super::interactions::init_contacts;
use super::state::wrapped;
use super::walls;
use crate::EnvError;

impl Environment {
    /// The index of the object of this `unique_name`, whether it is there now or not.
    pub fn find(&self, unique_name: &str) -> Option<usize> {
        let named = |object: &Object| object.unique_name.as_deref() == Some(unique_name);
        self.world.objects.iter().position(named)
    }

    /// Puts a new object into the running world and hands back its index: the next number, for indices stay as they
    /// are.
    ///
    /// It stands wherever it is put, even in a wall. If it stands where the agent is, the next step is its first
    /// contact.
    ///
    /// # Errors
    /// [`EnvError::BadObject`] where a document with this object would be refused, [`EnvError::NameTaken`], and
    /// [`EnvError::TooManyObjects`] beyond [`MAX_OBJECTS`], the destroyed ones among them. On error nothing is changed.
    pub fn spawn(&mut self, object: Object) -> Result<usize, EnvError> {
        let index = self.world.objects.len();
        if index >= MAX_OBJECTS {
            return Err(EnvError::TooManyObjects { limit: MAX_OBJECTS });
        }
        if let Some(name) = &object.unique_name
            && let Some(first) = self.find(name)
            && object.check().is_ok()
        {
            let name = name.clone();
            return Err(EnvError::NameTaken { name, object: first });
        }
        // Without a seed, random numbers depend on where things stood before anything was spawned. Where it was not
        // known, nothing has drawn from it.
        let mut seed = self.seed.clone();
        seed.learn(&self.world);
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

    /// Takes an object out of the running world for good: it pays nothing, and does not come back.
    ///
    /// It counts as collected, so that a sequence of which it was a part can go on. Its index stays taken.
    ///
    /// # Errors
    /// [`EnvError::NoSuchObject`], and [`EnvError::AlreadyGone`] where there is nothing to take away; nothing is
    /// changed then.
    pub fn destroy(&mut self, object: usize) -> Result<(), EnvError> {
        let count = self.state.objects.len();
        if object >= count {
            return Err(EnvError::NoSuchObject { found: object, count });
        }
        let comes_back = |(index, _): &(usize, u64)| *index == object;
        let state = &mut self.state;
        let is_carried = state.objects[object].carried;
        if !state.objects[object].present && !is_carried && !state.returning.iter().any(comes_back) {
            return Err(EnvError::AlreadyGone { object });
        }
        state.carried.retain(|carried| *carried as usize != object);
        state.objects[object].carried = false;
        state.returning.retain(|pending| !comes_back(pending));
        (state.objects[object].present, state.objects[object].collected) = (false, true);
        state.advance_sequence();
        state.contacts.retain(|contact| *contact as usize != object);
        self.views
            .sync_object(object, &self.world.objects[object], &state.objects[object]);
        Ok(())
    }

    /// Puts the agent somewhere else, looking along a heading in degrees clockwise from +y; any number of turns.
    ///
    /// It arrives at rest. What it touches there, is near to or in, is no news: only what it meets by its own motion pays.
    ///
    /// # Errors
    /// [`EnvError::NoRoom`] for places outside the arena, in walls, in regions that cannot be entered and in solid
    /// objects; [`EnvError::NoHeading`] for one that is not finite. On error it stays where it is.
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
        init_contacts(&self.world, &mut self.state, &mut self.views);
        self.views.zones.locate(&mut self.state);
        Ok(())
    }
}
