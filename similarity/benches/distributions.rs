//! Benchmarks of distances between distributions: by closed form, by quadrature, by samples.

use std::hint::black_box;

use criterion::{Criterion, criterion_group, criterion_main};
use driftworld_similarity::distribution::{
    energy, hellinger, jensen_shannon, planar_wasserstein_1, total_variation, wasserstein_1, wasserstein_2,
};
use driftworld_spec::Distribution::{self, Annulus, Beta, Box, Normal, Triangular};

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

criterion_group!(benches, declared, planar);
criterion_main!(benches);
