//! Fuzz target for episodes in edited worlds. Input: a length, that many bytes of edits to a known world, then the agent's
//! actions.

use arbitrary::Unstructured;
use driftworld_env::{Action, Environment, Step};
use driftworld_spec::World;

use crate::edited::byte;
use crate::{refusal, world};

/// Maximum number of objects in a world that is run; other tests cover larger worlds.
const MAX_OBJECTS: usize = 32;

/// Maximum number of steps in an episode.
const MAX_STEPS: usize = 16;

/// The same world and actions give the same episode, and all its numbers are finite. A world that is saved and loaded continues
/// in the same way.
pub(crate) fn check(bytes: &[u8]) {
    let (length, rest) = bytes
        .split_first()
        .map_or((0, bytes), |(length, rest)| (usize::from(*length), rest));
    let (changes, actions) = rest.split_at(length.min(rest.len()));
    let text = world::known().edited(&mut Unstructured::new(changes)).to_string();
    let start = match World::from_json("w.json", &text) {
        Ok(start) => start,
        Err(error) => return refusal::check(&error, &text),
    };
    let start = start.edit(|world| {
        world.objects.truncate(MAX_OBJECTS);
        world.agent_params.observation_size = 8;
    });
    // The truncated world may be invalid.
    let Ok(start) = start else {
        return;
    };
    let (mut first, mut second) = (Environment::new(start.clone()), Environment::new(start));
    let mut actions = Unstructured::new(actions);
    for _ in 0..MAX_STEPS {
        if actions.is_empty() || first.ended() {
            break;
        }
        let action = action(&mut actions, &first);
        let outcome = step(&mut first, action);
        assert_eq!(
            outcome,
            step(&mut second, action),
            "the same world and actions give the same step"
        );
        assert_eq!(
            moment(&first),
            moment(&second),
            "the same world and actions give the same state"
        );
        if byte(&mut actions).is_multiple_of(8) {
            let saved = second.state();
            world::check_round_trip(&saved);
            second = Environment::new(saved);
            assert_eq!(
                moment(&first),
                moment(&second),
                "a saved world continues in the same way"
            );
        }
    }
    let picture = first.observe().rgb.clone();
    assert!(picture == second.observe().rgb, "both environments give the same image");
}

fn action(bytes: &mut Unstructured, environment: &Environment) -> Action {
    match environment.world().agent_params.num_actions() {
        Some(rows) => Action::Discrete(usize::from(byte(bytes)) % rows.max(1)),
        None => Action::Continuous([(); 3].map(|()| (f64::from(byte(bytes)) - 100.0) / 8.0)),
    }
}

fn step(environment: &mut Environment, action: Action) -> Option<Step> {
    match environment.step(action) {
        Ok(step) => {
            assert!(step.reward.is_finite(), "{step:?}");
            Some(step)
        }
        Err(error) => {
            refusal::message(&error.to_string());
            None
        }
    }
}

/// The state of the agent and the objects, and the return so far, as text.
fn moment(environment: &Environment) -> String {
    let agent = format!("{:?}", environment.agent());
    assert!(!agent.contains("NaN") && !agent.contains("inf"), "{agent}");
    format!("{agent} {:?} {}", environment.objects(), environment.episode_return())
}
