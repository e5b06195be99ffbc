//! How long distances between distributions take: of samples, by closed form, by quadrature.

use std::hint::black_box;

use criterion::{Criterion, criterion_group, criterion_main};
use driftworld_similarity::distribution::{
    SortedSamples, energy, hellinger, jensen_shannon, maximum_mean_discrepancy, planar_wasserstein_1, total_variation,
    wasserstein_1, wasserstein_2,
};
use driftworld_spec::Distribution::{self, Annulus, Beta, Box, Normal, Triangular};

/// Numbers without an order, the same in each run.
fn scattered(count: u32, seed: f64) -> Vec<f64> {
    let golden = 0.618_033_988_749_894_9;
    (1..=count)
        .map(|k| (f64::from(k) * golden * (1.0 + seed)).fract() * 10.0)
        .collect()
}

fn samples(c: &mut Criterion) {
    let (x, y) = (scattered(256, 0.1), scattered(256, 0.2));
    let (mut a, mut b) = (SortedSamples::default(), SortedSamples::default());
    c.bench_function("Wasserstein-1 of 256 samples, sorting both", |bench| {
        bench.iter(|| {
            a.refill(black_box(&x)).expect("samples are numbers");
            b.refill(black_box(&y)).expect("samples are numbers");
            a.wasserstein_1(&b)
        });
    });
    c.bench_function("Wasserstein-1 of 256 samples, sorted before", |bench| {
        bench.iter(|| black_box(&a).wasserstein_1(black_box(&b)));
    });
    c.bench_function("energy distance of 256 samples, sorted before", |bench| {
        bench.iter(|| black_box(&a).energy(black_box(&b)));
    });
}

fn declared(c: &mut Criterion) {
    let normals = (Normal { mean: 0.0, std: 1.0 }, Normal { mean: 1.0, std: 2.0 });
    let tent = Triangular {
        low: 0.0,
        mode: 1.0,
        high: 4.0,
    };
    let beta = Beta {
        alpha: 2.0,
        beta: 0.7,
        low: None,
        high: None,
    };
    let mut time = |name: &str, measure: &dyn Fn(&Distribution, &Distribution) -> f64| {
        c.bench_function(&format!("{name} of normals"), |bench| {
            bench.iter(|| measure(black_box(&normals.0), black_box(&normals.1)));
        });
        c.bench_function(&format!("{name} of a triangle and a beta"), |bench| {
            bench.iter(|| measure(black_box(&tent), black_box(&beta)));
        });
    };
    let value = |found: Option<driftworld_similarity::distribution::Measured>| found.map_or(0.0, |found| found.value);
    time("Wasserstein-1", &|a, b| value(wasserstein_1(a, b)));
    time("Wasserstein-2", &|a, b| value(wasserstein_2(a, b)));
    time("energy distance", &|a, b| value(energy(a, b)));
    time("total variation", &|a, b| value(total_variation(a, b)));
    time("Hellinger distance", &|a, b| value(hellinger(a, b)));
    time("Jensen–Shannon distance", &|a, b| value(jensen_shannon(a, b)));
    time("mean discrepancy", &|a, b| value(maximum_mean_discrepancy(a, b, 1.0)));
}

fn planar(c: &mut Criterion) {
    let square = Box {
        low: [0.0, 0.0],
        high: [4.0, 4.0],
    };
    let ring = Annulus {
        center: [5.0, 1.0],
        inner: 1.0,
        outer: 3.0,
    };
    c.bench_function("Wasserstein-1 of a box and a ring by samples", |bench| {
        bench.iter(|| planar_wasserstein_1(black_box(&square), black_box(&ring)));
    });
}

criterion_group!(benches, samples, declared, planar);
criterion_main!(benches);
