//! [`ScenarioProof`]: a recorded experiment showing that a scenario's variants differ in only one element.

use schemars::JsonSchema;
use serde::{Deserialize, Serialize};

use crate::element::Element;
use crate::world::Modality;

/// An experiment on pairs of worlds: which elements each variant changes compared with the base, for the given kinds of image.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
#[schemars(extend("examples" = [
    { "element": "R", "base": "find_objects#blue", "modalities": ["rgb"], "worlds": 8, "seed": 0, "steps": 10000,
      "observations": 400, "variants": [{ "variant": "find_objects#modest", "measured": ["R"] }] },
]))]
pub struct ScenarioProof {
    /// The element that the scenario probes.
    pub element: Element,
    /// The variant with which the others were compared.
    #[schemars(length(min = 1, max = 1000))]
    pub base: String,
    /// The kinds of image for which the result holds: other kinds may show more differences.
    #[schemars(length(max = 5))]
    pub modalities: Vec<Modality>,
    /// Number of pairs of worlds tested for each variant.
    #[schemars(range(min = 1, max = 10_000))]
    pub worlds: u64,
    /// The seed under which the worlds were drawn.
    #[schemars(range(min = 0, max = MAX_SAFE_INTEGER))]
    pub seed: u64,
    /// Number of steps that both worlds of a pair took from the same state with the same command, summed over all pairs.
    #[schemars(range(min = 0, max = MAX_SAFE_INTEGER))]
    pub steps: u64,
    /// Number of states in which the two observations were compared, summed over all pairs.
    #[schemars(range(min = 0, max = MAX_SAFE_INTEGER))]
    pub observations: u64,
    /// The other variants, in the order in which they were found.
    #[schemars(length(max = 1000))]
    pub variants: Vec<ProvenVariant>,
}

/// The elements that a variant was observed to change.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
#[schemars(extend("examples" = [{ "variant": "find_objects#modest", "measured": ["R"] }]))]
pub struct ProvenVariant {
    /// The variant, as `task#variant`.
    #[schemars(length(min = 1, max = 1000))]
    pub variant: String,
    /// The elements that differ from those of the base.
    #[schemars(length(max = 7))]
    pub measured: Vec<Element>,
}

/// The largest integer that every JSON reader represents exactly: 2⁵³ − 1.
const MAX_SAFE_INTEGER: u64 = (1 << 53) - 1;
