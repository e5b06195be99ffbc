//! A variant at a wanted distance from another. The distance is handed in; what it measures is `similarity`'s to say.

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

/// The most combinations of choices that are tried.
const MOST_COMBINATIONS: usize = 4096;

/// The most variants that are looked at where requirements cut off the straight way, and the fewest for each combination.
const MOST_LOOKS: usize = 60_000;
const FEWEST_LOOKS: usize = 1500;

/// A variant that was found, and how far it is.
#[derive(Clone, Debug)]
pub struct Found {
    /// The variant.
    pub variant: Variant,
    /// Its distance from the one that was given.
    pub distance: f64,
}

/// Finds a variant whose distance from `from` is `target` within `tolerance`, by as few changed parameters as will do.
///
/// All that the task's requirements leave of the subject's choices and ranges is searched: for each combination of choices the numbers move
/// together towards the ends of their ranges that lie farthest, and where requirements cut that way off, or a number decides what is
/// read, each number moves by itself. Of the answers that change as few parameters, the one that changes them least is taken, as a share of
/// their ranges. A parameter that nothing reads in the answer stays as it is in `from`, unless a requirement forbids that. The
/// same arguments always find the same variant. `distance` is asked some hundred times; where requirements cut, some ten thousand
/// times. It returns numbers from 0, which is that of `from`.
///
/// # Errors
/// [`GeneratorError::NothingToVary`] if the subject has no parameter that could change; [`GeneratorError::TooFar`] with the
/// farthest variant that the task allows if that is nearer than `target`; [`GeneratorError::NoneBetween`] with the nearest miss if the
/// choices leave a gap around `target`, or there was too much to look through.
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

/// Values that differ from those of the variant that was given.
type Changes = Vec<(String, Value)>;

/// Every combination of choices, those with fewer changes first, and whether that is all of them: they are bounded.
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
    /// What variants on the way are called.
    name: String,
    target: f64,
    tolerance: f64,
    distance: D,
    /// The nearest of the part that is being looked through.
    nearest: Option<Found>,
    nearest_of_all: Option<Found>,
    farthest: Option<Found>,
    num_looks: usize,
    /// How many variants the task did not allow.
    num_refused: u64,
    /// Whether all there is has been looked through.
    is_complete: bool,
}

impl<'a, D: FnMut(&Variant) -> f64> Search<'a, D> {
    /// Looks through every combination of choices and all of the ranges, until the target is met.
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

    /// Looks through a combination of choices in every direction; true if the target was met.
    fn scan(&mut self, space: &Space<'a>, combination: &Changes, budget: usize) -> bool {
        let scan = Scan {
            search: self,
            space,
            combination,
            budget,
        };
        scan.run()
    }

    /// Whether the nearest variant so far is near enough.
    fn is_met(&self) -> bool {
        self.nearest.as_ref().is_some_and(|nearest| self.meets(nearest))
    }

    /// Measures a variant and remembers it; `None` if the task does not allow it.
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

    /// The distance of a variant that need not meet the requirements; `None` if nothing could be drawn from it.
    fn beyond(&mut self, changes: Changes) -> Option<f64> {
        self.num_looks += 1;
        let variant = self.from.beyond_requirements(&self.name, changes).ok()?;
        Some((self.distance)(&variant))
    }

    fn meets(&self, found: &Found) -> bool {
        (found.distance - self.target).abs() <= self.tolerance
    }

    /// The nearest variant if it meets the target, else what came of the search.
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

/// The values in which a variant differs from another.
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
