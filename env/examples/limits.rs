//! Time per step and memory of worlds at their limits: `limits CASE [OBJECTS]`; without arguments, all cases.

use std::error::Error;
use std::time::{Duration, Instant};

use driftworld_env::{Action, Environment, Target};
use driftworld_spec::{
    ActionModel, Modality, MotionModel, Object, Pushable, Respawn, StateFeature, Stimulus, WorldDraft,
};

/// A case: its name, its number of objects and the world.
type Case = (&'static str, usize, fn(usize) -> WorldDraft);

const CASES: [Case; 14] = [
    ("pushable-heap", 100_000, pushable_heap),
    ("pushable-field", 2_000, pushable_field),
    ("pushable-ice", 100_000, pushable_ice),
    ("predators", 100_000, predators),
    ("ghost-predators", 100_000, ghost_predators),
    ("mover-heap", 100_000, mover_heap),
    ("mover-field", 100_000, mover_field),
    ("solid-heap", 100_000, solid_heap),
    ("posts", 100_000, posts),
    ("ranges", 100_000, ranges),
    ("returning", 100_000, returning),
    ("sequence", 100_000, sequence),
    ("rails", 100_000, rails),
    ("rails-large", 10_000, rails_large),
];

fn main() -> Result<(), Box<dyn Error>> {
    let mut arguments = std::env::args().skip(1);
    let wanted = arguments.next();
    let count = arguments.next().map(|count| count.parse()).transpose()?;
    for (name, most, world) in CASES {
        if wanted.as_deref().is_none_or(|wanted| wanted == name) {
            measure(name, world(count.unwrap_or(most)))?;
        }
    }
    Ok(())
}

/// Runs a world for at most 20 steps or 5 seconds, and prints times and memory.
#[expect(clippy::print_stdout, reason = "an example shows what it finds")]
fn measure(name: &str, world: WorldDraft) -> Result<(), Box<dyn Error>> {
    const STEPS: usize = 20;
    let (count, world) = (world.objects.len(), world.check()?);
    let begun = Instant::now();
    let mut environment = Environment::new(world);
    let reset = begun.elapsed();
    let mut times = Vec::new();
    let begun = Instant::now();
    while times.len() < STEPS && begun.elapsed() < Duration::from_secs(5) && !environment.ended() {
        let start = Instant::now();
        environment.step(Action::Continuous([2.0, 5.0, 1.0]))?;
        let mut state = vec![0.0; environment.world().agent_params.state_len()];
        environment.write_state(&mut state)?;
        times.push(start.elapsed());
    }
    let start = Instant::now();
    draw(&mut environment)?;
    let picture = start.elapsed();
    times.sort();
    println!(
        "{name:16} {count:7} objects: reset {:7.1} ms, step {:7.1} ms at most, {:7.1} ms median, picture {:7.1} ms, memory {}",
        milliseconds(reset),
        milliseconds(times[times.len() - 1]),
        milliseconds(times[times.len() / 2]),
        milliseconds(picture),
        peak_memory(),
    );
    Ok(())
}

/// Renders all images of a camera of 84 × 84 pixels.
fn draw(environment: &mut Environment) -> Result<(), Box<dyn Error>> {
    const SIZE: u32 = 84;
    let pixels = (SIZE * SIZE) as usize;
    let (mut rgb, mut class) = (vec![0; 3 * pixels], vec![0; pixels]);
    let mut target = Target {
        width: SIZE,
        height: SIZE,
        rgb: Some(&mut rgb),
        class: Some(&mut class),
        ..Target::default()
    };
    let camera = environment.camera();
    let mut renderer = driftworld_env::CpuRenderer::default();
    renderer.draw(environment.scene(), &camera, &mut target)?;
    Ok(())
}

fn milliseconds(time: Duration) -> f64 {
    time.as_secs_f64() * 1e3
}

/// Peak memory of the process, according to Linux.
fn peak_memory() -> String {
    let status = std::fs::read_to_string("/proc/self/status").unwrap_or_default();
    let line = status.lines().find_map(|line| line.strip_prefix("VmHWM:"));
    line.map_or_else(|| "unknown".to_owned(), |line| line.trim().to_owned())
}

fn world(objects: Vec<Object>) -> WorldDraft {
    let mut world = WorldDraft {
        objects,
        seed: Some(1),
        ..WorldDraft::default()
    };
    world.environment_params.map_size = [100.0, 100.0];
    world.agent_params.modalities = vec![Modality::Rgb, Modality::Segmentation];
    world
}

/// Positions on a square grid around the origin, `spacing` metres apart, with room for the agent.
fn field(count: usize, spacing: f64) -> impl Iterator<Item = [f64; 2]> {
    let side = (count as f64).sqrt().ceil() as usize + 2;
    let middle = side as f64 / 2.0;
    let place = move |k: usize| [(k % side) as f64 - middle, (k / side) as f64 - middle].map(|cells| cells * spacing);
    (0..).map(place).filter(|[x, y]| x * x + y * y > 0.8).take(count)
}

fn pushable(at: [f64; 2], friction: f64) -> Object {
    let mut cube = Object::new("cube", at);
    cube.pushable = Some(Pushable { mass: 5.0, friction });
    cube
}

fn mover(class: &str, at: [f64; 2], motion_model: MotionModel, speed: f64) -> Object {
    let mut object = Object::new(class, at);
    (object.motion_model, object.speed) = (motion_model, speed);
    object
}

fn pushable_heap(count: usize) -> WorldDraft {
    world((0..count).map(|_| pushable([0.0, 0.9], 0.5)).collect())
}

fn pushable_field(count: usize) -> WorldDraft {
    world(field(count, 1.1).map(|at| pushable(at, 0.5)).collect())
}

/// All objects slide without friction and never come to rest.
fn pushable_ice(count: usize) -> WorldDraft {
    let mut world = world(field(count, 0.02).map(|at| pushable(at, 0.0)).collect());
    world.agent_params.max_linear_speed = 100.0;
    world
}

fn predators(count: usize) -> WorldDraft {
    let at = |at| mover("barrel", at, MotionModel::Predator, 5.0);
    world(field(count, 0.15).map(at).collect())
}

fn ghost_predators(count: usize) -> WorldDraft {
    let mut world = predators(count);
    for object in &mut world.objects {
        (object.solid, object.reward) = (false, 1.0);
        object.reward_stimulus = vec![Stimulus::AgentCollide];
    }
    world
}

fn mover_heap(count: usize) -> WorldDraft {
    let at = |_| mover("cube", [10.0, 10.0], MotionModel::RandomWaypoint, 5.0);
    world((0..count).map(at).collect())
}

fn mover_field(count: usize) -> WorldDraft {
    let at = |at| {
        let mut object = mover("cube", at, MotionModel::RandomWaypoint, 5.0);
        object.scale = 0.1;
        object
    };
    world(field(count, 0.3).map(at).collect())
}

fn solid_heap(count: usize) -> WorldDraft {
    world(
        (0..count)
            .map(|k| Object::new("cube", [0.0, 0.9 + 1e-5 * k as f64]))
            .collect(),
    )
}

/// Thin posts that the agent bumps into one after another.
fn posts(count: usize) -> WorldDraft {
    let at = |at: [f64; 2]| {
        let mut object = Object::new("barrel", at);
        object.scale = 0.01;
        object
    };
    let mut world = world(field(count, 0.05).map(at).collect());
    world.agent_params.max_linear_speed = 100.0;
    world.agent_params.time_step = 1.0;
    world
}

fn ranges(count: usize) -> WorldDraft {
    let at = |at| {
        let mut object = Object::new("coin", at);
        (object.solid, object.reward, object.range_stimulus_distance) = (false, 1.0, 1000.0);
        object.reward_stimulus = vec![Stimulus::AgentInRange];
        object.destroy_stimulus = vec![Stimulus::AgentInRange];
        object
    };
    world(field(count, 0.2).map(at).collect())
}

/// All objects have been collected, and respawn where others stand.
fn returning(count: usize) -> WorldDraft {
    let mut world = ranges(count);
    for object in &mut world.objects {
        object.coordinates = [5.0, 5.0];
        object.solid = true;
        object.respawn = Some(Respawn {
            delay: 0.0,
            radius: 1.0,
        });
    }
    world
}

/// All objects form one sequence, and the state observation includes the nearest target 20 times.
fn sequence(count: usize) -> WorldDraft {
    let mut world = ranges(count);
    for (index, object) in world.objects.iter_mut().enumerate() {
        object.order = Some(index as u32 + 1);
        object.destroy_stimulus.clear();
    }
    world.agent_params.state_features = vec![StateFeature::NearestTarget; 20];
    world
}

fn rails(count: usize) -> WorldDraft {
    let mut world = world(
        field(count, 0.3)
            .map(|at| {
                let mut object = Object::new("barrel", at);
                (object.reward, object.solid) = (1.0, true);
                object.reward_once_stimulus = vec![Stimulus::AgentCollide];
                object
            })
            .collect(),
    );
    world.agent_params.action_model = ActionModel::OnRails;
    world
}

/// Targets so large that each covers the whole floor.
fn rails_large(count: usize) -> WorldDraft {
    let mut world = rails(count);
    for object in &mut world.objects {
        object.scale = 100.0;
    }
    world
}
