//! Benchmarks a step, an image and a reset. `driftworld bench env` measures whole batches.

use std::hint::black_box;

use criterion::{Criterion, criterion_group, criterion_main};
use driftworld_env::{Action, CpuRenderer, Environment, Target};
use driftworld_spec::{Layout, Looks, Maze, Style, World};

/// A circle of 19 m radius, which passes between the objects.
const CURVE: Action = Action::Continuous([5.0, 15.0, 0.0]);

fn arena() -> World {
    World::from_json("arena_20.json", include_str!("../../src/throughput/arena_20.json")).expect("the scene is valid")
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
    draw(c, "a picture", arena());
    draw(c, "a natural picture", in_natural_style(arena()));
    draw(c, "a natural picture of a maze", in_natural_style(maze()));
}

/// The same world in the natural style: with surfaces, shadows, and clouds or a ceiling.
fn in_natural_style(world: World) -> World {
    let looks = Looks::of(Style::Natural);
    world
        .edit(|world| world.environment_params.looks = looks)
        .expect("looks are valid")
}

/// A maze of 8 × 8 cells, with the agent in the middle.
fn maze() -> World {
    let layout = Layout {
        maze: Some(Maze {
            seed: Some(7),
            ..Maze::default()
        }),
        ..Layout::default()
    };
    World::default()
        .edit(|world| {
            world.environment_params.layout = Some(layout);
            world.agent_params.coordinates = [1.5, 1.5];
        })
        .expect("the maze is valid")
}

/// Renders images along a circle.
fn draw(c: &mut Criterion, name: &str, world: World) {
    const SIZE: u32 = 84;
    let mut environment = Environment::new(world);
    let mut cameras = Vec::new();
    for _ in 0..240 {
        environment.step(CURVE).expect("the world has no end");
        cameras.push(environment.camera());
    }
    let pixels = (SIZE * SIZE) as usize;
    let (mut rgb, mut depth, mut class) = (vec![0; 3 * pixels], vec![0.0; pixels], vec![0; pixels]);
    for (set, mut renderer) in CpuRenderer::each_instruction_set() {
        let mut next = cameras.iter().cycle();
        c.bench_function(&format!("{name} of 84 × 84 with depth and classes, {set}"), |bench| {
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
                    .expect("the sizes are valid");
            });
        });
    }
}

criterion_group!(benches, simulation, pictures);
criterion_main!(benches);
