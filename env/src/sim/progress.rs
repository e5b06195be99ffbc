//! Saves a running world as a document with its progress, and resumes from such a document.

use std::sync::Arc;

use driftworld_spec::{AgentParams, Object, ObjectProgress, Origin, Progress, RailsProgress, World};

use super::mover::Mover;
use super::rng::Seed;
use super::sim_ref::SimRef;
use super::state::{SimState, entry, wrapped};
use super::views::Views;

/// The progress of a saved world, after the world itself has been restored to its start.
pub(super) struct ResumeState {
    pub(super) progress: Progress,
    agent: ([f32; 2], f32),
    /// Position, heading and reward of each object.
    objects: Vec<([f32; 2], f32, f64)>,
}

/// The current state of a world as a document; see [`Environment::state`](super::Environment::state).
pub(super) fn to_world(sim: SimRef, seed: &Seed, rails: Option<RailsProgress>) -> World {
    let mut world = sim.world.clone().into_draft();
    let agent = sim.agent();
    let start = &world.agent_params;
    let now = agent_now(sim);
    let origin = (now.coordinates != start.coordinates || now.heading != start.heading).then_some(Origin {
        coordinates: start.coordinates,
        heading: start.heading,
        reward: 0.0,
    });
    world.agent_params = now;
    let objects = world
        .objects
        .iter_mut()
        .enumerate()
        .map(|(index, object)| save_object(sim, index, object))
        .collect();
    let state = sim.state;
    world.progress = Some(Progress {
        seed: seed.hash().map(str::to_owned),
        steps: state.steps,
        ticks: state.ticks,
        episode_return: state.earned,
        unshaped_return: state.unshaped,
        last_reward: state.last_reward,
        last_event: state.last_event,
        ended: state.ended,
        velocity: agent.velocity.map(f64::from),
        origin,
        zones: sim.views.zones.entered(state),
        energy: sim.world.agent_params.energy.map(|_| state.energy),
        former_draws: None,
        rails,
        objects,
        carried: state.carried.clone(),
    });
    world.check_in_range().expect("a step keeps a valid world valid")
}

/// The world's agent at its current position and heading; bit for bit as in the world if these are its start.
pub(super) fn agent_now(sim: SimRef) -> AgentParams {
    let agent = sim.agent();
    let mut now = sim.world.agent_params.clone();
    let is_unchanged = now.coordinates.map(|metres| metres as f32) == agent.position
        && wrapped(now.heading as f32) == agent.heading_deg;
    if !is_unchanged {
        now.coordinates = agent.position.map(f64::from);
        now.heading = f64::from(agent.heading_deg);
    }
    now
}

/// A world's object at its current position, with its remaining reward.
pub(super) fn object_now(sim: SimRef, index: usize) -> Object {
    let mut now = sim.world.objects[index].clone();
    apply_current_state(sim, index, &mut now);
    now
}

/// Sets an object's current position, heading and reward; returns the original ones if any of them differs.
fn apply_current_state(sim: SimRef, index: usize, object: &mut Object) -> Option<Origin> {
    let own = &sim.objects()[index];
    let is_unchanged = object.coordinates.map(|metres| metres as f32) == own.position
        && object.heading as f32 == own.heading_deg
        && object.reward == own.reward;
    let origin = (!is_unchanged).then_some(Origin {
        coordinates: object.coordinates,
        heading: object.heading,
        reward: object.reward,
    });
    if !is_unchanged {
        object.coordinates = own.position.map(f64::from);
        object.heading = f64::from(own.heading_deg);
        object.reward = own.reward;
    }
    origin
}

/// The progress of an object; sets its current position, heading and reward.
fn save_object(sim: SimRef, index: usize, object: &mut Object) -> ObjectProgress {
    let own = &sim.objects()[index];
    let origin = apply_current_state(sim, index, object);
    let state = sim.state;
    let mover = entry(&state.movers, index, |mover| mover.object);
    let pushed = entry(&state.pushed, index, |body| body.object);
    let returns = entry(&state.returning, index, |(other, _)| *other);
    let rng = entry(&state.rngs, index, |rng| rng.object);
    let (waypoint, goal, goals) = mover.map_or((0, None, 0), Mover::progress);
    ObjectProgress {
        present: own.present,
        collected: own.collected,
        touched: state.touches(index),
        in_range: own.in_range,
        origin,
        returns_at: returns.map(|(_, tick)| *tick),
        goal,
        waypoint,
        goals,
        pulls: rng.map_or(0, |rng| rng.pulls),
        returns: rng.map_or(0, |rng| rng.returns),
        tries: rng.map_or(0, |rng| rng.tries),
        former_draws: None,
        velocity: pushed
            .filter(|body| body.velocity != [0.0; 2])
            .map(|body| body.velocity.map(f64::from)),
        spin: pushed.map_or(0.0, |body| f64::from(body.spin_deg)),
        open: object
            .door
            .as_ref()
            .filter(|door| door.open != own.open)
            .map(|_| own.open),
        unlocked: state.is_unlocked(index),
        closes_at: state.door_of(index).and_then(|door| door.closes_at),
    }
}

impl ResumeState {
    /// Extracts a world's progress, and restores the world to its start.
    pub(super) fn extract_from(world: &mut Arc<World>) -> Self {
        let mut draft = Arc::unwrap_or_clone(std::mem::take(world)).into_draft();
        let progress = draft.progress.take().unwrap_or_default();
        let agent = &mut draft.agent_params;
        let pose = (
            agent.coordinates.map(|metres| metres as f32),
            wrapped(agent.heading as f32),
        );
        if let Some(origin) = &progress.origin {
            (agent.coordinates, agent.heading) = (origin.coordinates, origin.heading);
        }
        let mut objects = Vec::with_capacity(draft.objects.len());
        let own = progress.objects.iter().map(Some).chain(std::iter::repeat(None));
        for (object, own) in draft.objects.iter_mut().zip(own) {
            objects.push((
                object.coordinates.map(|metres| metres as f32),
                object.heading as f32,
                object.reward,
            ));
            if let Some(origin) = own.and_then(|own| own.origin) {
                (object.coordinates, object.heading) = (origin.coordinates, origin.heading);
                object.reward = origin.reward;
            }
        }
        let start = draft
            .check_in_range()
            .expect("origins are in the ranges of the values that they replace");
        *world = Arc::new(start);
        Self {
            progress,
            agent: pose,
            objects,
        }
    }

    /// Whether the world ran before it was saved. A world at its start has no progress except a seed.
    pub(super) fn has_begun(&self) -> bool {
        let only_seed = Progress {
            seed: self.progress.seed.clone(),
            objects: vec![ObjectProgress::default(); self.progress.objects.len()],
            ..Progress::default()
        };
        self.progress != only_seed
    }

    /// Resumes a saved world; the state and the views must be those of its start.
    pub(super) fn apply(&self, world: &World, state: &mut SimState, views: &mut Views) {
        let progress = &self.progress;
        (state.agent.position, state.agent.heading_deg) = self.agent;
        state.agent.velocity = progress.velocity.map(|speed| speed as f32);
        (state.steps, state.ticks) = (progress.steps, progress.ticks);
        (state.earned, state.unshaped) = (progress.episode_return, progress.unshaped_return);
        (state.last_reward, state.last_event) = (progress.last_reward, progress.last_event);
        state.ended = progress.ended;
        views.zones.resume(&progress.zones, state);
        state.energy = progress.energy.unwrap_or(state.energy);
        for (index, own) in progress.objects.iter().enumerate().take(world.objects.len()) {
            self.apply_to_object(index, own, state);
        }
        state.carried.extend(&progress.carried);
        for index in &progress.carried {
            state.objects[*index as usize].carried = true;
        }
        state.advance_sequence();
        views.sync_objects(world, state);
    }

    fn apply_to_object(&self, index: usize, own: &ObjectProgress, state: &mut SimState) {
        let object = &mut state.objects[index];
        (object.position, object.heading_deg, object.reward) = self.objects[index];
        (object.present, object.collected, object.in_range) = (own.present, own.collected, own.in_range);
        object.open = own.open.unwrap_or(object.open);
        if let Some(door) = state.doors.iter_mut().find(|door| door.object == index) {
            (door.unlocked, door.closes_at) = (own.unlocked, own.closes_at);
        }
        if own.touched {
            state.contacts.push(index as u32);
        }
        state.returning.extend(own.returns_at.map(|tick| (index, tick)));
        if let Ok(place) = state.movers.binary_search_by_key(&index, |mover| mover.object) {
            state.movers[place].resume(own.waypoint, own.goal, own.goals);
        }
        if let Some(rng) = state.rng_of(index) {
            (rng.pulls, rng.returns, rng.tries) = (own.pulls, own.returns, own.tries);
        }
        if let Some(body) = state.pushed_of(index) {
            let velocity = own.velocity.unwrap_or_default();
            body.velocity = velocity.map(|speed| speed as f32);
            body.spin_deg = own.spin as f32;
        }
    }
}
