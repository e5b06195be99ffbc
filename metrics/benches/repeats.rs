//! Benchmarks of statistics over repeated runs, from synthetic scores.

use std::hint::black_box;

use criterion::{Criterion, criterion_group, criterion_main};
use driftworld_metrics::{Aggregate, BootstrapOptions, ScoreTable, estimate, probability_of_improvement};

/// Ten runs of ten tasks; the scores follow a Weyl sequence, the same on every machine.
fn ten_by_ten(start: f64) -> ScoreTable {
    let scores = |run: u32| {
        let score = move |task: u32| (start + f64::from(run * 10 + task) * 0.618_033_988_749_894_9).fract();
        (0..10_u32).map(move |task| (task.to_string(), score(task)))
    };
    ScoreTable::from_runs((0..10_u32).map(|run| (run.to_string(), scores(run)))).expect("a hundred numbers below 1")
}

fn repeats(c: &mut Criterion) {
    let (a, b) = (ten_by_ten(0.0), ten_by_ten(0.3));
    let options = BootstrapOptions {
        resamples: 50_000,
        ..BootstrapOptions::default()
    };
    let mut group = c.benchmark_group("50,000 resamples of 10 runs of 10 tasks");
    group.sample_size(10);
    group.bench_function("interquartile mean", |bench| {
        bench.iter(|| black_box(estimate(&a, [Aggregate::Iqm], &options).expect("the options are valid")));
    });
    group.bench_function("mean, median and interquartile mean", |bench| {
        let all = [Aggregate::Mean, Aggregate::Median, Aggregate::Iqm];
        bench.iter(|| black_box(estimate(&a, all, &options).expect("the options are valid")));
    });
    group.bench_function("probability of improvement", |bench| {
        bench.iter(|| black_box(probability_of_improvement(&a, &b, &options).expect("the tasks are the same")));
    });
    group.finish();
}

criterion_group!(benches, repeats);
criterion_main!(benches);
