//! What the agent's motion sets off: stimuli, what they pay, what they destroy. Endings are in `judge.rs`.

use std::sync::Arc;

use driftworld_spec::{Object, Stimulus};
use rand::RngExt;

use super::action::Intent;
use super::environment::Environment;
use super::event::{Event, Step};

impl Environment {
    /// Finds what the time step set off, and pays for it. `scratch.met` holds what the agent met on its way.
    pub(super) fn answer(&mut self, intent: Intent, step: &mut Step) {
        let mut scratch = std::mem::take(&mut self.scratch);
        self.ground.touching(self.episode.agent.position, &mut scratch.touching);
        scratch.triggered.clear();
        let contacts = scratch.met.iter().chain(&scratch.touching);
        scratch.triggered.extend(
            contacts
                .filter(|index| !self.episode.contacts.contains(index))
                .map(|index| (*index, Stimulus::AgentCollide)),
        );
        std::mem::swap(&mut self.episode.contacts, &mut scratch.touching);
        if intent.interact {
            let agent = &self.episode.agent;
            self.ground
                .in_reach(agent.position, agent.forward(), &mut scratch.reached);
            let reached = scratch.reached.iter();
            scratch
                .triggered
                .extend(reached.map(|index| (*index, Stimulus::AgentInteract)));
        }
        for index in 0..self.episode.objects.len() {
            let now = self.is_in_range(index);
            if now && !self.episode.objects[index].in_range {
                scratch.triggered.push((index as u32, Stimulus::AgentInRange));
            }
            self.episode.objects[index].in_range = now;
        }
        scratch.triggered.sort_unstable();
        scratch.triggered.dedup();
        for &(index, stimulus) in &scratch.triggered {
            self.trigger(index as usize, stimulus, step);
        }
        self.scratch = scratch;
    }

    /// One stimulus on one object: what it pays, whether it destroys.
    fn trigger(&mut self, index: usize, stimulus: Stimulus, step: &mut Step) {
        if !self.episode.objects[index].present {
            return;
        }
        let world = Arc::clone(&self.world);
        let object = &world.objects[index];
        let once = object.reward_once_stimulus.contains(&stimulus);
        let would_pay = once || object.reward_stimulus.contains(&stimulus);
        // Out of its turn an object neither pays nor goes: the sequence could not be finished otherwise.
        let due = self.is_due(object.order);
        let destroyed = due && object.destroy_stimulus.contains(&stimulus);
        let pays = would_pay
            && due
            && (object.reward_probability >= 1.0 || self.episode.chance.random::<f64>() < object.reward_probability);
        let reward = if pays {
            self.episode.objects[index].reward
        } else if would_pay && !due {
            world.rules.order_penalty
        } else {
            0.0
        };
        step.reward += reward;
        let state = &mut self.episode.objects[index];
        state.collected |= pays || destroyed;
        if pays && once {
            state.reward = 0.0;
            self.scene.items[index].reward = 0.0;
        }
        if destroyed {
            self.take_away(index);
            if let Some(respawn) = &object.respawn {
                let ticks = (respawn.delay / world.agent_params.time_step).ceil() as u64;
                let back = (index, self.episode.ticks + ticks.max(1));
                let place = self.episode.returning.partition_point(|(other, _)| *other < index);
                self.episode.returning.insert(place, back);
            }
        }
        step.events.push(Event {
            object: index,
            tag: self.tags[index].clone(),
            stimulus,
            reward,
            destroyed,
        });
    }

    /// Whether all objects with a lower place in the sequence have been collected.
    pub(super) fn is_due(&self, order: Option<u32>) -> bool {
        let Some(order) = order else { return true };
        let lower = |object: &Object| object.order.is_some_and(|other| other < order);
        self.world
            .objects
            .iter()
            .zip(&self.episode.objects)
            .all(|(object, state)| !lower(object) || state.collected)
    }

    /// Centre to centre in 3D: the agent's at half its height, the object's at half of its own.
    pub(super) fn is_in_range(&self, index: usize) -> bool {
        let reach = self.world.objects[index].range_stimulus_distance as f32;
        if reach <= 0.0 || !self.episode.objects[index].present {
            return false;
        }
        let item = &self.scene.items[index];
        let [dx, dy] = [0, 1].map(|axis| item.position[axis] - self.episode.agent.position[axis]);
        let dz = (item.asset.height * item.scale - self.world.agent_params.agent_height as f32) / 2.0;
        dx * dx + dy * dy + dz * dz < reach * reach
    }
}
