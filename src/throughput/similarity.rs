//! How fast distances are measured and orders found: the jobs of the peers' script on inputs of the same kind, and two that only
//! we have.

#![expect(clippy::disallowed_methods, reason = "only its speed is measured")]

use std::time::Duration;

use crate::generator::Sampler;
use crate::similarity::distribution::SortedSamples;
use crate::similarity::{
    BitGrid, DistanceMatrix, Grid, GridShape, Lab, LabTable, Method, MetricProperties, OrderOptions, SimilarityError,
    Weights, Worlds, ciede2000_to_each, earth_movers_distance, grid_earth_movers_distance, grid_jaccard_distance,
    order,
};
use crate::spec::World;
use crate::tasks;
use serde_json::json;

use crate::Failure;

use super::{Figures, best_of_three, rate};

/// Items of the matrix and of the order.
const NUM_ITEMS: usize = 1000;

/// Pairs each second on one core; seconds of a matrix and of an order, on all cores.
pub(crate) fn measure(round: Duration) -> Result<Figures, Failure> {
    let mut figures = Figures::new();
    let mut add = |name: &str, pairs_a_second: f64| {
        figures.insert(name.to_owned(), json!(pairs_a_second.round()));
    };
    add("ciede2000", ciede2000(round)?);
    add("jaccard_50x50", jaccard(round)?);
    add("emd_20_points", points(round)?);
    add("emd_25x25", grids(round)?);
    add("wasserstein1_256", samples(round)?);
    add("wasserstein1_256_sorted_anew", samples_sorted_anew(round)?);
    let mut add = |name: &str, seconds: f64| {
        figures.insert(name.to_owned(), json!((seconds * 1000.0).round() / 1000.0));
    };
    add("matrix_1000_worlds_seconds", matrix()?);
    add("order_1000_seconds", ordering()?);
    Ok(figures)
}

/// Numbers in 0..1 that are as good as random and the same every time: Vigna's splitmix64.
struct Numbers(u64);

impl Numbers {
    fn next(&mut self) -> f64 {
        self.0 = self.0.wrapping_add(0x9e37_79b9_7f4a_7c15);
        let mut z = self.0;
        z = (z ^ (z >> 30)).wrapping_mul(0xbf58_476d_1ce4_e5b9);
        z = (z ^ (z >> 27)).wrapping_mul(0x94d0_49bb_1331_11eb);
        ((z ^ (z >> 31)) >> 11) as f64 / (1_u64 << 53) as f64
    }

    fn many(&mut self, count: usize) -> Vec<f64> {
        (0..count).map(|_| self.next()).collect()
    }
}

/// The pair of a number: each with each, over and over.
fn pair(number: u64, items: usize) -> (usize, usize) {
    let number = number as usize % (items * items);
    (number / items, number % items)
}

fn ciede2000(round: Duration) -> Result<f64, Failure> {
    let mut numbers = Numbers(0);
    let color = |numbers: &mut Numbers| {
        Lab([
            100.0 * numbers.next(),
            160.0 * numbers.next() - 80.0,
            160.0 * numbers.next() - 80.0,
        ])
    };
    let colors: Vec<Lab> = (0..1000).map(|_| color(&mut numbers)).collect();
    let table: LabTable = colors.iter().copied().collect();
    let mut distances = vec![0.0; colors.len()];
    let rows = rate(round, |row| {
        let from = colors[row as usize % colors.len()];
        ciede2000_to_each(from, &table, std::hint::black_box(&mut distances))
    })?;
    Ok(rows * colors.len() as f64)
}

fn jaccard(round: Duration) -> Result<f64, Failure> {
    let mut numbers = Numbers(1);
    let shape = GridShape::new(50, 50, 1, 1.0)?;
    let grids: Vec<BitGrid> = (0..200)
        .map(|_| BitGrid::new(shape, numbers.many(2500).into_iter().map(|x| x < 0.1)))
        .collect();
    // Half a row at a time: the clock is read seldom enough not to count.
    let rows = rate(round, |number| {
        let from = &grids[number as usize % grids.len()];
        for to in &grids[..100] {
            std::hint::black_box(grid_jaccard_distance(from, to)?);
        }
        Ok::<(), SimilarityError>(())
    })?;
    Ok(rows * 100.0)
}

fn points(round: Duration) -> Result<f64, Failure> {
    let mut numbers = Numbers(2);
    let mut set = || (0..20).map(|_| [numbers.next(), numbers.next()]).collect();
    let sets: Vec<Vec<[f64; 2]>> = (0..40).map(|_| set()).collect();
    Ok(rate(round, |number| {
        let (a, b) = pair(number, sets.len());
        earth_movers_distance(&sets[a], &sets[b]).map(|distance| {
            std::hint::black_box(distance);
        })
    })?)
}

fn grids(round: Duration) -> Result<f64, Failure> {
    let mut numbers = Numbers(3);
    let shape = GridShape::new(25, 25, 1, 1.0)?;
    let mut grid = || Ok::<_, SimilarityError>(Grid::new(shape, numbers.many(625))?.normalised());
    let grids = (0..6).map(|_| grid()).collect::<Result<Vec<_>, _>>()?;
    let pairs: Vec<(usize, usize)> = (0..6).flat_map(|a| (0..a).map(move |b| (a, b))).collect();
    Ok(rate(round, |number| {
        let (a, b) = pairs[number as usize % pairs.len()];
        grid_earth_movers_distance(&grids[a], &grids[b]).map(|distance| {
            std::hint::black_box(distance);
        })
    })?)
}

/// Each of 100 sets with each, the sorting of every set included.
fn samples(round: Duration) -> Result<f64, Failure> {
    let mut numbers = Numbers(4);
    let sets: Vec<Vec<f64>> = (0..100).map(|_| numbers.many(256)).collect();
    let jobs = rate(round, |_| {
        let sorted = sets
            .iter()
            .map(|set| SortedSamples::new(set))
            .collect::<Result<Vec<_>, _>>()?;
        for (index, a) in sorted.iter().enumerate() {
            for b in &sorted[..index] {
                std::hint::black_box(a.wasserstein_1(b));
            }
        }
        Ok::<(), SimilarityError>(())
    })?;
    Ok(jobs * (100.0 * 99.0 / 2.0))
}

/// Both sets sorted anew for every pair.
fn samples_sorted_anew(round: Duration) -> Result<f64, Failure> {
    let mut numbers = Numbers(4);
    let sets: Vec<Vec<f64>> = (0..100).map(|_| numbers.many(256)).collect();
    let (mut a, mut b) = (SortedSamples::new(&sets[0])?, SortedSamples::new(&sets[0])?);
    Ok(rate(round, |number| {
        let pair = pair(number, sets.len());
        a.refill(&sets[pair.0])?;
        b.refill(&sets[pair.1])?;
        std::hint::black_box(a.wasserstein_1(&b));
        Ok::<(), SimilarityError>(())
    })?)
}

/// The combined distance of each of 1,000 sampled worlds from each, the time of preparing them included.
fn matrix() -> Result<f64, Failure> {
    let task = tasks::variant("find_objects#red")?.task().clone();
    let samplers: Vec<Sampler> = task
        .all_variants()
        .iter()
        .map(|variant| Sampler::new(variant, 7))
        .collect();
    let draw = |index: usize| samplers[index % samplers.len()].world((index / samplers.len()) as u64);
    let worlds: Vec<World> = (0..NUM_ITEMS).map(draw).collect::<Result<_, _>>()?;
    let labels: Vec<String> = (0..NUM_ITEMS).map(|index| format!("{index:04}")).collect();
    best_of_three(|| {
        let worlds = Worlds::new(&worlds, Weights::default());
        DistanceMatrix::measure(labels.clone(), |a, b| Ok::<_, SimilarityError>(worlds.distance(a, b))).map(drop)
    })
}

/// A short path through 1,000 points of a square.
fn ordering() -> Result<f64, Failure> {
    let mut numbers = Numbers(5);
    let points: Vec<[f64; 2]> = (0..NUM_ITEMS).map(|_| [numbers.next(), numbers.next()]).collect();
    let labels = (0..NUM_ITEMS).map(|index| format!("{index:04}")).collect();
    let apart = |a: usize, b: usize| (points[a][0] - points[b][0]).hypot(points[a][1] - points[b][1]);
    let matrix = DistanceMatrix::measure(labels, |a, b| Ok::<_, SimilarityError>(apart(a, b)))?
        .with_properties(MetricProperties::Metric);
    best_of_three(|| order(&matrix, Method::TwoOpt, &OrderOptions::default()).map(drop))
}
