//! [`By`]: the ways to compare variants and worlds, each named by a subject and a measure.

use driftworld_text::{WordKind, removed};
use schemars::JsonSchema;
use serde::{Deserialize, Serialize};
use strum::VariantNames as _;

use crate::did_you_mean;

/// How two variants or worlds are compared: a subject and, after a colon, a measure of it.
#[derive(
    Clone,
    Copy,
    Debug,
    PartialEq,
    Eq,
    Serialize,
    Deserialize,
    JsonSchema,
    strum::IntoStaticStr,
    strum::EnumString,
    strum::VariantNames,
)]
#[serde(rename_all = "snake_case")]
#[strum(serialize_all = "snake_case")]
pub enum By {
    /// Variants of one task, by declared parameters: 1 means that one parameter moves across its whole range.
    Parameters,
    /// The contents of worlds, in the units of the reference page on comparison.
    Worlds,
    /// What an agent sees: the mean Oklab difference of the pixels that show objects, and of the other pixels.
    Pictures,
    /// What an agent sees: the mean Oklab difference of all pixels.
    #[serde(rename = "pictures:whole")]
    #[strum(serialize = "pictures:whole")]
    PicturesWhole,
    /// What an agent sees: (1 − SSIM) / 2 of the pictures.
    #[serde(rename = "pictures:structure")]
    #[strum(serialize = "pictures:structure")]
    PicturesStructure,
    /// Positions of objects: the minimum work to move them, on a grid of cells.
    Occupancy,
    /// Occupied cells: the share that is occupied in only one of the worlds.
    #[serde(rename = "occupancy:jaccard")]
    #[strum(serialize = "occupancy:jaccard")]
    OccupancyJaccard,
    /// Occupied cells: the largest distance from a cell to the nearest one in the other world.
    #[serde(rename = "occupancy:hausdorff")]
    #[strum(serialize = "occupancy:hausdorff")]
    OccupancyHausdorff,
    /// Occupied cells: the mean distance from a cell to the nearest one in the other world.
    #[serde(rename = "occupancy:chamfer")]
    #[strum(serialize = "occupancy:chamfer")]
    OccupancyChamfer,
    /// The distribution of object positions over all worlds of a variant, including the effect of walls.
    Placements,
    /// Which objects there are, and where: OSPA, class by class.
    Objects,
    /// Which objects there are: the share without a counterpart of the same class.
    #[serde(rename = "objects:counts")]
    #[strum(serialize = "objects:counts")]
    ObjectsCounts,
    /// Colours of objects, matched with each other, in Oklab.
    Colors,
    /// Colours of objects, in sRGB.
    #[serde(rename = "colors:srgb")]
    #[strum(serialize = "colors:srgb")]
    ColorsSrgb,
    /// Colours of objects, in CIELAB.
    #[serde(rename = "colors:cie76")]
    #[strum(serialize = "colors:cie76")]
    ColorsCie76,
    /// Colours of objects, by CIEDE2000.
    #[serde(rename = "colors:ciede2000")]
    #[strum(serialize = "colors:ciede2000")]
    ColorsCiede2000,
    /// Colours of objects, by `hyab`.
    #[serde(rename = "colors:hyab")]
    #[strum(serialize = "colors:hyab")]
    ColorsHyab,
    /// The rewards of worlds: EPIC distance, 0 to 1.
    Rewards,
    /// Rewards and transitions of actions: the Wasserstein MDP distance, state by state.
    Dynamics,
    /// Rewards attainable by the same actions: bisimulation distance of the starts.
    #[serde(rename = "dynamics:bisimulation")]
    #[strum(serialize = "dynamics:bisimulation")]
    DynamicsBisimulation,
    /// Returns of experts in each other's worlds: their regret, in hundreds of points.
    #[serde(alias = "behaviour")]
    #[strum(serialize = "behavior")]
    Behavior,
    /// How much more often experts succeed in their own worlds than in each other's.
    #[serde(rename = "behavior:success")]
    #[strum(serialize = "behavior:success")]
    BehaviorSuccess,
}

impl By {
    /// Its name in documents, on the command line and in Python.
    pub fn name(self) -> &'static str {
        self.into()
    }

    /// The subject without the measure: `"occupancy"` of `occupancy:jaccard`.
    pub fn subject(self) -> &'static str {
        let name = self.name();
        name.split_once(':').map_or(name, |(subject, _)| subject)
    }

    /// All names, grouped by subject, each subject's default measure first.
    pub fn names() -> &'static [&'static str] {
        Self::VARIANTS
    }

    /// Finds it by name; `behaviour` is accepted for `behavior`.
    ///
    /// # Errors
    /// A message with the unknown name and the known names.
    pub fn from_name(name: &str) -> Result<Self, String> {
        let american = name.replacen("behaviour", "behavior", 1);
        american.parse().map_err(|_| {
            if let Some(advice) = removed(WordKind::By, name) {
                return format!("found {name:?}, {advice}");
            }
            let near = did_you_mean(name, Self::names().iter().copied());
            format!("found {name:?}, expected one of {}{near}", Self::names().join(", "))
        })
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn documents_and_arguments_use_the_same_name() {
        for name in By::names() {
            let by = By::from_name(name).unwrap();
            assert_eq!(serde_json::to_value(by).unwrap(), *name);
            assert!(
                By::from_name(by.subject()).is_ok(),
                "{name}: its subject has a default measure"
            );
        }
        assert_eq!(By::from_name("behaviour:success"), Ok(By::BehaviorSuccess));
        assert!(
            By::from_name("looks")
                .unwrap_err()
                .contains("parameters, worlds, pictures")
        );
        assert!(
            By::from_name("picture")
                .unwrap_err()
                .ends_with("did you mean \"pictures\"?")
        );
    }
}
