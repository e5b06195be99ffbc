//! What objects do by themselves between the agent's steps: moving, and coming back. Where each wants to go is in `motion.rs`.

use super::environment::Environment;
use super::motion::View;
use super::walls;

impl Environment {
    /// Lets every object that moves by itself go its way.
    pub(super) fn move_objects(&mut self) {
        if self.episode.movers.is_empty() {
            return;
        }
        self.ground.place_agent(self.episode.agent.position);
        let half = self.scene.arena_size().map(|side| side / 2.0);
        let seconds = self.world.agent_params.time_step as f32;
        let mut movers = std::mem::take(&mut self.episode.movers);
        for mover in &mut movers {
            let index = mover.object;
            if !self.episode.objects[index].present {
                continue;
            }
            let item = &mut self.scene.items[index];
            let from = item.position;
            let view = View {
                position: from,
                heading_deg: item.heading_deg,
                agent: self.episode.agent.position,
                half,
                seconds,
            };
            if let Some(stride) = mover.decide(&self.world.objects[index], view) {
                let turn = [item.heading_deg, stride.heading_deg];
                // Where the body is, the item is, to the last bit: a world that was written down has nothing else to go on from.
                if let Some(pose) = self.ground.push(index as u32, stride.by, turn) {
                    (item.position, item.heading_deg) = pose;
                    mover.moved(stride.by, [0, 1].map(|axis| item.position[axis] - from[axis]));
                }
            }
            self.note_mover(index, from);
        }
        self.episode.movers = movers;
    }

    /// Notes what an object that moves by itself, and came from a place, met on its way.
    fn note_mover(&mut self, index: usize, from: [f32; 2]) {
        let to = self.scene.items[index].position;
        let came = [0, 1].map(|axis| to[axis] - from[axis]);
        let (began, ends) = (self.ground.began(), self.episode.agent.position);
        if came != [0.0; 2] {
            self.scratch.moved.push((index, from));
        }
        // The agent and a ghost go their ways at once; a solid body stops for the agent, and moves when that has moved.
        if !self.world.objects[index].solid {
            self.ground
                .note_passing(index as u32, came, [began, ends], &mut self.scratch.met);
        } else if came != [0.0; 2] {
            self.ground
                .note_passing(index as u32, came, [ends, ends], &mut self.scratch.met);
        }
    }

    /// Puts back the destroyed objects whose time has come: near their first place, where nothing stands.
    pub(super) fn bring_back(&mut self) {
        let now = self.episode.ticks;
        let mut next = 0;
        while let Some(&(index, due)) = self.episode.returning.get(next) {
            if due <= now && self.put_back(index) {
                self.episode.returning.remove(next);
            } else {
                next += 1;
            }
        }
    }

    /// Puts an object back at a free place; false if none is found in this step.
    fn put_back(&mut self, index: usize) -> bool {
        /// Places tried in one step.
        const TRIES: u32 = 16;
        let object = &self.world.objects[index];
        let Some(respawn) = &object.respawn else { return true };
        self.ground.place_agent(self.episode.agent.position);
        let radius = self.scene.items[index].asset.collider.radius() * self.scene.items[index].scale;
        let first = object.coordinates.map(|metres| metres as f32);
        for _ in 0..TRIES {
            // What comes back has luck: it is made with the episode, or when it is spawned.
            let Some(luck) = self.episode.luck_of(index) else {
                return true;
            };
            let [out, around] = luck.place().map(|unit| unit as f32);
            let distance = respawn.radius as f32 * out.sqrt();
            let angle = std::f32::consts::TAU * around;
            let place = [
                first[0] + distance * libm::cosf(angle),
                first[1] + distance * libm::sinf(angle),
            ];
            let in_wall = walls::obstacle(&self.world, place.map(f64::from), f64::from(radius)).is_some();
            if !in_wall && self.ground.is_free(place, radius) {
                self.ground.remove(index as u32);
                let item = &mut self.scene.items[index];
                item.position = place;
                item.heading_deg = object.heading as f32;
                item.reward = object.reward as f32;
                item.visible = true;
                self.ground.add_object(index as u32, item, object.solid);
                let state = &mut self.episode.objects[index];
                (state.present, state.reward, state.in_range) = (true, object.reward, false);
                self.scratch.arrived.push(index);
                if let Some(luck) = self.episode.luck_of(index) {
                    luck.came_back();
                }
                if let Some(body) = self.episode.pushed.iter_mut().find(|body| body.object == index) {
                    (body.velocity, body.spin_deg) = ([0.0; 2], 0.0);
                }
                return true;
            }
        }
        false
    }
}
