//! A variant at a wanted distance from another. The distance is handed in; what it measures is `similarity`'s to say.

mod fewest;
mod scan;
mod subject;

use driftworld_spec::{Domain, Parameter, ParameterType, Value, Variant};

use crate::GeneratorError;
use crate::interpolation::interpolate;
use scan::{Scan, Space};
pub use subject::Subject;
use subject::{Free, FreeParameters, parameters_of};

/// The most combinations of choices that are tried.
const MOST_COMBINATIONS: usize = 4096;

/// The most variants that are looked at where requirements cut off the straight way, and the fewest for each combination.
const MOST_LOOKS: usize = 60_000;
const FEWEST_LOOKS: usize = 1500;

/// Halvings of a stretch before it is given up.
const HALVINGS: u32 = 80;

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
        target,
        tolerance,
        distance,
        nearest: None,
        farthest: None,
        num_looks: 0,
        num_refused: 0,
        is_complete: true,
    };
    search.whole(&free);
    let found = search.nearest.clone();
    if !search.is_met()
        && search
            .farthest
            .as_ref()
            .is_none_or(|farthest| farthest.distance < target)
    {
        return search.finish();
    }
    let met = found.clone().filter(|found| search.meets(found));
    if let Some(best) = fewest::fewest(&mut search, &free, met) {
        return Ok(best);
    }
    search.nearest = found;
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
    target: f64,
    tolerance: f64,
    distance: D,
    nearest: Option<Found>,
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

    /// Goes straight from a combination of choices to the ends; true if it meets the target.
    fn straight(&mut self, combination: &Changes, smooth: &[Free]) -> bool {
        let Some(base) = self.look(combination.clone()) else {
            return false;
        };
        if self.meets(&base) {
            return true;
        }
        let ends = self.farthest_ends(combination, smooth);
        if ends.is_empty() {
            return false;
        }
        let Some(end) = self.look(with(combination, &ends)) else {
            return false;
        };
        let crosses = (base.distance - self.target) * (end.distance - self.target) <= 0.0;
        self.meets(&end) || (crosses && self.halve(combination, &ends))
    }

    /// Whether the nearest variant so far is near enough.
    fn is_met(&self) -> bool {
        self.nearest.as_ref().is_some_and(|nearest| self.meets(nearest))
    }

    /// Measures a variant and remembers it; `None` if the task does not allow it.
    fn look(&mut self, changes: Changes) -> Option<Found> {
        self.num_looks += 1;
        let name = format!("{}@{}", self.from.name(), (self.target * 1e6).round() / 1e6);
        let Ok(variant) = self.from.with(&name, changes) else {
            self.num_refused += 1;
            return None;
        };
        let distance = (self.distance)(&variant);
        let found = Found { variant, distance };
        let miss = |found: &Found| (found.distance - self.target).abs();
        if self.nearest.as_ref().is_none_or(|nearest| miss(&found) < miss(nearest)) {
            self.nearest = Some(found.clone());
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

    fn meets(&self, found: &Found) -> bool {
        (found.distance - self.target).abs() <= self.tolerance
    }

    /// The ends of the ranges that lie farthest beside a combination of choices, taken parameter by parameter.
    fn farthest_ends(&mut self, combination: &Changes, smooth: &[Free]) -> Changes {
        let mut ends = Changes::new();
        for (name, parameter) in smooth {
            let options = ends_of(self.from, name, parameter);
            let mut best: Option<(f64, Value)> = None;
            for value in options {
                let change = vec![((*name).to_owned(), value.clone())];
                let Some(found) = self.look(with(combination, &with(&ends, &change))) else {
                    continue;
                };
                if best.as_ref().is_none_or(|best| found.distance > best.0) {
                    best = Some((found.distance, value));
                }
            }
            ends.extend(best.map(|(_, value)| ((*name).to_owned(), value)));
        }
        ends
    }

    /// Halves the stretch to the ends until it meets the target; false if it cannot.
    fn halve(&mut self, combination: &Changes, ends: &Changes) -> bool {
        let (mut low, mut high) = (0.0, 1.0);
        let Some(start) = self.look(combination.clone()) else {
            return false;
        };
        for _ in 0..HALVINGS {
            let t = f64::midpoint(low, high);
            let between = ends.iter().map(|(name, end)| {
                let parameter = &self.from.task().parameters()[name];
                let value = self.from.value(name).expect("variant parameters have values");
                let between = interpolate(parameter, false, value, end, t, (self.from, self.from));
                (name.clone(), between.unwrap_or_else(|| end.clone()))
            });
            let changes = with(combination, &between.collect());
            let Some(found) = self.look(changes) else { return false };
            if self.meets(&found) {
                return true;
            }
            if (found.distance < self.target) == (start.distance < self.target) {
                low = t;
            } else {
                high = t;
            }
        }
        false
    }

    /// The nearest variant if it meets the target, else what came of the search.
    fn finish(&mut self) -> Result<Found, GeneratorError> {
        let (target, variant) = (self.target, self.from.id());
        let (Some(nearest), Some(farthest)) = (self.nearest.clone(), self.farthest.clone()) else {
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

/// What a number could be at the most: the ends of its range; of a heading also the opposite direction.
fn ends_of(from: &Variant, name: &str, parameter: &Parameter) -> Vec<Value> {
    let Some(Domain::Range([low, high])) = parameter.domain() else {
        return Vec::new();
    };
    let at = |end: f64| match from.value(name) {
        Some(Value::Integer(_)) => Value::Integer(end.round() as i64),
        Some(Value::Vector(numbers)) => Value::Vector(vec![end; numbers.len()]),
        _ => Value::Number(end),
    };
    if parameter.kind == ParameterType::Heading {
        let here = from.value(name).and_then(Value::as_number).unwrap_or(low);
        return vec![Value::Number((here + 180.0).rem_euclid(360.0)), at(low), at(high)];
    }
    vec![at(low), at(high)]
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
