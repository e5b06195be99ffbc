//! Benchmarks of distances between colours, pictures and sets of colours.

#![expect(clippy::disallowed_methods, reason = "only its speed is measured")]

use std::hint::black_box;

use criterion::{Criterion, criterion_group, criterion_main};
use driftworld_similarity::picture::{Picture, picture_oklab, structural_similarity};
use driftworld_similarity::{Assignment, ColorMeasure, Lab, ciede2000, color_sets_distance, ospa};
use driftworld_spec::Color;

/// Pseudo-random numbers in 0..1, the same on every run: scrambled fractions of multiples of the golden ratio.
fn number(index: usize) -> f64 {
    let mixed = (index as u64).wrapping_mul(0x9E37_79B9_7F4A_7C15);
    let mixed = (mixed ^ (mixed >> 29)).wrapping_mul(0xBF58_476D_1CE4_E5B9);
    (mixed >> 11) as f64 / (1u64 << 53) as f64
}

fn colors(count: usize, from: usize) -> Vec<Color> {
    let color = |k: usize| Color([0, 1, 2].map(|channel| number(from + 3 * k + channel)));
    (0..count).map(color).collect()
}

fn differences(c: &mut Criterion) {
    let labs: Vec<Lab> = colors(1000, 0).into_iter().map(Lab::from).collect();
    c.bench_function("CIEDE2000, 1000 Lab pairs, one by one", |bench| {
        bench.iter(|| labs.iter().map(|&lab| ciede2000(labs[0], lab)).sum::<f64>());
    });
    let (a, b) = (colors(20, 0), colors(15, 999));
    c.bench_function("a set of 20 colours to one of 15, Oklab", |bench| {
        bench.iter(|| color_sets_distance(black_box(&a), &b, ColorMeasure::Oklab));
    });
}

fn pictures(c: &mut Criterion) {
    const SIDE: usize = 64;
    let bytes = |from: usize| -> Vec<u8> { (0..SIDE * SIDE * 3).map(|k| (number(from + k) * 256.0) as u8).collect() };
    let (a, b) = (bytes(0), bytes(1_000_000));
    let view = |rgb| Picture::new(rgb, SIDE, SIDE).expect("the size is valid");
    c.bench_function("SSIM of pictures of 64 × 64", |bench| {
        bench.iter(|| structural_similarity(view(black_box(&a)), view(&b)));
    });
    c.bench_function("mean Oklab difference of pictures of 64 × 64", |bench| {
        bench.iter(|| picture_oklab(view(black_box(&a)), view(&b)));
    });
}

fn assignments(c: &mut Criterion) {
    let points = |count: usize, from: usize| -> Vec<[f64; 2]> {
        (0..count)
            .map(|k| [number(from + 2 * k), number(from + 2 * k + 1)])
            .collect()
    };
    let mut assignment = Assignment::new();
    for side in [20, 200] {
        let (a, b) = (points(side, 0), points(side, 5000));
        let distance = |a: &[f64; 2], b: &[f64; 2]| (a[0] - b[0]).hypot(a[1] - b[1]);
        let costs: Vec<f64> = a.iter().flat_map(|a| b.iter().map(move |b| distance(a, b))).collect();
        c.bench_function(&format!("assignment of {side} × {side} points of a square"), |bench| {
            bench.iter(|| assignment.solve(black_box(&costs), side, side));
        });
    }
    let objects = |count, from| {
        points(count, from)
            .into_iter()
            .map(|position| ((), position))
            .collect::<Vec<_>>()
    };
    let (a, b) = (objects(20, 0), objects(15, 5000));
    c.bench_function("OSPA of 20 and 15 points", |bench| {
        bench.iter(|| ospa(black_box(&a), &b, 0.5));
    });
}

criterion_group!(benches, differences, pictures, assignments);
criterion_main!(benches);
