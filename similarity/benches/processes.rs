//! Benchmarks of distances between decision processes and between rewards. The processes model an agent walking on a grid of
//! cells.

use std::hint::black_box;

use criterion::{Criterion, criterion_group, criterion_main};
use driftworld_similarity::{Mdp, RewardSamples, bisimulation};

/// Cells per side, headings, actions: ahead, back, turn right, turn left, stay.
const SIDE: usize = 60;
const HEADINGS: usize = 8;
const ACTIONS: usize = 5;
const STEPS: [(isize, isize); HEADINGS] = [(0, 1), (1, 1), (1, 0), (1, -1), (0, -1), (-1, -1), (-1, 0), (-1, 1)];

/// The cell that a step leads to, on a square with `side` cells per side; `cell` if the edge or the wall is in the way.
fn ahead(side: usize, wall: Option<usize>, cell: usize, heading: usize, back: bool) -> usize {
    let (east, north) = STEPS[(heading + if back { HEADINGS / 2 } else { 0 }) % HEADINGS];
    let x = (cell % side).checked_add_signed(east).filter(|x| *x < side);
    let y = (cell / side).checked_add_signed(north).filter(|y| *y < side);
    let to = x.zip(y).map(|(x, y)| y * side + x);
    // The wall is a column with a gap in its middle.
    to.filter(|to| Some(to % side) != wall || to / side == side / 2)
        .unwrap_or(cell)
}

/// A grid to walk on, with an absorbing goal that pays 1.
fn grid(side: usize, wall: Option<usize>, goal: usize) -> Mdp {
    let (mut next, mut rewards) = (Vec::new(), Vec::new());
    for state in 0..side * side * HEADINGS {
        let (cell, heading) = (state / HEADINGS, state % HEADINGS);
        for action in 0..ACTIONS {
            let (to, turned) = match action {
                _ if cell == goal => (cell, heading),
                0 | 1 => (ahead(side, wall, cell, heading, action == 1), heading),
                2 => (cell, (heading + 1) % HEADINGS),
                3 => (cell, (heading + HEADINGS - 1) % HEADINGS),
                _ => (cell, heading),
            };
            next.push((to * HEADINGS + turned) as u32);
            rewards.push(f64::from(to == goal && cell != goal));
        }
    }
    Mdp::new(side * side * HEADINGS, ACTIONS, next, rewards).expect("the grid is valid")
}

fn large(c: &mut Criterion) {
    let (open, walled) = (grid(SIDE, None, 0), grid(SIDE, Some(20), 0));
    let mut group = c.benchmark_group("processes of 28,800 states");
    group.sample_size(10);
    group.bench_function("bisimulation from one state, a wall", |bench| {
        bench.iter(|| black_box(bisimulation(&open, &walled, (10_000, 10_000), 0.99, 1 << 20)));
    });
    group.finish();
}

fn rewards(c: &mut Criterion) {
    let potential = |k: usize| (k * 7919 % 1000) as f64;
    let transitions = (0..1000).map(|k| (potential(k), (), potential(k + 1))).collect();
    let samples =
        RewardSamples::new(transitions, (0..1000).map(|k| ((), potential(k))).collect()).expect("there are samples");
    let mut group = c.benchmark_group("rewards");
    group.sample_size(10);
    group.bench_function("measuring a reward on 1000 transitions, 1000 draws", |bench| {
        bench.iter(|| black_box(samples.measure(|from, (), to| to - from)));
    });
    group.finish();
}

criterion_group!(benches, large, rewards);
criterion_main!(benches);
