//! Benchmarks of orders and maps, from a given matrix of distances.

#![expect(clippy::disallowed_methods, reason = "only its speed is measured")]

use std::hint::black_box;

use criterion::{Criterion, criterion_group, criterion_main};
use driftworld_similarity::{DistanceMatrix, Method, OrderOptions, SimilarityError, classical_map, order};

/// Points in a square, the same on every machine.
fn points(n: usize) -> DistanceMatrix {
    let mut state = 1_u64;
    let mut unit = || {
        state = state
            .wrapping_mul(6_364_136_223_846_793_005)
            .wrapping_add(1_442_695_040_888_963_407);
        (state >> 11) as f64 / (1_u64 << 53) as f64
    };
    let at: Vec<[f64; 2]> = (0..n).map(|_| [unit(), unit()]).collect();
    let gap = |a: usize, b: usize| Ok::<_, SimilarityError>((at[a][0] - at[b][0]).hypot(at[a][1] - at[b][1]));
    DistanceMatrix::measure((0..n).map(|k| format!("{k:05}")).collect(), gap).expect("distances of points are valid")
}

fn orders(c: &mut Criterion) {
    let (few, many) = (points(15), points(1000));
    for &method in Method::ALL {
        let matrix = if method == Method::Exact { &few } else { &many };
        let options = OrderOptions {
            target_step: Some(0.1),
            ..OrderOptions::default()
        };
        let name = format!("{} of {} items", method.name(), matrix.len());
        let mut group = c.benchmark_group("orders");
        group.sample_size(10);
        group.bench_function(name, |bench| {
            bench.iter(|| black_box(order(matrix, method, &options).expect("the method accepts these items")));
        });
        group.finish();
    }
}

fn matrices(c: &mut Criterion) {
    let many = points(1000);
    let mut group = c.benchmark_group("matrices");
    group.sample_size(10);
    group.bench_function("a map of 1000 items", |bench| {
        bench.iter(|| black_box(classical_map(&many)));
    });
    group.finish();
}

criterion_group!(benches, orders, matrices);
criterion_main!(benches);
