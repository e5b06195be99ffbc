//! Renders batches of images on the machine's first adapter, which may be software, and on the CPU.

use criterion::{Criterion, Throughput, criterion_group};
use driftworld_env::{Action, Camera, CpuRenderer, Environment, GpuRenderer, Picture, Target};
use driftworld_spec::World;

const SIZE: u32 = 84;
const PIXELS: usize = (SIZE * SIZE) as usize;

/// An environment, and cameras on a circle between its objects.
fn circle() -> (Environment, Vec<Camera>) {
    let text = include_str!("../../../src/throughput/arena_20.json");
    let world = World::from_json("arena_20.json", text).expect("the scene is valid");
    let mut environment = Environment::new(world);
    let mut cameras = Vec::new();
    for _ in 0..240 {
        let curve = Action::Continuous([5.0, 15.0, 0.0]);
        environment.step(curve).expect("the world has no end");
        cameras.push(environment.camera());
    }
    (environment, cameras)
}

/// One batch of images per run: colour only, or with depth and classes.
fn batches(c: &mut Criterion) {
    let mut gpu = GpuRenderer::new(true).expect("there is an adapter");
    let (environment, cameras) = circle();
    for (modalities, depths) in [("colour", 0), ("colour, depth, classes", PIXELS)] {
        for count in [64, 256] {
            let mut group = c.benchmark_group(format!("{modalities} on {}", gpu.adapter_name()));
            group.throughput(Throughput::Elements(count as u64));
            let mut images = vec![(vec![0; 3 * PIXELS], vec![0.0; depths], vec![0; depths]); count];
            group.bench_function(format!("{count} pictures of 84 × 84"), |bench| {
                bench.iter(|| {
                    // Spread evenly around the circle for every batch size.
                    let around = (0..count).map(|k| &cameras[k * cameras.len() / count]);
                    let views = images.iter_mut().zip(around);
                    let mut pictures: Vec<_> = views
                        .map(|((rgb, depth, class), camera)| Picture {
                            scene: environment.scene(),
                            camera: *camera,
                            target: Target {
                                width: SIZE,
                                height: SIZE,
                                rgb: Some(rgb),
                                depth: (depths > 0).then_some(depth),
                                class: (depths > 0).then_some(class),
                                ..Target::default()
                            },
                        })
                        .collect();
                    gpu.draw_batch(&mut pictures).expect("the adapter renders");
                });
            });
            group.finish();
        }
    }
}

/// Renders colour images on the CPU, on one thread.
fn processor(c: &mut Criterion) {
    let (environment, cameras) = circle();
    let mut renderer = CpuRenderer::new();
    let mut rgb = vec![0; 3 * PIXELS];
    let mut group = c.benchmark_group(format!("colour on the processor ({})", renderer.instruction_set()));
    group.throughput(Throughput::Elements(64));
    group.bench_function("64 pictures of 84 × 84", |bench| {
        bench.iter(|| {
            for camera in (0..64).map(|k| &cameras[k * cameras.len() / 64]) {
                let mut target = Target::of_colors([SIZE, SIZE], &mut rgb);
                renderer
                    .draw(environment.scene(), camera, &mut target)
                    .expect("the sizes are valid");
            }
        });
    });
    group.finish();
}

criterion_group!(benches, batches, processor);

/// Runs the benchmarks with the command line's arguments.
pub(super) fn run() {
    benches();
    Criterion::default().configure_from_args().final_summary();
}
