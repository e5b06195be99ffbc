//! Fuzz target for agent scripts: an accepted script can be played in a small world.

use driftworld_env::{Agent, Environment, ScriptedAgent};
use driftworld_spec::World;

use crate::{refusal, world};

/// Number of steps to play.
const STEPS: usize = 8;

const WORLD: &str = r#"{ "environment_params": { "map_size": [20, 20], "walls": [{ "polygon": [[2, 2], [4, 2], [4, 4]] }] },
    "agent_params": { "observation_size": 8 }, "max_steps": 6,
    "objects": [{ "class": "ball", "coordinates": [0, 5], "tag": "a", "unique_name": "one" },
                { "class": "cube", "coordinates": [-5, 0], "tag": "b", "unique_name": "two", "pushable": { "mass": 1 } }] }"#;

/// An accepted script chooses an action in every step; the environment accepts it, or refuses it with a message.
pub(crate) fn check(bytes: &[u8]) {
    let text = String::from_utf8_lossy(bytes);
    let mut agent = match ScriptedAgent::parse("a.txt", &text) {
        Ok(agent) => agent,
        Err(error) => return refusal::message(&error.to_string()),
    };
    let start = World::from_json("small", WORLD).unwrap_or_else(|_| small());
    let mut environment = Environment::new(start);
    agent.begin(1);
    for _ in 0..STEPS {
        if environment.ended() {
            break;
        }
        let action = agent.act(&environment);
        match environment.step(action) {
            Ok(step) => assert!(step.reward.is_finite()),
            Err(error) => refusal::message(&error.to_string()),
        }
    }
    world::check_round_trip(&environment.state());
}

fn small() -> World {
    let small = World::default().edit(|world| world.agent_params.observation_size = 8);
    small.expect("images may be this small")
}
