//! How long a step, a picture and a reset take. Whole batches are measured by `driftworld bench env`.

use std::hint::black_box;

use criterion::{Criterion, criterion_group, criterion_main};
use driftworld_env::{Action, CpuRenderer, Environment, Target};
use driftworld_spec::World;

/// A circle of 19 m radius, which passes between the objects.
const CURVE: Action = Action::Continuous([5.0, 15.0, 0.0]);

fn arena() -> World {
    World::from_json("arena_20.json", include_str!("scenes/arena_20.json")).expect("the scene is sound")
}

fn simulation(c: &mut Criterion) {
    let mut environment = Environment::new(arena());
    c.bench_function("a step without pictures, 20 objects", |bench| {
        bench.iter(|| black_box(environment.step(CURVE)));
    });
    let world = arena();
    c.bench_function("a reset, 20 objects", |bench| {
        bench.iter(|| environment.reset(world.clone()));
    });
}

fn pictures(c: &mut Criterion) {
    const SIZE: u32 = 84;
    let mut environment = Environment::new(arena());
    let mut cameras = Vec::new();
    for _ in 0..240 {
        environment.step(CURVE).expect("the world has no end");
        cameras.push(environment.camera());
    }
    let pixels = (SIZE * SIZE) as usize;
    let (mut rgb, mut depth, mut class) = (vec![0; 3 * pixels], vec![0.0; pixels], vec![0; pixels]);
    for (set, mut renderer) in CpuRenderer::each_instruction_set() {
        let mut next = cameras.iter().cycle();
        c.bench_function(
            &format!("a picture of 84 × 84 with depth and classes, {set}"),
            |bench| {
                bench.iter(|| {
                    let camera = next.next().expect("a circle has no end");
                    let mut target = Target {
                        width: SIZE,
                        height: SIZE,
                        rgb: Some(&mut rgb),
                        depth: Some(&mut depth),
                        class: Some(&mut class),
                        ..Target::default()
                    };
                    renderer
                        .draw(environment.scene(), camera, &mut target)
                        .expect("the sizes are sound");
                });
            },
        );
    }
}

criterion_group!(benches, simulation, pictures);
criterion_main!(benches);
