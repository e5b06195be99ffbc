//! What the agent's motion sets off: stimuli, what they pay, what they destroy. Endings are in `termination.rs`.

use std::sync::Arc;

use driftworld_spec::Stimulus;

use super::action::Intent;
use super::contact::RELEASE;
use super::environment::{Environment, Scratch};
use super::event::{Event, Step};
use super::streams::ObjectRng;

impl Environment {
    /// Finds what the time step set off, and pays for it. `scratch.met` holds what the agent met on its way, and what met it.
    pub(super) fn apply_stimuli(&mut self, intent: Intent, step: &mut Step) {
        let mut scratch = std::mem::take(&mut self.scratch);
        scratch.triggered.clear();
        scratch.triggered.reserve(32);
        scratch.moved.sort_unstable_by_key(|(index, _)| *index);
        scratch.arrived.sort_unstable();
        self.update_contacts(&mut scratch);
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
            let reach = self.world.objects[index].range_stimulus_distance;
            if reach <= 0.0 {
                continue;
            }
            let was = self.episode.objects[index].in_range;
            let enters = !was && self.comes_near(index, &scratch);
            if enters {
                scratch.triggered.push((index as u32, Stimulus::AgentInRange));
            }
            self.episode.objects[index].in_range = (was || enters) && self.is_within(index, reach + RELEASE);
        }
        scratch.triggered.sort_unstable();
        scratch.triggered.dedup();
        let num_returning = self.episode.returning.len();
        for &(index, stimulus) in &scratch.triggered {
            self.trigger(index as usize, stimulus, step);
        }
        if self.episode.returning.len() > num_returning {
            self.episode.returning.sort_unstable_by_key(|(index, _)| *index);
        }
        let objects = &self.episode.objects;
        self.episode
            .contacts
            .retain(|contact| objects[*contact as usize].present);
        self.scratch = scratch;
    }

    /// Contacts that begin and that end.
    fn update_contacts(&mut self, scratch: &mut Scratch) {
        let here = self.episode.agent.position;
        self.ground.note_touching(here, &mut scratch.met);
        scratch.met.sort_unstable();
        scratch.met.dedup();
        let contacts = &mut self.episode.contacts;
        contacts.reserve(scratch.met.len().max(16));
        let known = contacts.len();
        for index in scratch.met.drain(..) {
            if contacts[..known].binary_search(&index).is_err() {
                scratch.triggered.push((index, Stimulus::AgentCollide));
                contacts.push(index);
            }
        }
        contacts.sort_unstable();
        let (new, moved) = (&scratch.triggered, &scratch.moved);
        let stays = |index: &u32| {
            // What was met in front of the agent, and moved on since, was touched when the agent had moved.
            let is_new = new.binary_search_by_key(index, |(other, _)| *other).is_ok();
            let has_moved = || {
                moved
                    .binary_search_by_key(&(*index as usize), |(other, _)| *other)
                    .is_ok()
            };
            is_new && has_moved()
                || scratch.kept.binary_search(index).is_ok()
                || self.ground.is_still_touched(*index, here)
        };
        contacts.retain(stays);
    }

    /// Whether the agent is in an object's range anywhere on both their ways of this time step.
    fn comes_near(&self, index: usize, scratch: &Scratch) -> bool {
        if scratch.arrived.binary_search(&index).is_ok() || self.is_in_range(index) {
            return self.is_in_range(index);
        }
        let to = self.scene.items[index].position.map(f64::from);
        let nearest = if let Ok(place) = scratch.moved.binary_search_by_key(&index, |(other, _)| *other) {
            // As the agent sees it, the object comes from where it was then to where it is now.
            let from = scratch.moved[place].1.map(f64::from);
            let (began, ends) = (self.ground.began(), self.episode.agent.position);
            let then = [0, 1].map(|axis| from[axis] - f64::from(began[axis]));
            let now = [0, 1].map(|axis| to[axis] - f64::from(ends[axis]));
            squared_distance([0.0; 2], then, now)
        } else {
            let path = self.ground.path().windows(2);
            path.map(|ends| squared_distance(to, ends[0], ends[1]))
                .fold(f64::INFINITY, f64::min)
        };
        self.is_range(index, nearest, self.world.objects[index].range_stimulus_distance)
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
        // An arm that always pays draws nothing.
        let pull = |rng: &mut ObjectRng| rng.pull(odds);
        let pays = would_pay && due && self.episode.rng_of(index).is_none_or(pull);
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
        self.episode.sequence.advance(&self.episode.objects);
        let state = &mut self.episode.objects[index];
        if pays && once {
            state.reward = 0.0;
            self.scene.items[index].reward = 0.0;
        }
        if destroyed {
            self.remove_body(index);
            if let Some(respawn) = &object.respawn {
                let ticks = (respawn.delay / world.agent_params.time_step).ceil() as u64;
                let back = (index, self.episode.ticks + ticks.max(1));
                self.episode.returning.push(back);
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
        self.episode.sequence.is_due(order)
    }

    /// Centre to centre in 3D: the agent's at half its height, the object's at half of its own.
    pub(super) fn is_in_range(&self, index: usize) -> bool {
        self.is_within(index, self.world.objects[index].range_stimulus_distance)
    }

    fn is_within(&self, index: usize, reach: f64) -> bool {
        let [x, y] = self.way_to(index).map(f64::from);
        self.is_range(index, x * x + y * y, reach)
    }

    /// Whether so much reach covers a distance on the ground, whose square is given.
    fn is_range(&self, index: usize, squared: f64, reach: f64) -> bool {
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
