//! Finds a variant at a given distance from another. The caller passes the distance function.

mod fewest;
mod level;
mod line;
mod reach;
mod scan;
mod search;
mod space;
mod straight;
mod subject;

use driftworld_spec::{Domain, Value, Variant};

use crate::GeneratorError;
pub use search::Found;
use search::{Changes, MAX_COMBINATIONS, Search, with};
use space::Space;
pub use subject::Subject;
use subject::{Free, FreeParameters, parameters_of};

/// Maximum number of variants to measure where requirements cut off the straight line.
const MAX_MEASURED: usize = 60_000;

/// Minimum number of such variants per combination of choices.
const MIN_MEASURED: usize = 1500;

/// Finds a variant whose distance from `from` is `target` within `tolerance`, with as few changed parameters as possible.
///
/// Searches all of the subject's choices and ranges that the task's requirements allow. For each combination of choices, the
/// numbers move together towards the farthest ends of their ranges. If requirements cut off that line, or a number decides
/// which parameters are read, each number moves separately. Among answers that change the same number of parameters, picks the
/// one with the smallest changes as shares of their ranges. A parameter that nothing reads in the answer keeps its value from
/// `from`, unless a requirement forbids that. The same arguments always find the same variant. Calls `distance` a few hundred
/// times, or tens of thousands of times if requirements cut off lines. `distance` must never be negative, and must be 0 for
/// `from`.
///
/// # Errors
/// [`GeneratorError::NothingToVary`] if the subject has no parameter that could change; [`GeneratorError::TooFar`] with the
/// farthest variant that the task allows, if it is nearer than `target`; [`GeneratorError::NoneBetween`] with the nearest miss,
/// if the choices leave a gap around `target` or the search ran out of budget.
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
        num_measured: 0,
        num_rejected: 0,
        is_complete: true,
    };
    if let Some(best) = fewest::fewest(&mut search, &free) {
        return Ok(best);
    }
    search.nearest = search.nearest_of_all.clone();
    search.whole(&free);
    search.finish()
}

/// All combinations of choices, fewest changes first, and whether the list, which has a maximum length, is complete.
fn combinations(from: &Variant, listed: &[Free]) -> (Vec<Changes>, bool) {
    let mut all: Vec<Changes> = vec![Vec::new()];
    let mut is_complete = true;
    for (name, parameter) in listed {
        let Some(Domain::Choices(choices)) = parameter.domain() else {
            continue;
        };
        let others = choices.into_iter().filter(|choice| from.value(name) != Some(choice));
        let others: Vec<Value> = others.collect();
        let room = MAX_COMBINATIONS.saturating_sub(all.len());
        is_complete &= all.len() * others.len() <= room;
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
    (all, is_complete)
}

impl<'a, D: FnMut(&Variant) -> f64> Search<'a, D> {
    /// Searches every combination of choices and all of the ranges until the target is met.
    fn whole(&mut self, free: &FreeParameters<'a>) {
        let (combinations, is_complete) = combinations(self.from, &free.listed);
        self.is_complete = is_complete;
        let mut cut: Vec<Changes> = Vec::new();
        for combination in combinations {
            let rejected_before = self.num_rejected;
            if self.straight(&combination, &free.smooth) {
                return;
            }
            if free.is_bent || self.num_rejected > rejected_before {
                cut.push(combination);
            }
        }
        let space = Space::new(self.from, &free.smooth);
        let budget = (MAX_MEASURED / cut.len().max(1)).max(MIN_MEASURED);
        let max_scanned = MAX_MEASURED / MIN_MEASURED;
        for combination in cut.iter().take(max_scanned) {
            if self.scan(&space, combination, budget) {
                return;
            }
        }
        self.is_complete &= cut.len() <= max_scanned;
    }
}
