//! A variant at a wanted distance from another. The distance is handed in; what it measures is `similarity`'s to say.

mod scan;

use driftworld_spec::{Domain, Element, Parameter, ParameterType, Role, Value, Variant, nearest};

use crate::GeneratorError;
use crate::interpolation::interpolate;
use scan::{Scan, Space};

/// The most combinations of choices that are tried.
const MOST_COMBINATIONS: usize = 4096;

/// The most variants that are looked at where requirements cut off the straight way, and the fewest for each combination.
const MOST_LOOKS: usize = 60_000;
const FEWEST_LOOKS: usize = 1500;

/// Halvings of a stretch before it is given up.
const HALVINGS: u32 = 80;

/// What may change on the way to a wanted distance.
#[derive(Clone, Debug, PartialEq)]
pub enum Subject {
    /// The variant parameters that affect this element of the decision process, and no other.
    Element(Element),
    /// These variant parameters.
    Parameters(Vec<String>),
}

/// A variant that was found, and how far it is.
#[derive(Clone, Debug)]
pub struct Found {
    /// The variant.
    pub variant: Variant,
    /// Its distance from the one that was given.
    pub distance: f64,
}

/// Finds a variant whose distance from `from` is `target` within `tolerance`.
///
/// First without changing any choice, then with as few changed choices as will do, the numbers of the subject move together
/// from where they are towards the ends of their ranges that lie farthest, and the stretch between is halved. Where the task's
/// requirements cut that way off, all that they leave of the ranges is looked through, in every direction, each number by itself. The same
/// arguments always find the same variant. `distance` is asked some hundred times, at most 80 for each of 4,096 combinations; where
/// requirements cut, some ten thousand times. It returns finite numbers, 0 for `from`.
///
/// # Errors
/// [`GeneratorError::NothingToVary`] if the subject has no parameter that could change; [`GeneratorError::TooFar`] with the
/// farthest variant that was tried if none of them is as far as `target`; [`GeneratorError::NoneBetween`] with the nearest miss if the choices leave a
/// gap around `target`.
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
    let (smooth, listed) = parameters_of(from, subject)?;
    let mut search = Search {
        from,
        target,
        tolerance,
        distance,
        nearest: None,
        farthest: None,
        num_refused: 0,
    };
    let ends = search.farthest_ends(&smooth);
    // The way is also cut off for every combination if the ends themselves had to be left out.
    let ends_refused = search.num_refused > 0;
    let mut cut: Vec<Changes> = Vec::new();
    for combination in combinations(from, &listed) {
        let refused = search.num_refused;
        if search.straight(&combination, &ends) {
            return search.finish();
        }
        if ends_refused || search.num_refused > refused {
            cut.push(combination);
        }
    }
    let space = Space::new(from, &smooth);
    let share = (MOST_LOOKS / cut.len().max(1)).max(FEWEST_LOOKS);
    for combination in cut.iter().take(MOST_LOOKS / FEWEST_LOOKS) {
        let scan = Scan {
            search: &mut search,
            space: &space,
            combination,
            budget: share,
        };
        if scan.run() {
            break;
        }
    }
    search.finish()
}

/// A parameter that may change: its name, and how it is declared.
type Free<'a> = (&'a str, &'a Parameter);

/// Values that differ from those of the variant that was given.
type Changes = Vec<(String, Value)>;

/// The parameters that move smoothly, and those that are chosen from a list.
fn parameters_of<'a>(from: &'a Variant, subject: &Subject) -> Result<(Vec<Free<'a>>, Vec<Free<'a>>), GeneratorError> {
    let declared = from
        .task()
        .parameters()
        .iter()
        .filter(|(_, parameter)| parameter.role == Role::Variant);
    if let Subject::Parameters(names) = subject {
        let known: Vec<&str> = declared.clone().map(|(name, _)| name.as_str()).collect();
        if let Some(unknown) = names.iter().find(|name| !known.contains(&name.as_str())) {
            let meant = nearest(unknown, known).map_or_else(String::new, |near| format!(" (did you mean {near:?}?)"));
            return Err(GeneratorError::NothingToVary {
                variant: from.id(),
                asked: format!("variant parameter named {unknown}{meant}"),
            });
        }
    }
    let belongs = |name: &str, parameter: &Parameter| match subject {
        Subject::Element(element) => parameter.affects == [*element],
        Subject::Parameters(names) => names.iter().any(|wanted| wanted == name),
    };
    let free: Vec<Free> = declared
        .map(|(name, parameter)| (name.as_str(), parameter))
        .filter(|(name, parameter)| belongs(name, parameter))
        .collect();
    if free.is_empty() {
        let asked = match subject {
            Subject::Element(element) => format!("parameters that affect {} alone", element.letter()),
            Subject::Parameters(names) => format!("variant parameters named {}", names.join(", ")),
        };
        return Err(GeneratorError::NothingToVary {
            variant: from.id(),
            asked,
        });
    }
    Ok(free
        .into_iter()
        .partition(|(_, parameter)| matches!(parameter.domain(), Some(Domain::Range(_)))))
}

/// Every combination of choices, those with fewer changes first; bounded.
fn combinations(from: &Variant, listed: &[Free]) -> Vec<Changes> {
    let mut all: Vec<Changes> = vec![Vec::new()];
    for (name, parameter) in listed {
        let Some(Domain::Choices(choices)) = parameter.domain() else {
            continue;
        };
        let others = choices.into_iter().filter(|choice| from.value(name) != Some(choice));
        let others: Vec<Value> = others.collect();
        let room = MOST_COMBINATIONS.saturating_sub(all.len());
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
    all
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
    /// How many variants the task did not allow.
    num_refused: u64,
}

impl<D: FnMut(&Variant) -> f64> Search<'_, D> {
    /// Goes straight from a combination of choices to the ends; true if it meets the target.
    fn straight(&mut self, combination: &Changes, ends: &Changes) -> bool {
        let Some(base) = self.look(combination.clone()) else {
            return false;
        };
        if self.meets(&base) {
            return true;
        }
        let Some(end) = self.look(with(combination, ends)) else {
            return false;
        };
        let crosses = (base.distance - self.target) * (end.distance - self.target) <= 0.0;
        self.meets(&end) || (crosses && self.halve(combination, ends))
    }

    /// Whether the nearest variant so far is near enough.
    fn is_met(&self) -> bool {
        self.nearest.as_ref().is_some_and(|nearest| self.meets(nearest))
    }

    /// Measures a variant and remembers it; `None` if the task does not allow it.
    fn look(&mut self, changes: Changes) -> Option<Found> {
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

    /// The ends of the ranges that lie farthest, taken parameter by parameter.
    fn farthest_ends(&mut self, smooth: &[Free]) -> Changes {
        let mut ends = Changes::new();
        for (name, parameter) in smooth {
            let options = ends_of(self.from, name, parameter);
            let mut best: Option<(f64, Value)> = None;
            for value in options {
                let change = vec![((*name).to_owned(), value.clone())];
                let Some(found) = self.look(with(&ends, &change)) else {
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
    fn finish(self) -> Result<Found, GeneratorError> {
        let (target, variant) = (self.target, self.from.id());
        let (Some(nearest), Some(farthest)) = (self.nearest, self.farthest) else {
            return Err(GeneratorError::NothingToVary {
                variant,
                asked: "variants that the task allows".to_owned(),
            });
        };
        if (nearest.distance - target).abs() <= self.tolerance {
            return Ok(nearest);
        }
        if farthest.distance < target {
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
