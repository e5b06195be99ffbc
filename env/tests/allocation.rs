//! Stepping a batch does not allocate, and heaps of bodies allocate memory in proportion to their size. A separate binary,
//! because the counters cover the whole process.

use std::alloc::{GlobalAlloc, Layout, System};
use std::sync::Arc;
use std::sync::atomic::{AtomicU64, Ordering};

use driftworld_env::{Action, Autoreset, Batch, BatchOptions, Environment};
use driftworld_spec::{
    Door, Modality, MotionModel, Object, Portable, Pushable, StateFeature, Stimulus, Switch, World, WorldDraft,
};

/// The system's allocator with counters.
struct Counting;

static ALLOCATIONS: AtomicU64 = AtomicU64::new(0);
/// Bytes in use, and their maximum so far.
static LIVE: AtomicU64 = AtomicU64::new(0);
static PEAK: AtomicU64 = AtomicU64::new(0);

fn grows_by(bytes: usize) {
    let live = LIVE.fetch_add(bytes as u64, Ordering::Relaxed) + bytes as u64;
    PEAK.fetch_max(live, Ordering::Relaxed);
}

#[expect(
    unsafe_code,
    reason = "an allocator needs unsafe code; this one counts and then calls the system's"
)]
// SAFETY: every call is passed on to the system's allocator unchanged.
unsafe impl GlobalAlloc for Counting {
    unsafe fn alloc(&self, layout: Layout) -> *mut u8 {
        ALLOCATIONS.fetch_add(1, Ordering::Relaxed);
        grows_by(layout.size());
        // SAFETY: the caller upholds the contract of the system's allocator.
        unsafe { System.alloc(layout) }
    }

    unsafe fn dealloc(&self, pointer: *mut u8, layout: Layout) {
        LIVE.fetch_sub(layout.size() as u64, Ordering::Relaxed);
        // SAFETY: as above.
        unsafe { System.dealloc(pointer, layout) }
    }

    unsafe fn realloc(&self, pointer: *mut u8, layout: Layout, size: usize) -> *mut u8 {
        ALLOCATIONS.fetch_add(1, Ordering::Relaxed);
        LIVE.fetch_sub(layout.size() as u64, Ordering::Relaxed);
        grows_by(size);
        // SAFETY: as above.
        unsafe { System.realloc(pointer, layout, size) }
    }
}

#[global_allocator]
static ALLOCATOR: Counting = Counting;

/// The benchmark's scene, in which every object pays when touched, approached or used, and every fourth one wanders.
fn world() -> World {
    let text = include_str!("../../src/throughput/arena_20.json");
    let scene = World::from_json("arena_20.json", text).expect("the benchmark's scene is valid");
    let mut world = scene.into_draft();
    world.agent_params.modalities = vec![
        Modality::Rgb,
        Modality::Depth,
        Modality::Segmentation,
        Modality::Class,
        Modality::Instance,
    ];
    world.agent_params.supersampling = 2;
    // With this seed, no bodies overlap on their paths; overlaps would allocate.
    world.seed = Some(1);
    for (index, object) in world.objects.iter_mut().enumerate() {
        object.tag = Some("group".to_owned());
        object.reward = 1.0;
        object.reward_stimulus = vec![Stimulus::AgentCollide, Stimulus::AgentInRange, Stimulus::AgentInteract];
        object.range_stimulus_distance = 12.0;
        if index % 4 == 0 {
            (object.motion_model, object.speed) = (MotionModel::RandomWaypoint, 3.0);
        }
    }
    world.check().expect("the world is valid")
}

/// The benchmark's scene, with a pushable object at rest and out of reach.
fn world_with_a_far_body() -> World {
    let text = include_str!("../../src/throughput/arena_20.json");
    let mut world = World::from_json("arena_20.json", text).expect("the benchmark's scene is valid");
    let mut far = Object::new("cube", [45.0, 45.0]);
    far.pushable = Some(Pushable {
        mass: 10.0,
        friction: 0.5,
    });
    world.push(far).expect("the body is valid");
    world
}

/// Doors of all kinds, a switch and carriable objects, in a room so small that the agent touches all of them.
fn world_with_things() -> World {
    let both = || vec![Stimulus::AgentCollide, Stimulus::AgentInteract];
    let mut objects = Vec::new();
    for (number, at) in [[0.0, 2.0], [2.0, 0.0], [0.0, -2.0], [-2.0, 0.0]]
        .into_iter()
        .enumerate()
    {
        let mut door = Object::new("door", at);
        (door.heading, door.tag) = (90.0 * number as f64, Some("gate".to_owned()));
        (door.reward, door.reward_stimulus) = (1.0, both());
        door.door = Some(Door {
            opens_on: both(),
            closes_on: vec![Stimulus::AgentInteract],
            closes_after: (number == 1).then_some(0.5),
            period: (number == 2).then_some(0.9),
            ..Door::default()
        });
        let mut key = Object::new("key", [at[0] * 0.6 + 0.5, at[1] * 0.6 - 0.5]);
        (key.portable, key.reward, key.reward_stimulus) = (Some(Portable::default()), 1.0, both());
        objects.extend([door, key]);
    }
    let mut lever = Object::new("switch", [1.6, 1.6]);
    lever.switch = Some(Switch {
        on: both(),
        ..Switch::of("gate")
    });
    objects.push(lever);
    let mut world = WorldDraft::with_objects(objects);
    world.environment_params.map_size = [7.0, 7.0];
    (world.agent_params.agent_width, world.agent_params.carry_limit) = (0.4, 3);
    world.agent_params.modalities = Vec::new();
    // The agent walks in circles past all of them.
    world.agent_params.max_linear_speed = 0.6;
    world.agent_params.state_features = vec![StateFeature::Position, StateFeature::Carrying];
    world.check().expect("the world is valid")
}

/// Number of allocations in this many steps of a warmed-up batch, and the steps' total reward.
fn count_allocations(world: World, num_threads: usize, steps: usize) -> (u64, f64) {
    const NUM_ENVS: usize = 8;
    let source = Arc::new(move |_| Ok(world.clone()));
    let options = BatchOptions {
        autoreset: Autoreset::NextStep,
        num_threads,
        ..BatchOptions::default()
    };
    let mut batch = Batch::new(NUM_ENVS, source, options).expect("the scene is valid");
    let actions: [Action; NUM_ENVS] =
        std::array::from_fn(|env| Action::Continuous([4.0 + env as f64, 20.0 - 3.0 * env as f64, 1.0]));
    // Lists reach their final size in the first steps.
    for _ in 0..300 {
        batch.step(&actions).expect("the batch continues");
    }
    let before = ALLOCATIONS.load(Ordering::Relaxed);
    let mut paid = 0.0;
    for _ in 0..steps {
        batch.step(&actions).expect("the batch continues");
        paid += batch.outputs().rewards.iter().sum::<f64>();
    }
    (ALLOCATIONS.load(Ordering::Relaxed) - before, paid)
}

#[test]
fn steps_do_not_allocate() {
    let (taken_alone, paid) = count_allocations(world(), 1, 300);
    assert!(paid > 10.0, "objects pay in these steps: {paid}");
    assert_eq!(taken_alone, 0, "on one thread");
    let (taken_beside_a_body, _) = count_allocations(world_with_a_far_body(), 1, 300);
    assert_eq!(taken_beside_a_body, 0, "a body that is not pushed");
    let (taken_by_things, paid) = count_allocations(world_with_things(), 1, 600);
    assert!(paid > 20.0, "doors open and things are picked up: {paid}");
    assert_eq!(taken_by_things, 0, "doors, switches and things");
    let seen = world_with_things().edit(|world| {
        world.agent_params.show_carried = true;
        world.agent_params.modalities = vec![Modality::Rgb];
    });
    let (taken_by_hands, _) = count_allocations(seen.expect("the world is valid"), 1, 600);
    assert_eq!(taken_by_hands, 0, "images of carried objects");
    // Passing work to another thread allocates one block, and every 63rd time one more for the pool's queue, regardless of the
    // number of environments.
    let (taken_by_two, _) = count_allocations(world(), 2, 300);
    assert!(taken_by_two <= 310, "on two threads: {taken_by_two} in 300 steps");
    heap_memory_is_proportional_to_the_number_of_bodies();
}

/// Regression test: a thousand cubes in one place took two gigabytes for the contacts between all pairs.
fn heap_memory_is_proportional_to_the_number_of_bodies() {
    for count in [250, 1000, 4000] {
        let body = |_| {
            let mut body = Object::new("cube", [0.0, 0.9]);
            body.pushable = Some(Pushable {
                mass: 5.0,
                friction: 0.5,
            });
            body
        };
        let world = WorldDraft::with_objects((0..count).map(body).collect());
        let mut environment = Environment::new(world.check().expect("the world is valid"));
        let before = LIVE.load(Ordering::Relaxed);
        PEAK.store(before, Ordering::Relaxed);
        for _ in 0..3 {
            environment
                .step(Action::Continuous([2.0, 10.0, 0.0]))
                .expect("the episode continues");
        }
        let taken = PEAK.load(Ordering::Relaxed) - before;
        // Room for the maximum number of contacts in a time step, and for the lists of bodies.
        assert!(taken < (48 << 20) + 2000 * count, "{count} cubes: {taken} bytes");
    }
}
