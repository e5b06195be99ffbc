//! Helpers for several tests: episodes, walls, and objects with tags.

use driftworld_env::{Action, Agent, Environment, OnRailsAgent, Step};
use driftworld_spec::{Object, Portable, Wall, World, WorldDraft};

/// An environment at the start of its first episode.
pub(crate) fn start(world: WorldDraft) -> Environment {
    Environment::new(world.check().expect("the world is valid"))
}

/// One step, before the episode has ended.
pub(crate) fn step(environment: &mut Environment, action: Action) -> Step {
    environment
        .step(action)
        .expect("the episode is not over and the action is valid")
}

/// A wall with these corners, and with the height and colour of the arena's walls.
pub(crate) fn wall_of(corners: impl Into<Vec<[f64; 2]>>) -> Wall {
    Wall {
        polygon: corners.into(),
        height: None,
        color: None,
    }
}

pub(crate) fn thing(class: &str, tag: &str, at: [f64; 2]) -> Object {
    let mut object = Object::new(class, at);
    object.tag = Some(tag.to_owned());
    object
}

pub(crate) fn key(tag: &str, at: [f64; 2]) -> Object {
    let mut key = thing("key", tag, at);
    key.portable = Some(Portable::default());
    key
}

/// Runs the on-rails agent until the episode ends and calls `look` after every step. Returns the environment and the last step.
pub(crate) fn by_expert(world: World, mut look: impl FnMut(&Environment, &Step)) -> (Environment, Step) {
    let mut environment = Environment::new(world);
    let mut expert = OnRailsAgent::new();
    expert.begin(0);
    loop {
        let action = expert.act(&environment);
        let step = environment.step(action).expect("the expert's actions are valid");
        look(&environment, &step);
        if step.ended() {
            return (environment, step);
        }
    }
}
