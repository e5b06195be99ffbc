//! Benchmarks of sampling worlds. Reading worlds is measured in spec/benches/documents.rs.

use std::hint::black_box;
use std::sync::Arc;

use criterion::{Criterion, criterion_group, criterion_main};
use driftworld_generator::{Sampler, Sequence, drift};
use driftworld_spec::{TaskSpec, Variant};

fn task(name: &str) -> Arc<TaskSpec> {
    let path = format!("{}/../examples/tasks/{name}.json", env!("CARGO_MANIFEST_DIR"));
    let text = std::fs::read_to_string(&path).expect("the example tasks ship with the project");
    TaskSpec::from_json(&path, &text).expect("the example tasks are valid")
}

fn variant(task: &str, name: &str) -> Variant {
    self::task(task)
        .variant(name)
        .expect("the example tasks have these variants")
}

const CROWD: &str = r#"{ "version": 2, "name": "crowd", "world": { "environment_params": { "map_size": [300, 300] } },
    "groups": [{ "name": "rocks", "count": 10000, "object": { "class": "rock" }, "separation": 1,
                 "placement": { "box": { "low": [-149, -149], "high": [149, 149] } } }] }"#;

fn worlds(c: &mut Criterion) {
    let crowd = TaskSpec::from_json("crowd.json", CROWD).expect("the task is valid");
    let cases = [
        (
            "find_objects, 15 to 19 objects",
            Sampler::new(&variant("find_objects", "red"), 7),
        ),
        (
            "settlement, about 86 objects",
            Sampler::new(&variant("settlement", "near"), 7),
        ),
        (
            "crowd, 10,000 objects",
            Sampler::new(&crowd.variant("default").expect("the default variant always exists"), 7),
        ),
    ];
    for (name, sampler) in cases {
        let mut index = 0;
        c.bench_function(name, |bench| {
            bench.iter(|| {
                index += 1;
                black_box(sampler.world(index).expect("the examples can be placed"))
            });
        });
    }
}

fn values(c: &mut Criterion) {
    let settlement = variant("settlement", "near");
    for (name, sequence) in [("independent", Sequence::Independent), ("sobol", Sequence::Sobol)] {
        let sampler = Sampler::new(&settlement, 7).with_sequence(sequence);
        let mut index = 0;
        c.bench_function(&format!("randomized parameters, {name}"), |bench| {
            bench.iter(|| {
                index += 1;
                black_box(sampler.values(index).expect("the task has no requirements"))
            });
        });
    }
}

fn preparing(c: &mut Criterion) {
    let red = variant("find_objects", "red");
    c.bench_function("prepare a sampler", |bench| {
        bench.iter(|| black_box(Sampler::new(&red, 7)));
    });
    let blue = variant("find_objects", "blue");
    c.bench_function("a variant of a drift", |bench| {
        bench.iter(|| black_box(drift(&blue, &red, 0.3).expect("both variants belong to one task")));
    });
}

criterion_group!(benches, worlds, values, preparing);
criterion_main!(benches);
