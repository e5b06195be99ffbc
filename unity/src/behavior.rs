//! What can be done in a world, as clients of each generation are told: one behaviour, three continuous numbers. What they mean
//! is the world's action model's.

use driftworld_spec::{ActionModel, World};

use crate::client::Client;
use crate::protocol::{ActionSpecProto, BrainParametersProto, SpaceTypeProto};

/// The behaviour's name. Clients take what stands behind the question mark for its team.
pub const BEHAVIOR: &str = "L2Explorer?team=0";

/// How many numbers an action has.
pub(crate) const ACTION_LENGTH: usize = 3;

/// The behaviour as a client understands it.
pub(crate) fn behavior(world: &World, client: Client) -> BrainParametersProto {
    let words: Vec<String> = words(world.agent_params.action_model).map(str::to_owned).to_vec();
    let action_spec = client.hybrid_actions.then(|| ActionSpecProto {
        num_continuous_actions: ACTION_LENGTH as i32,
        num_discrete_actions: 0,
        discrete_branch_sizes: Vec::new(),
        action_descriptions: words.clone(),
    });
    BrainParametersProto {
        vector_action_size: vec![ACTION_LENGTH as i32],
        vector_action_descriptions: words,
        vector_action_space_type: SpaceTypeProto::Continuous.into(),
        brain_name: BEHAVIOR.to_owned(),
        is_training: true,
        action_spec,
    }
}

/// What the numbers mean, in words.
fn words(model: ActionModel) -> [&'static str; ACTION_LENGTH] {
    match model {
        ActionModel::ByVelocity => [
            "speed in m/s",
            "turn rate in degrees/s, right positive",
            "interact above 0.5",
        ],
        ActionModel::ByWaypoint => ["x in m", "y in m", "turn rate in degrees/s, right positive"],
        ActionModel::OnRails | ActionModel::None => ["ignored"; ACTION_LENGTH],
    }
}
