//! What objects do by themselves between the agent's steps: moving, and coming back. Where each wants to go is in `mover.rs`.

use super::budget::{self, Budget, SharedBudget};
use super::environment::Environment;
use super::mover::View;
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
        let count = budget::MOVERS + budget::EACH_MOVER * movers.len() as u64;
        let mut budget = SharedBudget::new(count, movers.len(), self.episode.ticks);
        for (place, mover) in movers.iter_mut().enumerate() {
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
                let pose = self.ground.push(index as u32, stride.by, turn, budget.at(place));
                if let Some(pose) = pose {
                    (item.position, item.heading_deg) = pose;
                    mover.moved(stride.by, [0, 1].map(|axis| item.position[axis] - from[axis]));
                }
            }
            self.note_mover(index, from);
        }
        self.episode.movers = movers;
        #[cfg(test)]
        (self.scratch.looked += count - budget.left());
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
    pub(super) fn respawn(&mut self) {
        let now = self.episode.ticks;
        let mut returning = std::mem::take(&mut self.episode.returning);
        let waiting = returning.len();
        let count = budget::RETURNS + budget::EACH_RETURN * waiting as u64;
        let mut budget = SharedBudget::new(count, waiting, now);
        let per_place = if waiting > 0 { 1 + self.num_wall_corners() } else { 0 };
        let mut place = 0;
        returning.retain(|&(index, due)| {
            place += 1;
            due > now || !self.try_respawn(index, per_place, budget.at(place - 1))
        });
        self.episode.returning = returning;
        #[cfg(test)]
        (self.scratch.looked += count - budget.left());
    }

    /// How many corners the walls of the world have.
    fn num_wall_corners(&self) -> usize {
        let environment = &self.world.environment_params;
        let regions: usize = environment.regions().into_iter().map(<[_]>::len).sum();
        regions + environment.walls.iter().map(|wall| wall.polygon.len()).sum::<usize>()
    }

    /// Puts an object back at a free place; false if none is found in this step. Each place that is tried takes
    /// `per_place` looks.
    fn try_respawn(&mut self, index: usize, per_place: usize, budget: &mut Budget) -> bool {
        /// Places tried in one step.
        const TRIES: u32 = 16;
        let object = &self.world.objects[index];
        let Some(respawn) = &object.respawn else { return true };
        self.ground.place_agent(self.episode.agent.position);
        let radius = self.scene.items[index].asset.collider.radius() * self.scene.items[index].scale;
        let first = object.coordinates.map(|metres| metres as f32);
        for _ in 0..TRIES {
            if !budget.take(per_place) {
                return false;
            }
            // What comes back has its random numbers: they are made with the episode, or when it is spawned.
            let Some(rng) = self.episode.rng_of(index) else {
                return true;
            };
            let [out, around] = rng.draw_place().map(|unit| unit as f32);
            let distance = respawn.radius as f32 * out.sqrt();
            let angle = std::f32::consts::TAU * around;
            let place = [
                first[0] + distance * libm::cosf(angle),
                first[1] + distance * libm::sinf(angle),
            ];
            let in_wall = walls::obstacle(&self.world, place.map(f64::from), f64::from(radius)).is_some();
            if !in_wall && self.ground.is_free(place, radius, budget) {
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
                if let Some(rng) = self.episode.rng_of(index) {
                    rng.note_return();
                }
                if let Some(body) = self.episode.pushed_of(index) {
                    (body.velocity, body.spin_deg) = ([0.0; 2], 0.0);
                }
                return true;
            }
        }
        false
    }
}
