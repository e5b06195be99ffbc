//! Describes the action space of a world's agent (in ML-Agents, its behaviour) as each generation of clients expects it: three
//! continuous numbers or one discrete one.

use driftworld_spec::{ActionModel, ActionSpace, AgentParams};

use crate::client::Client;
use crate::protocol::{ActionSpecProto, BrainParametersProto, SpaceTypeProto};

/// The behaviour's name. Clients take the part after the question mark as its team.
pub const BEHAVIOR: &str = "L2Explorer?team=0";

/// Number of continuous numbers in an action.
pub(crate) const ACTION_LENGTH: usize = 3;

/// Description of the action in worlds with an action table.
const ROW: &str = "a row of the world's action table";

/// The behaviour for a client: three continuous numbers, or one discrete number, the row of the world's action table.
pub(crate) fn behavior(agent: &AgentParams, client: Client) -> BrainParametersProto {
    let num_rows = agent.num_actions().map(|rows| rows as i32);
    let (words, kind) = match num_rows {
        Some(_) => (vec![ROW.to_owned()], SpaceTypeProto::Discrete),
        None => (words(agent).map(str::to_owned).to_vec(), SpaceTypeProto::Continuous),
    };
    let action_spec = client.hybrid_actions.then(|| ActionSpecProto {
        num_continuous_actions: if num_rows.is_some() { 0 } else { ACTION_LENGTH as i32 },
        num_discrete_actions: num_rows.iter().len() as i32,
        discrete_branch_sizes: num_rows.into_iter().collect(),
        action_descriptions: words.clone(),
    });
    BrainParametersProto {
        vector_action_size: vec![num_rows.unwrap_or(ACTION_LENGTH as i32)],
        vector_action_descriptions: words,
        vector_action_space_type: kind.into(),
        brain_name: BEHAVIOR.to_owned(),
        is_training: true,
        action_spec,
    }
}

/// Descriptions of the numbers.
pub(crate) fn words(agent: &AgentParams) -> [&'static str; ACTION_LENGTH] {
    let is_normalized = agent.actions == ActionSpace::Normalized;
    match (agent.action_model, is_normalized) {
        (ActionModel::ByVelocity, false) => [
            "speed in m/s",
            "turn rate in degrees/s, right positive",
            interact(agent, "interact above 0.5"),
        ],
        (ActionModel::ByVelocity, true) => [
            "speed as a fraction of the maximum, -1 to 1",
            "turn rate as a fraction of the maximum, right positive, -1 to 1",
            interact(agent, "interact above 0"),
        ],
        (ActionModel::ByWaypoint, false) => ["x in m", "y in m", "turn rate in degrees/s, right positive"],
        (ActionModel::ByWaypoint, true) => [
            "x as a fraction of half the arena, -1 to 1",
            "y as a fraction of half the arena, -1 to 1",
            "turn rate as a fraction of the maximum, right positive, -1 to 1",
        ],
        (ActionModel::OnRails | ActionModel::None, _) => ["ignored"; ACTION_LENGTH],
    }
}

/// Description of the third number, for agents that move by velocity.
fn interact(agent: &AgentParams, words: &'static str) -> &'static str {
    if agent.interact { words } else { "ignored" }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn action_table_is_one_discrete_choice_for_every_client() {
        let mut agent = AgentParams {
            actions: ActionSpace::DefaultDiscrete,
            ..AgentParams::default()
        };
        let old = behavior(&agent, Client::default());
        assert_eq!((old.vector_action_size, old.vector_action_space_type), (vec![7], 0));
        assert_eq!(old.action_spec, None);
        let hybrid = Client {
            hybrid_actions: true,
            ..Client::default()
        };
        agent.actions = ActionSpace::Discrete(vec![[1.0, 0.0, 0.0]; 3]);
        let spec = behavior(&agent, hybrid)
            .action_spec
            .expect("hybrid clients get an action spec");
        assert_eq!((spec.num_continuous_actions, spec.num_discrete_actions), (0, 1));
        assert_eq!(spec.discrete_branch_sizes, [3]);
    }

    #[test]
    fn descriptions_match_the_worlds_actions() {
        let mut agent = AgentParams::default();
        assert_eq!(words(&agent)[0], "speed in m/s");
        agent.interact = false;
        assert_eq!(words(&agent)[2], "ignored");
        agent.actions = ActionSpace::Normalized;
        assert_eq!(words(&agent)[0], "speed as a fraction of the maximum, -1 to 1");
        agent.action_model = ActionModel::OnRails;
        assert_eq!(words(&agent), ["ignored"; 3]);
    }
}
