//! Finds the answer that changes the fewest parameters and, among such answers, the one with the smallest changes.

use driftworld_spec::{Domain, ParameterType, Value, Variant};

use super::level::Profiles;
use super::reach::{ChangeSet, Reach};
use super::search::{Found, Search};
use super::space::Space;
use super::subject::FreeParameters;

/// Maximum number of variants to measure along straight lines, per number of changed parameters.
const MAX_STRAIGHT: usize = 24_000;

/// Maximum number of variants to measure in scans where requirements cut these lines off, per number of changed parameters.
const MAX_SCANNED: usize = 24_000;

/// Total number of measured variants beyond which no larger number of changes is tried.
const MAX_TOTAL: usize = 200_000;

/// Minimum number of variants to measure for each set of parameters whose straight line is cut off.
const MIN_SCANNED: usize = 500;

/// Maximum number of variants to measure in each pass if distances add up, per number of changed parameters.
const MAX_ON_LEVELS: usize = 40_000;

/// Maximum number of points to compute per change set in the second pass.
const MAX_POINTS: usize = 400;

/// Number of points to compute per change set in the first pass.
const MIN_POINTS: usize = 24;

/// Maximum number of variants to measure while looking for a better answer once one is found.
const MAX_FOR_BETTER: usize = 6_000;

/// Shares of ranges that differ by less than this count as equal.
const EQUAL: f64 = 1e-6;

/// The best answer, if any was found.
pub(super) fn fewest<'a, D: FnMut(&Variant) -> f64>(
    search: &mut Search<'a, D>,
    free: &FreeParameters<'a>,
) -> Option<Found> {
    let mut reach = Reach::new(search, free);
    let mut profiles = Profiles::default();
    for size in 0..=reach.len() {
        if let Some(found) = of_size(search, &mut reach, &mut profiles, size) {
            return Some(without_idle_changes(search, found));
        }
        if search.num_measured > MAX_TOTAL {
            break;
        }
    }
    None
}

/// The best answer that changes `size` parameters.
fn of_size<'a, D: FnMut(&Variant) -> f64>(
    search: &mut Search<'a, D>,
    reach: &mut Reach<'a>,
    profiles: &mut Profiles,
    size: usize,
) -> Option<Found> {
    let sets = reach.sets(search, size);
    let mut best = None;
    let cut = straight(search, &sets, &mut best);
    if best.is_some() {
        return best;
    }
    let sums = || cut.iter().filter(|set| set.are_tied.contains(&false));
    let points = (MAX_ON_LEVELS / sums().count().max(1)).min(MAX_POINTS);
    for points in [MIN_POINTS, points] {
        let until = search.num_measured + MAX_ON_LEVELS;
        for set in sums() {
            let found = search.on_level(set, profiles, points);
            if found.is_some() {
                return found;
            }
            if search.num_measured > until {
                break;
            }
        }
    }
    let budget = (MAX_SCANNED / cut.len().max(1)).max(MIN_SCANNED);
    for set in cut.into_iter().take(MAX_SCANNED / MIN_SCANNED) {
        search.nearest = None;
        if search.scan(&Space::new(search.from, &set.smooth), &set.choices, budget) {
            return search.nearest.take();
        }
    }
    None
}

/// Searches every change set along a straight line; returns those that are cut off.
fn straight<'w, 'a, D: FnMut(&Variant) -> f64>(
    search: &mut Search<'a, D>,
    sets: &'w [ChangeSet<'a>],
    best: &mut Option<Found>,
) -> Vec<&'w ChangeSet<'a>> {
    let (until, until_better) = (search.num_measured + MAX_STRAIGHT, search.num_measured + MAX_FOR_BETTER);
    let mut cut = Vec::new();
    let change = |search: &Search<D>, found: &Found| total_change(search.from, &found.variant);
    for set in sets {
        if search.num_measured >= until_better && best.is_some() {
            break;
        }
        let rejected = search.num_rejected;
        search.nearest = None;
        let found = match &set.smooth[..] {
            [] => search
                .look(set.choices.clone())
                .filter(|found| search.meets(found))
                .into_iter()
                .collect(),
            [(_, parameter)] if set.sum.is_some() && parameter.kind != ParameterType::Vector => {
                search.along_a_line(&set.choices, set.smooth[0])
            }
            smooth => {
                let is_met = search.num_measured < until
                    && if set.sum.is_some() {
                        search.straight(&set.choices, smooth)
                    } else {
                        search.straight_to_corners(&set.choices, smooth)
                    };
                if !is_met && (set.sum.is_none() || search.num_rejected > rejected || search.num_measured >= until) {
                    cut.push(set);
                }
                search.nearest.take().filter(|_| is_met).into_iter().collect::<Vec<_>>()
            }
        };
        for found in found {
            if best
                .as_ref()
                .is_none_or(|best| change(search, &found) < change(search, best) - EQUAL)
            {
                *best = Some(found);
            }
        }
    }
    cut
}

/// Drops changes that are not needed to meet the target, starting with parameters that nothing reads.
fn without_idle_changes<D: FnMut(&Variant) -> f64>(search: &mut Search<D>, found: Found) -> Found {
    let mut names = changed(search.from, &found.variant);
    names.sort_by_key(|name| found.variant.reads(name));
    let mut kept = found;
    for name in names {
        let others = changed(search.from, &kept.variant)
            .into_iter()
            .filter(|other| *other != name);
        let changes = others.filter_map(|other| Some((other.clone(), kept.variant.value(&other)?.clone())));
        if let Some(fewer) = search.look(changes.collect()).filter(|fewer| search.meets(fewer)) {
            kept = fewer;
        }
    }
    kept
}

/// Names of the parameters in which two variants differ.
fn changed(from: &Variant, to: &Variant) -> Vec<String> {
    let values = to.values().iter();
    let different = values.filter(|(name, value)| from.value(name) != Some(*value));
    different.map(|(name, _)| name.clone()).collect()
}

/// Sum of the changes of parameters as shares of their ranges; a different choice counts as 1.
fn total_change(from: &Variant, to: &Variant) -> f64 {
    let share = |name: &String| {
        let parameter = from.task().parameters().get(name)?;
        let Some(Domain::Range([low, high])) = parameter.domain() else {
            return Some(1.0);
        };
        let width = (high - low).max(f64::MIN_POSITIVE);
        match (from.value(name)?, to.value(name)?) {
            (Value::Vector(a), Value::Vector(b)) => {
                let squares = a.iter().zip(b).map(|(a, b)| ((a - b) / width) * ((a - b) / width));
                Some((squares.sum::<f64>() / a.len().max(1) as f64).sqrt())
            }
            (a, b) => {
                let difference = (a.as_number()? - b.as_number()?).abs();
                if parameter.kind == ParameterType::Heading {
                    return Some(difference.min(360.0 - difference) / width.min(360.0));
                }
                Some(difference / width)
            }
        }
    };
    changed(from, to).iter().filter_map(share).sum()
}
