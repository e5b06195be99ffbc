//! Finds the answer that changes the fewest parameters, and among those the one with the smallest changes.

use driftworld_spec::{Domain, ParameterType, Value, Variant};

use super::level::Profiles;
use super::reach::{Reach, Way};
use super::search::{Found, Search};
use super::space::Space;
use super::subject::FreeParameters;

/// Budgets in measured variants: for straight lines, and for scans where requirements cut these off, each per number of changed
/// parameters; and the total beyond which no larger number of changes is tried.
const MOST_LOOKS: usize = 24_000;
const MOST_SCANNED: usize = 24_000;
const MOST_IN_ALL: usize = 200_000;

/// Minimum number of variants to measure for each set of parameters whose straight line is cut off.
const FEWEST_SCANNED: usize = 500;

/// Maximum number of points to compute where distances add up, per number of changed parameters; and limits per way.
const MOST_ON_LEVELS: usize = 40_000;
const MOST_POINTS: usize = 400;
const FEWEST_POINTS: usize = 24;

/// Maximum number of variants to measure in search of a better answer once there is one.
const MOST_FOR_BETTER: usize = 6_000;

/// Shares of ranges that differ by less count as equal.
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
        if search.num_looks > MOST_IN_ALL {
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
    let ways = reach.ways(search, size);
    let mut best = None;
    let cut = straight(search, &ways, &mut best);
    if best.is_some() {
        return best;
    }
    let sums = || cut.iter().filter(|way| way.are_tied.contains(&false));
    let points = (MOST_ON_LEVELS / sums().count().max(1)).min(MOST_POINTS);
    for points in [FEWEST_POINTS, points] {
        let until = search.num_looks + MOST_ON_LEVELS;
        for way in sums() {
            let found = search.on_level(way, profiles, points);
            if found.is_some() {
                return found;
            }
            if search.num_looks > until {
                break;
            }
        }
    }
    let budget = (MOST_SCANNED / cut.len().max(1)).max(FEWEST_SCANNED);
    for way in cut.into_iter().take(MOST_SCANNED / FEWEST_SCANNED) {
        search.nearest = None;
        if search.scan(&Space::new(search.from, &way.smooth), &way.choices, budget) {
            return search.nearest.take();
        }
    }
    None
}

/// Searches every way in a straight line; returns those that are cut off.
fn straight<'w, 'a, D: FnMut(&Variant) -> f64>(
    search: &mut Search<'a, D>,
    ways: &'w [Way<'a>],
    best: &mut Option<Found>,
) -> Vec<&'w Way<'a>> {
    let (until, until_better) = (search.num_looks + MOST_LOOKS, search.num_looks + MOST_FOR_BETTER);
    let mut cut = Vec::new();
    let change = |search: &Search<D>, found: &Found| total_change(search.from, &found.variant);
    for way in ways {
        if search.num_looks >= until_better && best.is_some() {
            break;
        }
        let refused = search.num_refused;
        search.nearest = None;
        let found = match &way.smooth[..] {
            [] => search
                .look(way.choices.clone())
                .filter(|found| search.meets(found))
                .into_iter()
                .collect(),
            [(_, parameter)] if way.sum.is_some() && parameter.kind != ParameterType::Vector => {
                search.along_a_line(&way.choices, way.smooth[0])
            }
            smooth => {
                let is_met = search.num_looks < until
                    && if way.sum.is_some() {
                        search.straight(&way.choices, smooth)
                    } else {
                        search.straight_to_corners(&way.choices, smooth)
                    };
                if !is_met && (way.sum.is_none() || search.num_refused > refused || search.num_looks >= until) {
                    cut.push(way);
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

/// Drops changes without which the answer still meets the target, starting with those that nothing reads.
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
                let apart = (a.as_number()? - b.as_number()?).abs();
                if parameter.kind == ParameterType::Heading {
                    return Some(apart.min(360.0 - apart) / width.min(360.0));
                }
                Some(apart / width)
            }
        }
    };
    changed(from, to).iter().filter_map(share).sum()
}
