//! The answer that changes the fewest parameters, and of those the one that changes them least. Finding any answer is `mod.rs`'s and
//! `scan.rs`'s.

use driftworld_spec::{Domain, ParameterType, Value, Variant};

use super::{Changes, Found, Free, FreeParameters, MOST_COMBINATIONS, Search, Space};

/// The most variants that are looked at by straight ways, and the most where requirements cut them, for each number of parameters.
const MOST_LOOKS: usize = 6_000;
const MOST_SCANNED: usize = 24_000;

/// The fewest variants that are looked at for each set of parameters whose straight way is cut.
const FEWEST_SCANNED: usize = 600;

/// Shares of ranges that differ by less are equal.
const EQUAL: f64 = 1e-6;

/// Parameters that all change: the listed ones to these choices, the smooth ones to whatever meets the target.
struct Way<'a> {
    choices: Changes,
    smooth: Vec<Free<'a>>,
}

/// The best of all answers; that change no more parameters than `found`, if there is one that meets the target.
pub(super) fn fewest<'a, D: FnMut(&Variant) -> f64>(
    search: &mut Search<'a, D>,
    free: &FreeParameters<'a>,
    found: Option<Found>,
) -> Option<Found> {
    let found = found.map(|found| without_idle_changes(search, found));
    let all = free.smooth.len() + free.listed.len();
    let most = found
        .as_ref()
        .map_or(all, |found| changed(search.from, &found.variant).len());
    for size in 0..most {
        if let Some(better) = of_size(search, free, size) {
            return Some(without_idle_changes(search, better));
        }
    }
    let (ways, mut best) = (ways(search.from, free, most), found);
    straight(search, free, &ways, &mut best);
    best.map(|best| without_idle_changes(search, best))
}

/// The best answer found that changes so many parameters.
fn of_size<'a, D: FnMut(&Variant) -> f64>(
    search: &mut Search<'a, D>,
    free: &FreeParameters<'a>,
    size: usize,
) -> Option<Found> {
    let ways = ways(search.from, free, size);
    let mut best = None;
    let cut = straight(search, free, &ways, &mut best);
    let budget = (MOST_SCANNED / cut.len().max(1)).max(FEWEST_SCANNED);
    for way in cut.into_iter().take(MOST_SCANNED / FEWEST_SCANNED) {
        if best.is_some() {
            break;
        }
        search.nearest = None;
        if search.scan(&Space::new(search.from, &way.smooth), &way.choices, budget) {
            best = search.nearest.take();
        }
    }
    best
}

/// Goes every way straight; returns those that are cut off.
fn straight<'w, 'a, D: FnMut(&Variant) -> f64>(
    search: &mut Search<'a, D>,
    free: &FreeParameters,
    ways: &'w [Way<'a>],
    best: &mut Option<Found>,
) -> Vec<&'w Way<'a>> {
    let until = search.num_looks + MOST_LOOKS;
    let mut cut = Vec::new();
    for way in ways {
        let refused = search.num_refused;
        search.nearest = None;
        if search.num_looks < until && search.straight(&way.choices, &way.smooth) {
            let found = search.nearest.take();
            let change = |found: &Found| total_change(search.from, &found.variant);
            let is_better = |new: &Found| best.as_ref().is_none_or(|best| change(new) < change(best) - EQUAL);
            if found.as_ref().is_some_and(is_better) {
                *best = found;
            }
        } else if !way.smooth.is_empty() && (free.is_bent || search.num_refused > refused) {
            cut.push(way);
        }
    }
    cut
}

/// Every set of so many parameters, with every choice of those that are listed, in the order of the task; bounded.
fn ways<'a>(from: &Variant, free: &FreeParameters<'a>, size: usize) -> Vec<Way<'a>> {
    let mut all = vec![Way {
        choices: Changes::new(),
        smooth: Vec::new(),
    }];
    let candidates: Vec<Free> = free.smooth.iter().chain(&free.listed).copied().collect();
    // Longer ones are made of shorter ones by parameters that come later.
    let mut last = vec![0];
    for _ in 0..size {
        let (mut longer, mut ends) = (Vec::new(), Vec::new());
        for (way, start) in all.iter().zip(&last) {
            for (place, (name, parameter)) in candidates.iter().enumerate().skip(*start) {
                let mut add = |choice: Option<Value>| {
                    let mut choices = way.choices.clone();
                    let mut smooth = way.smooth.clone();
                    match choice {
                        Some(choice) => choices.push(((*name).to_owned(), choice)),
                        None => smooth.push((name, parameter)),
                    }
                    longer.push(Way { choices, smooth });
                    ends.push(place + 1);
                };
                match parameter.domain() {
                    Some(Domain::Choices(choices)) => {
                        let others = choices.into_iter().filter(|choice| from.value(name) != Some(choice));
                        others.for_each(|choice| add(Some(choice)));
                    }
                    _ => add(None),
                }
            }
            if longer.len() >= MOST_COMBINATIONS {
                break;
            }
        }
        (all, last) = (longer, ends);
    }
    all
}

/// The same without the changes that it meets the target without, those first that nothing reads.
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

/// The parameters in which a variant differs from another.
fn changed(from: &Variant, to: &Variant) -> Vec<String> {
    let values = to.values().iter();
    let different = values.filter(|(name, value)| from.value(name) != Some(*value));
    different.map(|(name, _)| name.clone()).collect()
}

/// By how much of their ranges parameters differ, summed; another choice counts 1.
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
