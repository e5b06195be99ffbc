//! Writing a running world down as a world, and going on from it. The form that stays in memory is in `snapshot.rs`.

use std::sync::Arc;

use driftworld_spec::{AgentParams, Object, ObjectProgress, Origin, Progress, World};

use super::environment::Environment;
use super::mover::Mover;
use super::state::wrapped;
use crate::agents::OnRailsAgent;

/// What a world that was written down says of its course, when the world itself has been taken back to its start.
pub(super) struct ResumeState {
    progress: Progress,
    agent: ([f32; 2], f32),
    /// Where each object stands and faces, and what it is worth.
    objects: Vec<([f32; 2], f32, f64)>,
}

impl Environment {
    /// The world as it is now, as a document: objects where they stand with the rewards that are left, and in `progress` all
    /// else that a reset to it needs to go on as if nothing had been.
    ///
    /// Destroyed objects are among the objects, so that numbers stay; their progress says that they are not there.
    ///
    /// # Example
    /// ```
    /// use driftworld_env::{Action, Environment};
    /// use driftworld_spec::World;
    /// let mut environment = Environment::new(World::default())?;
    /// environment.step(Action::Continuous([10.0, 90.0, 0.0]))?;
    /// let written = environment.state().to_json();
    /// let read = World::from_json("state", &written).expect("a state is a sound world");
    /// assert_eq!(Environment::new(read)?.agent(), environment.agent());
    /// # Ok::<(), driftworld_env::EnvError>(())
    /// ```
    pub fn state(&self) -> World {
        let mut world = (*self.world).clone();
        let agent = self.episode.agent;
        let start = &world.agent_params;
        let now = self.agent_now();
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
            .map(|(index, object)| self.note_object(index, object))
            .collect();
        let episode = &self.episode;
        world.progress = Some(Progress {
            seed: self.seed.hash().map(str::to_owned),
            steps: episode.steps,
            ticks: episode.ticks,
            episode_return: episode.earned,
            unshaped_return: episode.unshaped,
            last_reward: episode.last_reward,
            last_event: episode.last_event,
            ended: episode.ended,
            velocity: agent.velocity.map(f64::from),
            origin,
            chance: None,
            rails: episode.rails.as_ref().map(OnRailsAgent::progress),
            objects,
        });
        world
    }

    /// The agent of the world, where it is now: to the bit where it started if it is there.
    pub(crate) fn agent_now(&self) -> AgentParams {
        let agent = self.episode.agent;
        let mut now = self.world.agent_params.clone();
        let stands = now.coordinates.map(|metres| metres as f32) == agent.position
            && wrapped(now.heading as f32) == agent.heading_deg;
        if !stands {
            now.coordinates = agent.position.map(f64::from);
            now.heading = f64::from(agent.heading_deg);
        }
        now
    }

    /// An object of the world, where it is now and with what is left of its reward.
    pub(crate) fn object_now(&self, index: usize) -> Object {
        let mut now = self.world.objects[index].clone();
        self.put_where_it_is(index, &mut now);
        now
    }

    /// Puts an object where it is now; hands back where it was if that is elsewhere.
    fn put_where_it_is(&self, index: usize, object: &mut Object) -> Option<Origin> {
        let state = &self.episode.objects[index];
        let item = &self.scene.items[index];
        let stands = object.coordinates.map(|metres| metres as f32) == item.position
            && object.heading as f32 == item.heading_deg
            && object.reward == state.reward;
        let origin = (!stands).then_some(Origin {
            coordinates: object.coordinates,
            heading: object.heading,
            reward: object.reward,
        });
        if !stands {
            object.coordinates = item.position.map(f64::from);
            object.heading = f64::from(item.heading_deg);
            object.reward = state.reward;
        }
        origin
    }

    /// How far an object has come; the object is put where it is now.
    fn note_object(&self, index: usize, object: &mut Object) -> ObjectProgress {
        let state = &self.episode.objects[index];
        let origin = self.put_where_it_is(index, object);
        let episode = &self.episode;
        // All of these lists rise.
        let mover = episode.movers.binary_search_by_key(&index, |mover| mover.object);
        let pushed = episode.pushed.binary_search_by_key(&index, |body| body.object);
        let returns = episode.returning.binary_search_by_key(&index, |(other, _)| *other);
        let rng = episode.rngs.binary_search_by_key(&index, |rng| rng.object);
        let mover = mover.ok().map(|place| &episode.movers[place]);
        let pushed = pushed.ok().map(|place| &episode.pushed[place]);
        let returns = returns.ok().map(|place| episode.returning[place]);
        let rng = rng.ok().map(|place| &episode.rngs[place]);
        let (waypoint, goal, goals) = mover.map_or((0, None, 0), Mover::progress);
        ObjectProgress {
            present: state.present,
            collected: state.collected,
            touched: self.touches(index),
            in_range: state.in_range,
            origin,
            returns_at: returns.map(|(_, tick)| tick),
            goal,
            waypoint,
            goals,
            pulls: rng.map_or(0, |rng| rng.pulls),
            returns: rng.map_or(0, |rng| rng.returns),
            tries: rng.map_or(0, |rng| rng.tries),
            chance: None,
            velocity: pushed
                .filter(|body| body.velocity != [0.0; 2])
                .map(|body| body.velocity.map(f64::from)),
            spin: pushed.map_or(0.0, |body| f64::from(body.spin_deg)),
        }
    }

    /// Goes on from where a world had come when it was written down. This environment is at the start of that world.
    pub(super) fn resume(&mut self, came: &ResumeState) {
        let progress = &came.progress;
        let episode = &mut self.episode;
        (episode.agent.position, episode.agent.heading_deg) = came.agent;
        episode.agent.velocity = progress.velocity.map(|speed| speed as f32);
        (episode.steps, episode.ticks) = (progress.steps, progress.ticks);
        (episode.earned, episode.unshaped) = (progress.episode_return, progress.unshaped_return);
        (episode.last_reward, episode.last_event) = (progress.last_reward, progress.last_event);
        episode.ended = progress.ended;
        if episode.rails.is_some()
            && let Some(rails) = &progress.rails
        {
            let resumed = OnRailsAgent::resumed(rails, &self.world, &self.scene);
            self.episode.rails = Some(resumed);
        }
        self.episode.contacts.clear();
        for (index, own) in progress.objects.iter().enumerate().take(self.world.objects.len()) {
            self.resume_object(index, own, came.objects[index]);
        }
        self.episode.sequence.advance(&self.episode.objects);
    }

    fn resume_object(&mut self, index: usize, own: &ObjectProgress, now: ([f32; 2], f32, f64)) {
        let (position, heading_deg, reward) = now;
        let state = &mut self.episode.objects[index];
        (state.present, state.collected, state.in_range) = (own.present, own.collected, own.in_range);
        state.reward = reward;
        let item = &mut self.scene.items[index];
        (item.position, item.heading_deg) = (position, heading_deg);
        (item.reward, item.visible) = (reward as f32, own.present);
        if own.touched {
            self.episode.contacts.push(index as u32);
        }
        self.episode.returning.extend(own.returns_at.map(|tick| (index, tick)));
        let movers = &mut self.episode.movers;
        if let Ok(place) = movers.binary_search_by_key(&index, |mover| mover.object) {
            movers[place].resume(own.waypoint, own.goal, own.goals);
        }
        if let Some(rng) = self.episode.rng_of(index) {
            (rng.pulls, rng.returns, rng.tries) = (own.pulls, own.returns, own.tries);
        }
        if let Some(body) = self.episode.pushed_of(index) {
            body.velocity = own
                .velocity
                .map_or([0.0; 2], |velocity| velocity.map(|speed| speed as f32));
            body.spin_deg = own.spin as f32;
        }
        self.ground.remove(index as u32);
        if own.present {
            self.ground
                .add_object(index as u32, item, self.world.objects[index].solid);
        }
    }
}

impl ResumeState {
    /// Takes a world's progress out of it, and the world back to its start.
    pub(super) fn out_of(world: &mut Arc<World>) -> Self {
        let world = Arc::make_mut(world);
        let progress = world.progress.take().unwrap_or_default();
        let agent = &mut world.agent_params;
        let place = (
            agent.coordinates.map(|metres| metres as f32),
            wrapped(agent.heading as f32),
        );
        if let Some(origin) = &progress.origin {
            (agent.coordinates, agent.heading) = (origin.coordinates, origin.heading);
        }
        let mut objects = Vec::with_capacity(world.objects.len());
        let own = progress.objects.iter().map(Some).chain(std::iter::repeat(None));
        for (object, own) in world.objects.iter_mut().zip(own) {
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
        Self {
            progress,
            agent: place,
            objects,
        }
    }

    /// Whether the world ran before: progress that says no more than a seed is that of a start.
    pub(super) fn has_begun(&self) -> bool {
        let only_seed = Progress {
            seed: self.progress.seed.clone(),
            ..Progress::default()
        };
        self.progress != only_seed
    }

    /// The hash of the places of things at the start of the world, if random numbers depend on it and have been asked for.
    pub(super) fn seed(&self) -> Option<String> {
        self.progress.seed.clone()
    }
}
