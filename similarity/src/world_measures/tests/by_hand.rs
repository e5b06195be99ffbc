//! Checks each measure between worlds against its definition: over all pairings, and over sets of cells.

use std::collections::BTreeSet;

use super::*;

type Cell = [i64; 2];

const CLASSES: [&str; 2] = ["rock", "tree"];

/// The 1 m cells that a class occupies in an arena of 12 × 8 m, one entry per object.
fn cells(things: &[Thing], class: &str) -> Vec<Cell> {
    let own = things.iter().filter(|thing| thing.0.to_lowercase() == class);
    let inside = own.filter(|(_, [x, y], _)| x.abs() <= 6.0 && y.abs() <= 4.0);
    let cell = |(_, [x, y], _): &Thing| [(x + 6.0).floor().min(11.0) as i64, (y + 4.0).floor().min(7.0) as i64];
    inside.map(cell).collect()
}

fn metres(a: &Cell, b: &Cell) -> f64 {
    libm::hypot((a[0] - b[0]) as f64, (a[1] - b[1]) as f64)
}

fn diameter() -> f64 {
    170.0_f64.sqrt()
}

/// The minimum sum over all ways to pair each element of the shorter list with one of the longer list.
fn least_sum<T>(short: &[T], long: &[T], cost: &dyn Fn(&T, &T) -> f64) -> f64 {
    fn go<T>(short: &[T], long: &[T], used: &mut Vec<bool>, cost: &dyn Fn(&T, &T) -> f64) -> f64 {
        let Some((first, rest)) = short.split_first() else {
            return 0.0;
        };
        let mut best = f64::INFINITY;
        for index in 0..long.len() {
            if !used[index] {
                used[index] = true;
                best = best.min(cost(first, &long[index]) + go(rest, long, used, cost));
                used[index] = false;
            }
        }
        best
    }
    if short.len() > long.len() {
        return least_sum(long, short, &|a, b| cost(b, a));
    }
    go(short, long, &mut vec![false; long.len()], cost)
}

/// Repeats the elements of both until they have equal length.
fn equally_many(a: &[Cell], b: &[Cell]) -> (Vec<Cell>, Vec<Cell>) {
    let (mut i, mut j) = (1, 1);
    while i * a.len() != j * b.len() {
        if i * a.len() < j * b.len() { i += 1 } else { j += 1 }
    }
    let times = |list: &[Cell], times: usize| list.iter().flat_map(|cell| vec![*cell; times]).collect();
    (times(a, i), times(b, j))
}

/// The sum over classes; the diameter for a class in one world only.
fn over_classes(a: &[Thing], b: &[Thing], distance: impl Fn(&[Cell], &[Cell]) -> f64) -> f64 {
    let of_class = |class: &&str| {
        let (a, b) = (cells(a, class), cells(b, class));
        match (a.is_empty(), b.is_empty()) {
            (true, true) => 0.0,
            (false, false) => distance(&a, &b),
            _ => diameter(),
        }
    };
    CLASSES.iter().map(of_class).sum()
}

fn earth_movers(a: &[Cell], b: &[Cell]) -> f64 {
    let (a, b) = equally_many(a, b);
    least_sum(&a, &b, &metres) / a.len() as f64
}

fn occupied(things: &[Thing]) -> BTreeSet<(&'static str, Cell)> {
    let of_class = |class: &&'static str| {
        cells(things, class)
            .into_iter()
            .map(|cell| (*class, cell))
            .collect::<Vec<_>>()
    };
    CLASSES.iter().flat_map(of_class).collect()
}

/// The distance from each occupied cell to the nearest of its class; the diameter, once, for a class without cells to start from.
fn nearest_distances(a: &[Thing], b: &[Thing]) -> Vec<f64> {
    let mut nearest_distances = Vec::new();
    for class in CLASSES {
        let unique = |things: &[Thing]| cells(things, class).into_iter().collect::<BTreeSet<_>>();
        let (from, to) = (unique(a), unique(b));
        let nearest = |cell: &Cell| to.iter().map(|other| metres(cell, other)).fold(diameter(), f64::min);
        nearest_distances.extend(from.iter().map(nearest));
        if from.is_empty() && !to.is_empty() {
            nearest_distances.push(diameter());
        }
    }
    nearest_distances
}

#[track_caller]
fn assert_near(measure: &str, found: f64, expected: f64) {
    assert!(
        (found - expected).abs() < 1e-9,
        "{measure}: {found}, by hand {expected}"
    );
}

proptest! {
    #![proptest_config(ProptestConfig::with_cases(crate::tier::quick_or_full(24, 256)))]

    #[test]
    fn earth_movers_match_the_best_pairing(a in things(), b in things()) {
        // At most 3 objects per class, so that pairings are few.
        let few = |things: &[Thing]| things[..things.len().min(3)].to_vec();
        let (a, b) = (few(&a), few(&b));
        let found = between(WorldMeasure::EarthMovers, &a, &b);
        assert_near("earth_movers", found, over_classes(&a, &b, earth_movers));
    }

    #[test]
    fn jaccard_matches_the_sets_of_cells(a in things(), b in things()) {
        let (left, right) = (occupied(&a), occupied(&b));
        let (common, all) = (left.intersection(&right).count() as f64, left.union(&right).count() as f64);
        let share = if all == 0.0 { 0.0 } else { (all - common) / all };
        assert_near("jaccard", between(WorldMeasure::Jaccard, &a, &b), share);
    }

    #[test]
    fn nearest_distances_match_brute_force(a in things(), b in things()) {
        use WorldMeasure::{Chamfer, Hausdorff};
        let (there, back) = (nearest_distances(&a, &b), nearest_distances(&b, &a));
        let largest = there.iter().chain(&back).copied().fold(0.0, f64::max);
        assert_near("hausdorff", between(Hausdorff, &a, &b), largest);
        let mean = |nearest_distances: &[f64]| nearest_distances.iter().sum::<f64>() / nearest_distances.len().max(1) as f64;
        assert_near("chamfer", between(Chamfer, &a, &b), f64::midpoint(mean(&there), mean(&back)));
    }

    #[test]
    fn object_and_colour_measures_match_the_best_pairing(a in things(), b in things()) {
        let larger = a.len().max(b.len()).max(1) as f64;
        let cost = |a: &Thing, b: &Thing| {
            let distance = libm::hypot(a.1[0] - b.1[0], a.1[1] - b.1[1]);
            if a.0.to_lowercase() == b.0.to_lowercase() { distance.min(10.0) } else { 10.0 }
        };
        let ospa = (least_sum(&a, &b, &cost) + 10.0 * a.len().abs_diff(b.len()) as f64) / larger;
        assert_near("ospa", between(WorldMeasure::Ospa, &a, &b), ospa);
        let count = |things: &[Thing], class: &str| things.iter().filter(|thing| thing.0.to_lowercase() == class).count();
        let pairs = CLASSES.map(|class| (count(&a, class), count(&b, class)));
        let difference: usize = pairs.iter().map(|(a, b)| a.abs_diff(*b)).sum();
        let largest: usize = pairs.iter().map(|(a, b)| a.max(b)).sum();
        let counts = difference as f64 / largest.max(1) as f64;
        assert_near("counts", between(WorldMeasure::Counts, &a, &b), counts);
        let colors = |things: &[Thing]| things.iter().filter_map(|thing| thing.2).collect::<Vec<_>>();
        let (left, right) = (colors(&a), colors(&b));
        for measure in ColorMeasure::ALL {
            let sum = least_sum(&left, &right, &|a, b| (measure.between(*a, *b) / measure.diameter()).min(1.0));
            let expected = (sum + left.len().abs_diff(right.len()) as f64) / left.len().max(right.len()).max(1) as f64;
            let measure = WorldMeasure::Colors(*measure);
            assert_near(measure.name(), between(measure, &a, &b), expected);
        }
    }
}
