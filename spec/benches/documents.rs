//! Benchmarks of reading and checking documents. Sampling worlds is measured in generator/benches/worlds.rs.

use std::hint::black_box;

use criterion::{Criterion, criterion_group, criterion_main};
use driftworld_spec::{Layout, Maze, Object, TaskSpec, World, WorldDraft};

fn world_of(objects: u32) -> String {
    let objects = (0..objects).map(|number| {
        let mut object = Object::new("tree", [f64::from(number) * 0.71, 3.25]);
        object.tag = Some("trees".to_owned());
        object.heading = f64::from(number);
        object
    });
    let objects = objects.collect();
    let draft = WorldDraft::with_objects(objects);
    draft.check().expect("the world is valid").to_json()
}

fn documents(c: &mut Criterion) {
    let text = world_of(30);
    c.bench_function("validate a world of 30 objects", |bench| {
        bench.iter(|| World::from_json("world.json", black_box(&text)).expect("the world is valid"));
    });
    let misspelt = text.replacen("\"heading\"", "\"haeding\"", 1);
    c.bench_function("refuse a world of 30 objects", |bench| {
        bench.iter(|| World::from_json("world.json", black_box(&misspelt)).expect_err("a key is misspelt"));
    });
    let world = World::from_json("world.json", &text).expect("the world is valid");
    c.bench_function("write a world of 30 objects", |bench| {
        bench.iter(|| black_box(&world).to_json());
    });
    let path = concat!(env!("CARGO_MANIFEST_DIR"), "/../examples/tasks/settlement.json");
    let task = std::fs::read_to_string(path).expect("the example tasks ship with the project");
    c.bench_function("load a task spec", |bench| {
        bench.iter(|| TaskSpec::from_json("task.json", black_box(&task)).expect("the task is valid"));
    });
}

/// Plans a maze of 20 × 20 cells from a seed.
fn layouts(c: &mut Criterion) {
    let layout = Layout {
        maze: Some(Maze {
            cells: [20, 20],
            braid: 0.2,
            ..Maze::default()
        }),
        ..Layout::default()
    };
    let mut seed = 0;
    c.bench_function("draw a maze of 20 x 20 cells", |bench| {
        bench.iter(|| {
            seed += 1;
            black_box(&layout).plan(seed)
        });
    });
}

criterion_group!(benches, documents, layouts);
criterion_main!(benches);
