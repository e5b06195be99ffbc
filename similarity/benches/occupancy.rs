//! How many pairs of grids and of points are measured a second: `cargo bench -p driftworld-similarity --bench occupancy`. The inputs are
//! those of [`OccupancyWorkload`], so that `driftworld bench` counts the same.

use std::hint::black_box;

use criterion::{Criterion, Throughput, criterion_group, criterion_main};
use driftworld_similarity::OccupancyWorkload;

type Job = fn(&OccupancyWorkload) -> (usize, f64);

fn pairs(c: &mut Criterion) {
    let work = OccupancyWorkload::new();
    let jobs: [(&str, Job); 5] = [
        ("Jaccard, grids of 50 × 50", OccupancyWorkload::jaccard_50x50),
        (
            "exact earth mover's, 20 and 20 points",
            OccupancyWorkload::emd_20_points,
        ),
        ("exact earth mover's, grids of 25 × 25", OccupancyWorkload::emd_25x25),
        ("Sinkhorn, grids of 25 × 25", OccupancyWorkload::sinkhorn_25x25),
        ("sliced Wasserstein, grids of 25 × 25", OccupancyWorkload::sliced_25x25),
    ];
    let mut group = c.benchmark_group("pairs");
    for (name, job) in jobs {
        group.throughput(Throughput::Elements(job(&work).0 as u64));
        group.bench_function(name, |bench| bench.iter(|| black_box(job(&work))));
    }
    group.finish();
}

criterion_group!(benches, pairs);
criterion_main!(benches);
