//! What the agent's motion sets off: stimuli, what they pay, what they destroy. Endings are in `judge.rs`.

use std::sync::Arc;

use driftworld_spec::{Object, Stimulus};

use super::action::Intent;
use super::chance::Luck;
use super::environment::Environment;
use super::event::{Event, Step};

impl Environment {
    /// Finds what the time step set off, and pays for it. `scratch.met` holds what the agent met on its way, and what met it;
    /// `scratch.entered` the objects whose range was entered on the way.
    pub(super) fn answer(&mut self, intent: Intent, step: &mut Step) {
        let mut scratch = std::mem::take(&mut self.scratch);
        let here = self.episode.agent.position;
        self.ground.note_touching(here, &mut scratch.met);
        scratch.triggered.clear();
        scratch.triggered.reserve(32);
        let contacts = &mut self.episode.contacts;
        contacts.reserve(scratch.met.len().max(16));
        for index in scratch.met.drain(..) {
            if let Err(place) = contacts.binary_search(&index) {
                scratch.triggered.push((index, Stimulus::AgentCollide));
                contacts.insert(place, index);
            }
        }
        contacts.retain(|index| self.ground.is_still_touched(*index, here));
        if intent.interact {
            let agent = &self.episode.agent;
            self.ground
                .in_reach(agent.position, agent.forward(), &mut scratch.reached);
            let reached = scratch.reached.iter();
            scratch
                .triggered
                .extend(reached.map(|index| (*index, Stimulus::AgentInteract)));
        }
        let entered = scratch.entered.drain(..);
        scratch
            .triggered
            .extend(entered.map(|index| (index, Stimulus::AgentInRange)));
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

    /// Notes the objects into whose range the agent's way of this time step leads, even if it leads out again.
    pub(super) fn pass_ranges(&mut self) {
        for index in 0..self.episode.objects.len() {
            if self.world.objects[index].range_stimulus_distance > 0.0 && !self.episode.objects[index].in_range {
                let [x, y] = self.scene.items[index].position.map(f64::from);
                let path = self.ground.path().windows(2);
                let nearest = path
                    .map(|ends| squared_distance([x, y], ends[0], ends[1]))
                    .fold(f64::INFINITY, f64::min);
                if self.is_range(index, nearest) {
                    self.scratch.entered.push(index as u32);
                }
            }
        }
    }

    /// Notes an object that came from another place to where it is now, if the agent was in its range on the way.
    pub(super) fn pass_range_of(&mut self, index: usize, from: [f32; 2]) {
        if self.world.objects[index].range_stimulus_distance > 0.0 && !self.episode.objects[index].in_range {
            let to = self.scene.items[index].position.map(f64::from);
            let agent = self.episode.agent.position.map(f64::from);
            let nearest = squared_distance(agent, from.map(f64::from), to);
            if self.is_range(index, nearest) {
                self.scratch.entered.push(index as u32);
            }
        }
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
        let odds = object.reward_probability;
        // An arm that always pays has no luck of its own, and needs none.
        let lucky = |luck: &mut Luck| luck.pull(odds);
        let pays = would_pay && due && self.episode.luck_of(index).is_none_or(lucky);
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
        if self.world.objects[index].range_stimulus_distance <= 0.0 {
            return false;
        }
        let [x, y] = self.way_to(index).map(f64::from);
        self.is_range(index, x * x + y * y)
    }

    /// Whether an object's range reaches so far on the ground; the square of the distance in metres is given.
    fn is_range(&self, index: usize, squared: f64) -> bool {
        let reach = self.world.objects[index].range_stimulus_distance;
        if reach <= 0.0 || !self.episode.objects[index].present {
            return false;
        }
        let item = &self.scene.items[index];
        let height = f64::from(item.asset.height * item.scale);
        let dz = (height - self.world.agent_params.agent_height) / 2.0;
        squared + dz * dz < reach * reach
    }
}

/// The square of the distance of a point from a straight way.
fn squared_distance(point: [f64; 2], from: [f64; 2], to: [f64; 2]) -> f64 {
    let way = [to[0] - from[0], to[1] - from[1]];
    let off = [point[0] - from[0], point[1] - from[1]];
    let length = way[0] * way[0] + way[1] * way[1];
    let share = if length > 0.0 {
        ((off[0] * way[0] + off[1] * way[1]) / length).clamp(0.0, 1.0)
    } else {
        0.0
    };
    let [x, y] = [0, 1].map(|axis| off[axis] - way[axis] * share);
    x * x + y * y
}
