//! [`By`]: names of the ways to compare variants and worlds, each a subject and a measure.

use driftworld_text::{WordKind, removed};
use schemars::JsonSchema;
use serde::{Deserialize, Serialize};
use strum::VariantNames as _;

use crate::did_you_mean;

/// What two variants or worlds are compared by: of what, and after a colon by which measure of it.
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
    /// Variants of one task by what it declares: 1 is one parameter moved over its whole range.
    Parameters,
    /// What is in worlds, in the units of the reference page on comparison.
    Worlds,
    /// What an agent sees: the mean Oklab difference of the pixels that show objects, and that of the others.
    Pictures,
    /// What an agent sees: the mean Oklab difference of all pixels.
    #[serde(rename = "pictures:whole")]
    #[strum(serialize = "pictures:whole")]
    PicturesWhole,
    /// What an agent sees: (1 − SSIM) / 2 of the pictures.
    #[serde(rename = "pictures:structure")]
    #[strum(serialize = "pictures:structure")]
    PicturesStructure,
    /// Where objects are: the least work that moves them, by cells.
    Occupancy,
    /// Which cells are taken: the share of them that is taken in one world alone.
    #[serde(rename = "occupancy:jaccard")]
    #[strum(serialize = "occupancy:jaccard")]
    OccupancyJaccard,
    /// Which cells are taken: the farthest that one is from the nearest of the other world.
    #[serde(rename = "occupancy:hausdorff")]
    #[strum(serialize = "occupancy:hausdorff")]
    OccupancyHausdorff,
    /// Which cells are taken: how far each is from the nearest of the other world, on average.
    #[serde(rename = "occupancy:chamfer")]
    #[strum(serialize = "occupancy:chamfer")]
    OccupancyChamfer,
    /// Where objects come to stand in all worlds of a variant together: the law of places, with what walls do to it.
    Placements,
    /// Which objects there are, and where: OSPA, class by class.
    Objects,
    /// Which objects there are: the share of them without a counterpart of their class.
    #[serde(rename = "objects:counts")]
    #[strum(serialize = "objects:counts")]
    ObjectsCounts,
    /// Which colours objects have: assigned to each other, in Oklab.
    Colors,
    /// The same in sRGB.
    #[serde(rename = "colors:srgb")]
    #[strum(serialize = "colors:srgb")]
    ColorsSrgb,
    /// The same in CIELAB.
    #[serde(rename = "colors:cie76")]
    #[strum(serialize = "colors:cie76")]
    ColorsCie76,
    /// The same by CIEDE2000.
    #[serde(rename = "colors:ciede2000")]
    #[strum(serialize = "colors:ciede2000")]
    ColorsCiede2000,
    /// The same by `hyab`.
    #[serde(rename = "colors:hyab")]
    #[strum(serialize = "colors:hyab")]
    ColorsHyab,
    /// What worlds reward: EPIC, 0 to 1.
    Rewards,
    /// What actions pay and where they lead: the Wasserstein MDP distance, state by state.
    Dynamics,
    /// What can be earned by the same actions: bisimulation of the starts.
    #[serde(rename = "dynamics:bisimulation")]
    #[strum(serialize = "dynamics:bisimulation")]
    DynamicsBisimulation,
    /// What experts earn in each other's worlds: their regret, in hundreds of points.
    #[serde(alias = "behaviour")]
    #[strum(serialize = "behavior")]
    Behavior,
    /// How much more often experts succeed in their own worlds.
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
    /// What was found, and the known names.
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
                "{name}: its subject has a usual measure"
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
