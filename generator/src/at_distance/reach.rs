//! Measures the largest distance that each parameter can reach by itself, and lists the sets of parameters and choices that can
//! add up to the target distance. Ignores requirements, which `fewest.rs` checks on the variants.
//!
//! Distances of independent parameters add up, and each grows as its number moves away. Every pair is tested for additivity; if
//! the distances do not add up, all values of the pair are measured together.

use std::collections::HashMap;

use driftworld_spec::{Domain, Value, Variant};

use super::search::{Changes, MAX_COMBINATIONS, Search, with};
use super::space::Space;
use super::straight::ends_of;
use super::subject::{Free, FreeParameters};

/// Maximum width of a range of integers that are tried one by one.
const MAX_LISTED_WIDTH: f64 = 128.0;

/// Maximum number of sets of parameters to consider per size.
const MAX_SETS: usize = 100_000;

/// Sums that differ by less than this count as equal.
const ROUNDING: f64 = 1e-9;

/// Share by which the reach of a change set may exceed the distance at its last valid point.
const REACH_TOLERANCE: f64 = 1e-4;

/// Number of parts in which to measure the range of a number that may decide which parameters are read.
const PARTS: usize = 32;

/// The same for each component of a vector of two.
const PARTS_OF_TWO: usize = 8;

/// A parameter that may change, with the distance of each choice, or the reach of its number.
struct Candidate<'a> {
    free: Free<'a>,
    /// The other choices with their distances; empty if the parameter moves smoothly.
    choices: Vec<(Value, f64)>,
    ends: Vec<Value>,
    /// For a number that may decide which parameters are read: values from end to end, and how much farther it may reach
    /// between them. If there would be too many values, the list is empty and the number infinite.
    between: (Vec<Value>, f64),
    min: f64,
    max: f64,
    /// Whether its distance depends on another parameter.
    is_tied: bool,
}

/// A set of parameters that all change: listed ones to these choices, smooth ones to any values that meet the target.
pub(super) struct ChangeSet<'a> {
    pub(super) choices: Changes,
    pub(super) smooth: Vec<Free<'a>>,
    /// The sum of the choices' distances; `None` if some distance depends on another parameter.
    pub(super) sum: Option<f64>,
    /// For each smooth parameter, whether its distance depends on another parameter.
    pub(super) are_tied: Vec<bool>,
}

/// All parameters that may change.
pub(super) struct Reach<'a> {
    candidates: Vec<Candidate<'a>>,
    spans: JointSpans,
}

/// Minimum and maximum distance of parameters that were measured together, by their names and choices.
type JointSpans = HashMap<String, Option<(f64, f64)>>;

impl<'a> Reach<'a> {
    pub(super) fn new<D: FnMut(&Variant) -> f64>(search: &mut Search<'a, D>, free: &FreeParameters<'a>) -> Self {
        let all = free.smooth.iter().chain(&free.listed);
        let mut candidates: Vec<Candidate> = all.map(|free| Candidate::new(search, *free)).collect();
        for candidate in &mut candidates {
            if free.tied.contains(&candidate.free.0) {
                candidate.is_tied = true;
                candidate.between = candidate.between(search.from);
            }
        }
        for b in 0..candidates.len() {
            for a in 0..b {
                let are_tied = candidates[a].is_tied && candidates[b].is_tied;
                if !are_tied && !candidates[a].adds_up_with(&candidates[b], search) {
                    candidates[a].is_tied = true;
                    candidates[b].is_tied = true;
                }
            }
        }
        // Sorted by reach, so that if there are too many sets, those of the farthest-reaching parameters are considered.
        candidates.sort_by(|a, b| b.max.total_cmp(&a.max));
        Self {
            candidates,
            spans: JointSpans::new(),
        }
    }

    /// Number of parameters.
    pub(super) fn len(&self) -> usize {
        self.candidates.len()
    }

    /// All change sets of this size that may meet the target, up to a maximum number.
    pub(super) fn sets<D: FnMut(&Variant) -> f64>(
        &mut self,
        search: &mut Search<'a, D>,
        size: usize,
    ) -> Vec<ChangeSet<'a>> {
        let (mut sets, mut num_sets) = (Vec::new(), 0);
        let mut set: Vec<usize> = (0..size).collect();
        loop {
            num_sets += 1;
            if num_sets > MAX_SETS || sets.len() >= MAX_COMBINATIONS {
                break;
            }
            let members: Vec<&Candidate> = set.iter().map(|index| &self.candidates[*index]).collect();
            add_change_sets(&members, search, &mut self.spans, &mut sets);
            // The next set of this size in lexicographic order.
            let Some(at) = (0..size).rev().find(|at| set[*at] < self.len() - size + at) else {
                break;
            };
            set[at] += 1;
            for later in at + 1..size {
                set[later] = set[later - 1] + 1;
            }
        }
        sets
    }
}

/// Adds the change sets of one set of parameters.
fn add_change_sets<'a, D: FnMut(&Variant) -> f64>(
    members: &[&Candidate<'a>],
    search: &mut Search<'a, D>,
    known: &mut JointSpans,
    change_sets: &mut Vec<ChangeSet<'a>>,
) {
    let (low, high) = (search.target - search.tolerance, search.target + search.tolerance);
    let is_smooth = |member: &&&Candidate| member.choices.is_empty();
    let (tied, free): (Vec<&Candidate>, Vec<&Candidate>) = members.iter().partition(|member| member.is_tied);
    let reach: f64 = free.iter().map(|member| member.max).sum();
    let min: f64 = free.iter().map(|member| member.min).sum();
    if min > high || (tied.is_empty() && reach < low) {
        return;
    }
    let smooth: Vec<Free> = members.iter().filter(is_smooth).map(|member| member.free).collect();
    let listed: Vec<&Candidate> = free.iter().filter(|member| !is_smooth(member)).copied().collect();
    let moving: f64 = free.iter().filter(is_smooth).map(|member| member.max).sum();
    let tied_smooth: Vec<&Candidate> = tied.iter().filter(is_smooth).copied().collect();
    let tied_listed: Vec<&Candidate> = tied.iter().filter(|member| !is_smooth(member)).copied().collect();
    for together in products(&tied_listed, |_| true) {
        let numbers: Vec<&str> = tied_smooth.iter().map(|member| member.free.0).collect();
        let key = format!("{:?} {numbers:?}", together.0);
        let measured = known
            .entry(key)
            .or_insert_with(|| reach_together(search, &together.0, &tied_smooth));
        let Some((nearest, farthest)) = *measured else {
            continue;
        };
        let (from, to) = (nearest - ROUNDING, farthest + moving + ROUNDING);
        // The remaining choices can only increase the sum.
        for (choices, sum) in products(&listed, |sum| sum + from <= high) {
            if sum + to >= low {
                change_sets.push(ChangeSet {
                    choices: with(&together.0, &choices),
                    smooth: smooth.clone(),
                    sum: tied.is_empty().then_some(sum),
                    are_tied: members.iter().filter(is_smooth).map(|member| member.is_tied).collect(),
                });
            }
            if change_sets.len() >= MAX_COMBINATIONS {
                return;
            }
        }
    }
}

/// All combinations of choices with the sums of their distances, if `is_possible` accepts the sums.
fn products(members: &[&Candidate], is_possible: impl Fn(f64) -> bool) -> Vec<(Changes, f64)> {
    let mut all = vec![(Changes::new(), 0.0)];
    for member in members {
        let mut longer = Vec::new();
        for (changes, sum) in &all {
            for (choice, distance) in &member.choices {
                if is_possible(sum + distance) && longer.len() < 16 * MAX_COMBINATIONS {
                    longer.push((
                        with(changes, &vec![(member.free.0.to_owned(), choice.clone())]),
                        sum + distance,
                    ));
                }
            }
        }
        all = longer;
    }
    all
}

/// Minimum and maximum distance of numbers that are tied to each other and to choices; `None` if the choices are impossible.
fn reach_together<D: FnMut(&Variant) -> f64>(
    search: &mut Search<D>,
    choices: &Changes,
    smooth: &[&Candidate],
) -> Option<(f64, f64)> {
    if choices.is_empty() && smooth.is_empty() {
        return Some((0.0, 0.0));
    }
    if smooth.is_empty() {
        let distance = search.measure_beyond(choices.clone());
        return distance.map(|distance| (distance, distance));
    }
    let mut corners = vec![choices.clone()];
    let mut farther = 0.0;
    for candidate in smooth {
        let (between, by) = &candidate.between;
        farther += by;
        let to = |corner: &Changes| {
            let ends = candidate.ends.iter().chain(between);
            let moved = ends.map(|end| with(corner, &vec![(candidate.free.0.to_owned(), end.clone())]));
            moved.chain([corner.clone()]).collect::<Vec<_>>()
        };
        corners = corners.iter().flat_map(to).take(MAX_COMBINATIONS).collect();
    }
    if farther.is_infinite() {
        return Some((0.0, farther));
    }
    let mut farthest: f64 = 0.0;
    for corner in corners {
        let ends: Changes = corner[choices.len()..].to_vec();
        // If a corner is invalid, uses the nearest valid point to it.
        if let Some((distance, _)) = search.towards(choices, ends, Search::measure_beyond) {
            farthest = farthest.max(distance * (1.0 + REACH_TOLERANCE));
        }
    }
    Some((0.0, farthest + farther))
}

impl<'a> Candidate<'a> {
    fn new<D: FnMut(&Variant) -> f64>(search: &mut Search<'a, D>, free: Free<'a>) -> Self {
        let (name, parameter) = free;
        let here = search.from.value(name).cloned();
        let choices = match (parameter.domain(), &here) {
            (Some(Domain::Choices(choices)), _) => choices,
            (Some(Domain::Range([low, high])), Some(Value::Integer(_))) if high - low <= MAX_LISTED_WIDTH => {
                (low.ceil() as i64..=high.floor() as i64).map(Value::Integer).collect()
            }
            _ => Vec::new(),
        };
        let ends = if choices.is_empty() {
            ends_of(search.from, name, parameter)
        } else {
            Vec::new()
        };
        let mut is_tied = false;
        let mut measure = |value: &Value| {
            let distance = search.measure_beyond(vec![(name.to_owned(), value.clone())]);
            is_tied |= distance.is_none();
            distance.unwrap_or(0.0)
        };
        let others = choices.into_iter().filter(|choice| here.as_ref() != Some(choice));
        let choices: Vec<(Value, f64)> = others
            .map(|choice| {
                let distance = measure(&choice);
                (choice, distance)
            })
            .collect();
        let reaches: Vec<f64> = ends.iter().map(&mut measure).collect();
        let distances = choices.iter().map(|(_, distance)| *distance);
        Self {
            min: if ends.is_empty() {
                distances.clone().fold(f64::INFINITY, f64::min)
            } else {
                0.0
            },
            max: distances.chain(reaches).fold(0.0, f64::max),
            free,
            choices,
            ends,
            between: (Vec::new(), 0.0),
            is_tied,
        }
    }

    /// Values from end to end, and how much farther the number may reach between two neighbouring values.
    fn between(&self, from: &Variant) -> (Vec<Value>, f64) {
        if !self.choices.is_empty() {
            return (Vec::new(), 0.0);
        }
        let space = Space::new(from, &[self.free]);
        let parts = match space.axes.len() {
            1 => PARTS,
            2 => PARTS_OF_TWO,
            _ => return (Vec::new(), f64::INFINITY),
        };
        let mut points = vec![Vec::new()];
        for axis in &space.axes {
            let longer = |point: Vec<f64>| (0..=parts).map(move |part| [&point[..], &[axis.at(part, parts)]].concat());
            points = points.into_iter().flat_map(longer).collect();
        }
        let changes = points.into_iter().filter_map(|point| space.changes(&point).pop());
        (changes.map(|(_, value)| value).collect(), 2.0 * self.max / parts as f64)
    }

    /// Representative values for testing whether distances add up.
    fn representative_values(&self) -> Vec<&Value> {
        let ends = [self.choices.first(), self.choices.last()];
        self.ends
            .iter()
            .chain(ends.into_iter().flatten().map(|(choice, _)| choice))
            .collect()
    }

    /// Whether changing both gives the sum of the two distances.
    fn adds_up_with<D: FnMut(&Variant) -> f64>(&self, other: &Self, search: &mut Search<D>) -> bool {
        let change = |candidate: &Self, value: &Value| vec![(candidate.free.0.to_owned(), value.clone())];
        for a in self.representative_values() {
            for b in other.representative_values() {
                let (a, b) = (change(self, a), change(other, b));
                let both = search.measure_beyond(with(&a, &b));
                // If one of the two changes is invalid by itself, the pair gives no evidence.
                let (Some(a), Some(b)) = (search.measure_beyond(a), search.measure_beyond(b)) else {
                    continue;
                };
                let Some(both) = both else { return false };
                if (both - a - b).abs() > ROUNDING * both.max(1.0) {
                    return false;
                }
            }
        }
        true
    }
}
