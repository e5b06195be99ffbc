//! Finds a variant at a given distance from another. The caller passes the distance function.

mod fewest;
mod level;
mod line;
mod reach;
mod scan;
mod space;
mod straight;
mod subject;

use driftworld_spec::{Domain, Value, Variant};

use crate::GeneratorError;
use scan::Scan;
use space::Space;
pub use subject::Subject;
use subject::{Free, FreeParameters, parameters_of};

/// Maximum number of combinations of choices to try.
const MOST_COMBINATIONS: usize = 4096;

/// Maximum number of variants to measure where requirements cut off the straight line, and minimum per combination.
const MOST_LOOKS: usize = 60_000;
const FEWEST_LOOKS: usize = 1500;

/// A found variant with its distance.
#[derive(Clone, Debug)]
pub struct Found {
    /// The variant.
    pub variant: Variant,
    /// Its distance from the given variant.
    pub distance: f64,
}

/// Finds a variant whose distance from `from` is `target` within `tolerance`, with as few changed parameters as possible.
///
/// Searches all of the subject's choices and ranges that the task's requirements allow. For each combination of choices the
/// numbers move together towards the farthest ends of their ranges. If requirements cut that way off, or a number decides what is
/// read, each number moves separately. Among answers that change equally few parameters, takes the one with the smallest changes
/// as shares of their ranges. A parameter that nothing reads in the answer stays as it is in `from`, unless a requirement forbids
/// that. The same arguments always find the same variant. Calls `distance` a few hundred times, or tens of thousands of times if
/// requirements cut ways off. `distance` must never be negative, and must be 0 for `from`.
///
/// # Errors
/// [`GeneratorError::NothingToVary`] if the subject has no parameter that could change; [`GeneratorError::TooFar`] with the
/// farthest variant that the task allows if it is nearer than `target`; [`GeneratorError::NoneBetween`] with the nearest miss if
/// the choices leave a gap around `target`, or the search ran out of budget.
///
/// # Example
/// ```
/// use driftworld_generator::{Subject, at_distance};
/// use driftworld_spec::{Element, TaskSpec};
/// let task = TaskSpec::from_json("t", r#"{ "name": "t", "parameters": {
///     "pay": { "role": "variant", "type": "number", "affects": ["R"], "range": [-100, 100], "default": 100 } } }"#)?;
/// let variant = task.variant("default")?;
/// let pay = |variant: &driftworld_spec::Variant| variant.value("pay").and_then(|pay| pay.as_number()).unwrap_or(0.0);
/// let found = at_distance(&variant, &Subject::Element(Element::R), 0.25, 1e-6, |other| (100.0 - pay(other)) / 200.0)?;
/// assert!((pay(&found.variant) - 50.0).abs() < 1e-3);
/// # Ok::<(), Box<dyn std::error::Error>>(())
/// ```
pub fn at_distance(
    from: &Variant,
    subject: &Subject,
    target: f64,
    tolerance: f64,
    distance: impl FnMut(&Variant) -> f64,
) -> Result<Found, GeneratorError> {
    let free = parameters_of(from, subject)?;
    let mut search = Search {
        from,
        name: format!("{}@{}", from.name(), (target * 1e6).round() / 1e6),
        target,
        tolerance,
        distance,
        nearest: None,
        nearest_of_all: None,
        farthest: None,
        num_looks: 0,
        num_refused: 0,
        is_complete: true,
    };
    if let Some(best) = fewest::fewest(&mut search, &free) {
        return Ok(best);
    }
    search.nearest = search.nearest_of_all.clone();
    search.whole(&free);
    search.finish()
}

/// Changed values, by parameter name.
type Changes = Vec<(String, Value)>;

/// All combinations of choices, fewest changes first, and whether the list is complete: its length is limited.
fn combinations(from: &Variant, listed: &[Free]) -> (Vec<Changes>, bool) {
    let mut all: Vec<Changes> = vec![Vec::new()];
    let mut are_all = true;
    for (name, parameter) in listed {
        let Some(Domain::Choices(choices)) = parameter.domain() else {
            continue;
        };
        let others = choices.into_iter().filter(|choice| from.value(name) != Some(choice));
        let others: Vec<Value> = others.collect();
        let room = MOST_COMBINATIONS.saturating_sub(all.len());
        are_all &= all.len() * others.len() <= room;
        let more: Vec<Changes> = all
            .iter()
            .flat_map(|before| {
                others
                    .iter()
                    .map(|value| with(before, &vec![((*name).to_owned(), value.clone())]))
            })
            .take(room)
            .collect();
        all.extend(more);
    }
    all.sort_by_key(Vec::len);
    (all, are_all)
}

fn with(changes: &Changes, more: &Changes) -> Changes {
    changes.iter().chain(more).cloned().collect()
}

struct Search<'a, D> {
    from: &'a Variant,
    /// Name of the variants on the way.
    name: String,
    target: f64,
    tolerance: f64,
    distance: D,
    /// The nearest variant in the part being searched.
    nearest: Option<Found>,
    nearest_of_all: Option<Found>,
    farthest: Option<Found>,
    num_looks: usize,
    /// Number of variants that the task did not allow.
    num_refused: u64,
    /// Whether the search has covered everything.
    is_complete: bool,
}

impl<'a, D: FnMut(&Variant) -> f64> Search<'a, D> {
    /// Searches every combination of choices and all of the ranges until the target is met.
    fn whole(&mut self, free: &FreeParameters<'a>) {
        let (combinations, are_all) = combinations(self.from, &free.listed);
        self.is_complete = are_all;
        let mut cut: Vec<Changes> = Vec::new();
        for combination in combinations {
            let refused = self.num_refused;
            if self.straight(&combination, &free.smooth) {
                return;
            }
            if free.is_bent || self.num_refused > refused {
                cut.push(combination);
            }
        }
        let space = Space::new(self.from, &free.smooth);
        let budget = (MOST_LOOKS / cut.len().max(1)).max(FEWEST_LOOKS);
        let most = MOST_LOOKS / FEWEST_LOOKS;
        for combination in cut.iter().take(most) {
            if self.scan(&space, combination, budget) {
                return;
            }
        }
        self.is_complete &= cut.len() <= most;
    }

    /// Searches one combination of choices in every direction; true if the target was met.
    fn scan(&mut self, space: &Space<'a>, combination: &Changes, budget: usize) -> bool {
        let scan = Scan {
            search: self,
            space,
            combination,
            budget,
        };
        scan.run()
    }

    /// Whether the nearest variant so far meets the target.
    fn is_met(&self) -> bool {
        self.nearest.as_ref().is_some_and(|nearest| self.meets(nearest))
    }

    /// Measures a variant and records it; `None` if the task does not allow it.
    fn look(&mut self, changes: Changes) -> Option<Found> {
        self.num_looks += 1;
        let Ok(variant) = self.from.with(&self.name, changes) else {
            self.num_refused += 1;
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

    /// The distance of a variant that need not meet the requirements; `None` if its worlds cannot be drawn.
    fn beyond(&mut self, changes: Changes) -> Option<f64> {
        self.num_looks += 1;
        let variant = self.from.beyond_requirements(&self.name, changes).ok()?;
        Some((self.distance)(&variant))
    }

    fn meets(&self, found: &Found) -> bool {
        (found.distance - self.target).abs() <= self.tolerance
    }

    /// The nearest variant if it meets the target, else the error that describes the search's outcome.
    fn finish(&mut self) -> Result<Found, GeneratorError> {
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
        "as it stands".to_owned()
    } else {
        shown.join(", ")
    }
}
