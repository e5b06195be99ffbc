//! [`ElementWeights`]: the weight of each element of the decision process in a task's distances.

use schemars::JsonSchema;
use serde::{Deserialize, Serialize};

/// The weight of each element of the decision process in a task's distances; 1 by default.
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(default, deny_unknown_fields)]
#[schemars(extend("examples" = [{ "R": 2, "O": 0.5 }]))]
pub struct ElementWeights {
    /// Weight of the states.
    #[serde(rename = "S")]
    #[schemars(range(min = 0.0, max = 1e6))]
    pub state: f64,
    /// Weight of the actions.
    #[serde(rename = "A")]
    #[schemars(range(min = 0.0, max = 1e6))]
    pub action: f64,
    /// Weight of the transitions.
    #[serde(rename = "T")]
    #[schemars(range(min = 0.0, max = 1e6))]
    pub transition: f64,
    /// Weight of the rewards.
    #[serde(rename = "R")]
    #[schemars(range(min = 0.0, max = 1e6))]
    pub reward: f64,
    /// Weight of the observations.
    #[serde(rename = "O")]
    #[schemars(range(min = 0.0, max = 1e6))]
    pub observation: f64,
}

impl Default for ElementWeights {
    fn default() -> Self {
        Self {
            state: 1.0,
            action: 1.0,
            transition: 1.0,
            reward: 1.0,
            observation: 1.0,
        }
    }
}

impl ElementWeights {
    /// The weights in the order of [`Element::ALL`](crate::Element::ALL).
    pub fn to_array(self) -> [f64; 5] {
        [self.state, self.action, self.transition, self.reward, self.observation]
    }
}
