//! Cost of the built-in expert: a step among moving objects, a step of plans with doors, keys, carriable objects and zones, and
//! a choice among two hundred targets.

use std::hint::black_box;

use criterion::measurement::WallTime;
use criterion::{BenchmarkGroup, Criterion, Throughput, criterion_group, criterion_main};
use driftworld_env::{Agent, Environment, OnRailsAgent};
use driftworld_spec::{MotionModel, Object, Stimulus, World, WorldDraft};

/// A world of the built-in task `moving_object#wandering`, whose balls have the given motion.
fn moving_object(motion: MotionModel) -> World {
    let text = include_str!("scenes/moving_object.json");
    let world = World::from_json("moving_object.json", text).expect("the scene is valid");
    let moved = world.edit(|world| {
        for ball in &mut world.objects {
            if ball.motion_model != MotionModel::Stationary {
                ball.motion_model = motion;
            }
        }
    });
    moved.expect("the scene is valid")
}

/// Two hundred solid cubes that pay, scattered deterministically over an arena of 100 × 100 m.
fn crowd() -> World {
    let cube = |number: u32| {
        let share = |prime: f64| (f64::from(number) * prime).fract() - 0.5;
        // Multiples of the golden ratio and of the square root of two: no two cubes are close, and no two distances are equal.
        let mut cube = Object::new("cube", [share(0.618_033_988_75) * 94.0, share(0.414_213_562_37) * 94.0]);
        cube.reward = 1.0;
        cube.reward_once_stimulus = vec![Stimulus::AgentCollide];
        cube.destroy_stimulus = vec![Stimulus::AgentCollide];
        cube
    };
    let world = WorldDraft::with_objects((1..=200).map(cube).collect());
    world.check().expect("the scene is valid")
}

/// Measures a step of the expert in a world that is reset when an episode ends.
fn bench_agent(group: &mut BenchmarkGroup<WallTime>, name: &str, start: &World) {
    let mut environment = Environment::new(start.clone());
    let mut agent = OnRailsAgent::new();
    group.bench_function(name, |bench| {
        bench.iter(|| {
            let action = agent.act(&environment);
            if environment.step(action).expect("the action is valid").ended() {
                environment.reset(start.clone());
                agent.begin(0);
            }
        });
    });
}

fn steps(c: &mut Criterion) {
    let mut group = c.benchmark_group("on rails, a step of moving_object");
    group.throughput(Throughput::Elements(1));
    for (name, motion) in [
        ("balls wander", MotionModel::RandomWaypoint),
        ("balls flee", MotionModel::Prey),
        ("balls come", MotionModel::Predator),
    ] {
        bench_agent(&mut group, name, &moving_object(motion));
    }
    group.finish();
}

/// World 0 under seed 77 of each of several example tasks, planned from start to end.
fn errands(c: &mut Criterion) {
    let mut group = c.benchmark_group("on rails, a step of an example world");
    group.throughput(Throughput::Elements(1));
    for (name, text) in [
        ("key_corridor#closed", include_str!("scenes/key_corridor.json")),
        ("locked_rooms#six", include_str!("scenes/locked_rooms.json")),
        ("put_next#three", include_str!("scenes/put_next.json")),
        ("lava_crossing#lava", include_str!("scenes/lava_crossing.json")),
    ] {
        bench_agent(
            &mut group,
            name,
            &World::from_json(name, text).expect("the scene is valid"),
        );
    }
    group.finish();
}

fn choices(c: &mut Criterion) {
    let environment = Environment::new(crowd());
    // A new agent has no cache: the most expensive choice.
    c.bench_function("on rails, a choice among 200 targets", |bench| {
        bench.iter(|| black_box(OnRailsAgent::new().act(&environment)));
    });
}

criterion_group!(benches, steps, errands, choices);
criterion_main!(benches);
