//! Extracts the action from a client's message: three numbers, or a row of the world's action table.

use std::collections::BTreeMap;

use driftworld_env::Action;
use driftworld_spec::AgentParams;

use crate::behavior::{ACTION_LENGTH, BEHAVIOR};
use crate::error::UnityError;
use crate::protocol::{AgentActionProto, ListAgentActionProto};

/// The action of the only agent; three zeros if the message contains none.
pub(super) fn action(
    actions: &BTreeMap<String, ListAgentActionProto>,
    agent: &AgentParams,
) -> Result<Action, UnityError> {
    let mut chosen = Action::Continuous([0.0; ACTION_LENGTH]);
    for (behavior, ListAgentActionProto { value }) in actions {
        let ([action], BEHAVIOR) = (value.as_slice(), behavior.as_str()) else {
            return Err(UnityError::WrongAgent {
                behavior: behavior.chars().take(60).collect(),
                found: value.len(),
            });
        };
        chosen = match agent.num_actions() {
            Some(rows) => Action::Discrete(row(action, rows)?),
            None => Action::Continuous(numbers(action)?),
        };
    }
    Ok(chosen)
}

fn numbers(action: &AgentActionProto) -> Result<[f64; ACTION_LENGTH], UnityError> {
    let found = if action.continuous_actions.is_empty() {
        &action.vector_actions
    } else {
        &action.continuous_actions
    };
    if found.len() != ACTION_LENGTH {
        return Err(UnityError::ActionLength {
            found: found.len(),
            expected: ACTION_LENGTH,
        });
    }
    Ok(std::array::from_fn(|index| f64::from(found[index])))
}

/// The chosen row of the action table. Old clients send its number as a float.
fn row(action: &AgentActionProto, rows: usize) -> Result<usize, UnityError> {
    let found: Vec<f64> = if action.discrete_actions.is_empty() {
        action.vector_actions.iter().copied().map(f64::from).collect()
    } else {
        action.discrete_actions.iter().copied().map(f64::from).collect()
    };
    let [number] = found[..] else {
        let found = found.len().max(action.continuous_actions.len());
        return Err(UnityError::ActionLength { found, expected: 1 });
    };
    let last = rows - 1;
    if number.fract() != 0.0 || !(0.0..=last as f64).contains(&number) {
        return Err(UnityError::ActionRow {
            found: number.to_string(),
            last,
        });
    }
    Ok(number as usize)
}
