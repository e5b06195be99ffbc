//! Benchmarks of distances between grids and between point sets, in pairs per second. Inputs are drawn with a fixed seed; their
//! number and sizes match the benchmarks of the Python tools. Run with `cargo bench -p driftworld-similarity --bench occupancy`.

use std::hint::black_box;

use criterion::{Criterion, Throughput, criterion_group, criterion_main};
use driftworld_similarity::{
    BitGrid, Grid, GridShape, earth_movers_distance, grid_earth_movers_distance, grid_jaccard_distance,
};

/// Numbers in 0..1 that are the same on every run: Vigna's splitmix64.
struct Random(u64);

impl Random {
    fn next(&mut self) -> f64 {
        self.0 = self.0.wrapping_add(0x9e37_79b9_7f4a_7c15);
        let mut bits = self.0;
        bits = (bits ^ (bits >> 30)).wrapping_mul(0xbf58_476d_1ce4_e5b9);
        bits = (bits ^ (bits >> 27)).wrapping_mul(0x94d0_49bb_1331_11eb);
        ((bits ^ (bits >> 31)) >> 11) as f64 / (1u64 << 53) as f64
    }
}

fn shape(side: usize) -> GridShape {
    GridShape::new(side, side, 1, 1.0).expect("a small grid of cells of 1 m is valid")
}

/// Measures every pair of items once per iteration.
fn pairs<T>(c: &mut Criterion, name: &str, items: &[T], measure: impl Fn(&T, &T) -> f64) {
    let mut group = c.benchmark_group("pairs");
    group.throughput(Throughput::Elements((items.len() * (items.len() - 1) / 2) as u64));
    group.bench_function(name, |bench| {
        bench.iter(|| {
            for (index, a) in items.iter().enumerate() {
                for b in &items[..index] {
                    black_box(measure(a, b));
                }
            }
        });
    });
    group.finish();
}

fn jaccard(c: &mut Criterion) {
    let mut random = Random(0);
    let mut cells = || (0..2500).map(|_| random.next() < 0.1).collect::<Vec<bool>>();
    let grids: Vec<BitGrid> = (0..200).map(|_| BitGrid::new(shape(50), cells())).collect();
    pairs(c, "Jaccard, grids of 50 × 50", &grids, |a, b| {
        grid_jaccard_distance(a, b).expect("the grids have the same shape")
    });
}

fn points(c: &mut Criterion) {
    let mut random = Random(1);
    let mut set = || (0..20).map(|_| [random.next(), random.next()]).collect();
    let sets: Vec<Vec<[f64; 2]>> = (0..40).map(|_| set()).collect();
    pairs(c, "exact earth mover's, 20 and 20 points", &sets, |a, b| {
        earth_movers_distance(a, b).expect("the points are finite")
    });
}

fn masses(c: &mut Criterion) {
    let mut random = Random(2);
    let mut masses = || (0..625).map(|_| random.next()).collect();
    let grid = |masses| {
        Grid::new(shape(25), masses)
            .expect("numbers from 0 to 1 are masses")
            .normalised()
    };
    let grids: Vec<Grid> = (0..6).map(|_| grid(masses())).collect();
    pairs(c, "exact earth mover's, grids of 25 × 25", &grids, |a, b| {
        grid_earth_movers_distance(a, b).expect("the masses are equal")
    });
}

criterion_group!(benches, jaccard, points, masses);
criterion_main!(benches);
