//! [`Search`]: measures variants, and records the nearest and the farthest.

use driftworld_spec::{Value, Variant};

use crate::GeneratorError;

/// Maximum number of combinations of choices to try.
pub(super) const MAX_COMBINATIONS: usize = 4096;

/// A found variant with its distance.
#[derive(Clone, Debug)]
pub struct Found {
    /// The variant.
    pub variant: Variant,
    /// Its distance from the given variant.
    pub distance: f64,
}

/// Changed values, by parameter name.
pub(super) type Changes = Vec<(String, Value)>;

pub(super) fn with(changes: &Changes, more: &Changes) -> Changes {
    changes.iter().chain(more).cloned().collect()
}

/// A search and its results so far.
pub(super) struct Search<'a, D> {
    pub(super) from: &'a Variant,
    /// Name of the variants tried.
    pub(super) name: String,
    pub(super) target: f64,
    pub(super) tolerance: f64,
    pub(super) distance: D,
    /// The nearest variant in the part that is being searched.
    pub(super) nearest: Option<Found>,
    pub(super) nearest_of_all: Option<Found>,
    pub(super) farthest: Option<Found>,
    pub(super) num_measured: usize,
    /// Number of variants that the task did not allow.
    pub(super) num_rejected: u64,
    /// Whether the search has covered everything.
    pub(super) is_complete: bool,
}

impl<D: FnMut(&Variant) -> f64> Search<'_, D> {
    /// Whether the nearest variant so far meets the target.
    pub(super) fn is_met(&self) -> bool {
        self.nearest.as_ref().is_some_and(|nearest| self.meets(nearest))
    }

    /// Measures a variant and records it; `None` if the task does not allow it.
    pub(super) fn look(&mut self, changes: Changes) -> Option<Found> {
        self.num_measured += 1;
        let Ok(variant) = self.from.with(&self.name, changes) else {
            self.num_rejected += 1;
            return None;
        };
        let distance = (self.distance)(&variant);
        let found = Found { variant, distance };
        let miss = |found: &Found| (found.distance - self.target).abs();
        for nearest in [&mut self.nearest, &mut self.nearest_of_all] {
            if nearest.as_ref().is_none_or(|nearest| miss(&found) < miss(nearest)) {
                *nearest = Some(found.clone());
            }
        }
        if self
            .farthest
            .as_ref()
            .is_none_or(|farthest| found.distance > farthest.distance)
        {
            self.farthest = Some(found.clone());
        }
        Some(found)
    }

    /// The distance of a variant that may violate requirements; `None` if the variant is invalid for another reason.
    pub(super) fn measure_beyond(&mut self, changes: Changes) -> Option<f64> {
        self.num_measured += 1;
        let variant = self.from.beyond_requirements(&self.name, changes).ok()?;
        Some((self.distance)(&variant))
    }

    pub(super) fn meets(&self, found: &Found) -> bool {
        (found.distance - self.target).abs() <= self.tolerance
    }

    /// The nearest variant if it meets the target, otherwise an error that describes the outcome.
    pub(super) fn finish(&mut self) -> Result<Found, GeneratorError> {
        let (target, variant) = (self.target, self.from.id());
        let (Some(nearest), Some(farthest)) = (self.nearest_of_all.clone(), self.farthest.clone()) else {
            return Err(GeneratorError::NothingToVary {
                variant,
                asked: "variants that the task allows".to_owned(),
            });
        };
        if (nearest.distance - target).abs() <= self.tolerance {
            return Ok(nearest);
        }
        if self.is_complete && farthest.distance < target {
            let values = shown(self.from, &farthest.variant);
            return Err(GeneratorError::TooFar {
                variant,
                target,
                farthest: farthest.distance,
                values,
            });
        }
        let values = shown(self.from, &nearest.variant);
        Err(GeneratorError::NoneBetween {
            variant,
            target,
            tolerance: self.tolerance,
            nearest: nearest.distance,
            values,
        })
    }
}

/// The values in which a variant differs from another, as text.
fn shown(from: &Variant, to: &Variant) -> String {
    let different = to
        .values()
        .iter()
        .filter(|(name, value)| from.value(name) != Some(*value));
    let shown: Vec<String> = different.map(|(name, value)| format!("{name} = {value}")).collect();
    if shown.is_empty() {
        "unchanged".to_owned()
    } else {
        shown.join(", ")
    }
}
