//! How long distances of decision processes and of rewards take. The processes are those of an agent that walks on a grid of cells.

use std::hint::black_box;

use criterion::{Criterion, criterion_group, criterion_main};
use driftworld_similarity::{Epic, Mdp, RewardSamples, RewardTable, bisimulation, paired_bisimulation, w1_mdp};

/// Cells of a side, headings, actions: ahead, back, turn left, turn right, stay.
const SIDE: usize = 60;
const HEADINGS: usize = 8;
const ACTIONS: usize = 5;
const STEPS: [(isize, isize); HEADINGS] = [(0, 1), (1, 1), (1, 0), (1, -1), (0, -1), (-1, -1), (-1, 0), (-1, 1)];

/// Where a step leads on a square of so many cells a side; against the edge, or into the wall, it does not.
fn ahead(side: usize, wall: Option<usize>, cell: usize, heading: usize, back: bool) -> usize {
    let (east, north) = STEPS[(heading + if back { HEADINGS / 2 } else { 0 }) % HEADINGS];
    let x = (cell % side).checked_add_signed(east).filter(|x| *x < side);
    let y = (cell / side).checked_add_signed(north).filter(|y| *y < side);
    let to = x.zip(y).map(|(x, y)| y * side + x);
    // The wall is a column with a gap in its middle.
    to.filter(|to| Some(to % side) != wall || to / side == side / 2)
        .unwrap_or(cell)
}

/// A grid to walk on, with a goal that pays 1 and keeps.
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
            next.push(to * HEADINGS + turned);
            rewards.push(f64::from(to == goal && cell != goal));
        }
    }
    Mdp::deterministic(side * side * HEADINGS, ACTIONS, &next, rewards).expect("the grid is sound")
}

/// Metres between cells of a metre.
fn metres(s: usize, t: usize) -> f64 {
    let [(a, b), (c, d)] = [s, t].map(|state| (state / HEADINGS % SIDE, state / HEADINGS / SIDE));
    let (x, y) = (a.abs_diff(c) as f64, b.abs_diff(d) as f64);
    (x * x + y * y).sqrt()
}

fn large(c: &mut Criterion) {
    let (open, walled) = (grid(SIDE, None, 0), grid(SIDE, Some(20), 0));
    let elsewhere = grid(SIDE, None, SIDE * SIDE - 1);
    let weights = vec![1.0; open.states()];
    let every: Vec<(usize, usize)> = (0..open.states()).map(|state| (state, state)).collect();
    let mut group = c.benchmark_group("processes of 28,800 states");
    group.sample_size(10);
    group.bench_function("w1-mdp, state by state", |bench| {
        bench.iter(|| black_box(w1_mdp(&open, &walled, &weights, metres)));
    });
    for (name, other) in [("the goal elsewhere", &elsewhere), ("a wall", &walled)] {
        group.bench_function(format!("paired bisimulation from all states, {name}"), |bench| {
            bench.iter(|| black_box(paired_bisimulation(&open, other, &every, 0.99, 1 << 20)));
        });
    }
    group.bench_function("paired bisimulation from one state, a wall", |bench| {
        bench.iter(|| {
            black_box(paired_bisimulation(
                &open,
                &walled,
                &every[10_000..10_001],
                0.99,
                1 << 20,
            ))
        });
    });
    group.bench_function("optimal values", |bench| {
        bench.iter(|| black_box(open.optimal_values(0.99, 1e-9)));
    });
    group.finish();
}

fn small(c: &mut Criterion) {
    let (open, walled) = (grid(4, None, 0), grid(4, Some(2), 0));
    let mut group = c.benchmark_group("processes of 128 states");
    group.sample_size(10);
    group.bench_function("bisimulation, discount 0.9, to 1e-9", |bench| {
        bench.iter(|| black_box(bisimulation(&open, &walled, 0.9, 1e-9)));
    });
    group.finish();
}

fn rewards(c: &mut Criterion) {
    let table =
        |goal: usize| RewardTable::from_fn(100, 5, |_, _, to| f64::from(to == goal)).expect("rewards are sound");
    let (one, other) = (table(3), table(50));
    let epic = Epic::new(0.99).expect("the discount is sound");
    let places = |k: usize| (k * 7919 % 1000) as f64;
    let transitions = (0..1000).map(|k| (places(k), (), places(k + 1))).collect();
    let samples =
        RewardSamples::new(transitions, (0..1000).map(|k| ((), places(k))).collect()).expect("there are samples");
    let mut group = c.benchmark_group("rewards");
    group.sample_size(10);
    group.bench_function("epic of tables of 100 states, 5 actions", |bench| {
        bench.iter(|| black_box(epic.distance(&one, &other)));
    });
    group.bench_function("measuring a reward on 1000 transitions, 1000 draws", |bench| {
        bench.iter(|| black_box(samples.measure(|from, (), to| to - from)));
    });
    group.finish();
}

criterion_group!(benches, large, small, rewards);
criterion_main!(benches);
