//! A running world that was saved as a document, or as a snapshot in memory, resumes bit for bit, including its images.

use driftworld_env::{Action, Agent, EnvError, Environment, RandomAgent};
use driftworld_spec::{
    ActionModel, ActionSpace, EndCondition, Energy, MotionModel, Object, ObjectProgress, Progress, Pushable, Respawn,
    Shaping, StateFeature, Stimulus, Trigger, World, WorldDraft, Zone,
};
use proptest::prelude::*;

use crate::fixtures::wall_of;

/// A small world with all kinds of progress.
fn world(action_model: ActionModel, frame_skip: u32) -> World {
    let object = |class: &str, at: [f64; 2]| Object::new(class, at);
    let mut coin = object("geometric", [2.0, 2.5]);
    coin.reward = 1.0;
    coin.reward_once_stimulus = vec![Stimulus::AgentCollide];
    coin.destroy_stimulus = vec![Stimulus::AgentCollide];
    coin.respawn = Some(Respawn {
        delay: 0.7,
        radius: 3.0,
    });
    let mut arm = object("pot", [-2.0, 1.0]);
    arm.reward = 2.0;
    arm.reward_probability = 0.5;
    arm.reward_stimulus = vec![Stimulus::AgentCollide, Stimulus::AgentInRange, Stimulus::AgentInteract];
    arm.range_stimulus_distance = 2.0;
    let mut first = object("barrel", [4.0, -3.0]);
    (first.order, first.reward) = (Some(1), 3.0);
    first.reward_once_stimulus = vec![Stimulus::AgentCollide];
    let mut second = object("barrel", [-4.0, -3.0]);
    (second.order, second.reward) = (Some(2), 4.0);
    second.reward_once_stimulus = vec![Stimulus::AgentCollide];
    let mut wanderer = object("bag", [5.0, 5.0]);
    (wanderer.motion_model, wanderer.speed) = (MotionModel::RandomWaypoint, 2.0);
    let mut patrol = object("chair", [-5.0, 5.0]);
    (patrol.motion_model, patrol.speed, patrol.turn_rate) = (MotionModel::Patrol, 1.5, Some(90.0));
    patrol.waypoints = vec![[-5.0, 5.0], [-5.0, -5.0], [0.0, 4.0]];
    let mut hunter = object("rock", [6.0, -6.0]);
    (hunter.motion_model, hunter.speed) = (MotionModel::Predator, 1.0);
    let mut box_ = object("cube", [0.5, 1.9]);
    box_.pushable = Some(Pushable {
        mass: 15.0,
        friction: 0.2,
    });
    let mut drum = object("geometric", [-1.0, 3.1]);
    (drum.model.0, drum.pushable) = ("3".to_owned(), box_.pushable);
    let mut world = WorldDraft {
        max_steps: 200,
        objects: vec![coin, arm, first, second, wanderer, patrol, hunter, box_, drum],
        ..WorldDraft::default()
    };
    world.environment_params.map_size = [16.0, 16.0];
    world.environment_params.walls = vec![wall_of([[-6.0, 0.0], [-3.0, 0.0], [-3.0, 0.3], [-6.0, 0.3]])];
    let mut door = Zone::disc([-5.0, -5.0], 1.5);
    (door.teleport, door.reward_on_entering) = (Some([5.0, 0.0]), 0.25);
    let mut mud = Zone::polygon(vec![[-2.0, 0.5], [3.0, 0.5], [3.0, 6.0]]);
    (mud.speed_factor, mud.reward_per_second, mud.reward_on_entering) = (0.7, -0.3, -0.5);
    world.environment_params.zones = vec![door, mud];
    (world.objects[0].energy, world.objects[1].range_trigger) = (0.5, Trigger::Level);
    world.agent_params.energy = Some(Energy {
        start: 2.0,
        per_second: -0.1,
        per_metre: -0.05,
        most: 3.0,
    });
    let agent = &mut world.agent_params;
    (agent.action_model, agent.frame_skip, agent.observation_size) = (action_model, frame_skip, 24);
    agent.actions = ActionSpace::Continuous;
    agent.max_linear_speed = 6.0;
    agent.state_features = vec![
        StateFeature::Position,
        StateFeature::OwnVelocity,
        StateFeature::NearestTarget,
        StateFeature::Counts,
        StateFeature::LastReward,
        StateFeature::LastEvent,
        StateFeature::StepsLeft,
    ];
    agent.instruction = vec![0.25, 1.0];
    world.rules.order_penalty = -1.0;
    world.rules.shaping = Some(Shaping {
        toward: None,
        scale: 0.1,
        discount: 0.95,
    });
    world.rules.success = vec![EndCondition::ReturnAtLeast(60.0)];
    world.check().expect("the world is valid")
}

fn start(world: World) -> Environment {
    Environment::new(world)
}

/// All observations of a step and of the state after it, as exact strings.
type Trace = Vec<Vec<String>>;

/// The first step in which two traces differ, and how.
fn difference(a: &Trace, b: &Trace) -> Option<String> {
    if a.len() != b.len() {
        return Some(format!("{} and {} steps", a.len(), b.len()));
    }
    let (number, (a, b)) = a.iter().zip(b).enumerate().find(|(_, (a, b))| a != b)?;
    let apart: Vec<_> = a.iter().zip(b).filter(|(a, b)| a != b).collect();
    Some(format!("step {number}: {apart:?}"))
}

/// Checks that the objects' states fully determine the scene.
fn expect_scene_of_state(environment: &Environment) {
    let items = &environment.scene().items;
    for (item, object) in items.iter().zip(environment.objects()) {
        let shown = (item.position, item.heading_deg, item.reward, item.visible);
        let state = (
            object.position,
            object.heading_deg,
            object.reward as f32,
            object.present,
        );
        assert_eq!(shown, state);
    }
}

fn run(environment: &mut Environment, actions: &[Action]) -> Trace {
    let mut trace = Vec::new();
    for action in actions {
        let step = match environment.step(*action) {
            Ok(step) => step,
            Err(EnvError::Ended) => break,
            Err(error) => panic!("{error}"),
        };
        let mut told = vec![
            format!("reward {}", step.reward),
            format!("state {:?}", environment.state_vector()),
            format!("events {:?}", step.events),
        ];
        let items = environment.scene().items.iter().enumerate();
        told.extend(items.map(|(index, item)| format!("item {index} {:?} {}", item.position, item.heading_deg)));
        trace.push(told);
        expect_scene_of_state(environment);
    }
    trace
}

fn actions(seed: u64, environment: &Environment, count: usize) -> Vec<Action> {
    let mut agent = RandomAgent::new(seed);
    let mut actions = Vec::new();
    for number in 0..count {
        let Action::Continuous([a, b, c]) = agent.act(environment) else {
            panic!("the space is continuous");
        };
        // At least every third action interacts.
        actions.push(Action::Continuous([a, b, if number % 3 == 0 { 1.0 } else { c }]));
    }
    actions
}

fn model() -> impl Strategy<Value = ActionModel> {
    prop_oneof![
        4 => Just(ActionModel::ByVelocity),
        1 => Just(ActionModel::ByWaypoint),
        2 => Just(ActionModel::OnRails),
    ]
}

proptest! {
    #![proptest_config(ProptestConfig::with_cases(crate::tier::quick_or_full(24, 48)))]

    #[test]
    fn world_resumes_from_its_state_and_from_a_snapshot(
        seed in any::<u64>(),
        before in 0usize..70,
        after in 1usize..60,
        frame_skip in 1u32..4,
        model in model(),
        own_seed in prop::option::of(0u64..4),
    ) {
        let begun = world(model, frame_skip).edit(|world| world.seed = own_seed);
        let mut environment = start(begun.expect("every seed is valid"));
        let actions = actions(seed, &environment, before + after);
        run(&mut environment, &actions[..before]);
        if before % 2 == 1 && !environment.ended() {
            let mut spawned = Object::new("mushroom", [-0.8, -1.2]);
            spawned.reward = 1.0;
            spawned.reward_stimulus = vec![Stimulus::AgentCollide];
            (spawned.motion_model, spawned.speed) = (MotionModel::RandomWaypoint, 1.0);
            environment.spawn(spawned).expect("the mushroom is valid");
            environment.destroy(3).expect("the second barrel exists");
        }
        let snapshot = environment.snapshot();
        let text = environment.state().to_json();
        let picture = environment.observe().rgb.clone();
        let uninterrupted = run(&mut environment, &actions[before..]);

        let read = World::from_json("state", &text).map_err(|error| TestCaseError::fail(error.to_string()))?;
        let mut resumed = start(read);
        prop_assert_eq!(resumed.state().to_json(), text, "saving the resumed world gives the same document");
        prop_assert_eq!(&resumed.observe().rgb, &picture);
        let resumed = run(&mut resumed, &actions[before..]);
        prop_assert_eq!(difference(&resumed, &uninterrupted), None, "from the state");

        environment.restore(&snapshot);
        prop_assert_eq!(&environment.observe().rgb, &picture);
        let restored = run(&mut environment, &actions[before..]);
        prop_assert_eq!(difference(&restored, &uninterrupted), None, "from the snapshot");
    }
}

#[test]
fn state_has_current_values_and_keeps_initial_ones() {
    let mut environment = start(world(ActionModel::ByVelocity, 1));
    let begun = environment.world().clone();
    for action in actions(7, &environment, 60) {
        environment.step(action).expect("the episode continues");
    }
    let state = environment.state();
    assert_eq!(
        state.objects[5].coordinates,
        environment.scene().items[5].position.map(f64::from)
    );
    assert_eq!(
        state.agent_params.coordinates,
        environment.agent().position.map(f64::from)
    );
    let progress = state.progress.as_ref().expect("a state has progress");
    assert_eq!((progress.steps, progress.objects.len()), (60, begun.objects.len()));
    assert_eq!(progress.episode_return, environment.episode_return());
    assert_eq!(*start(state).world(), begun, "a resumed world knows its start");
}

#[test]
fn ended_episode_stays_ended() {
    let short = world(ActionModel::ByVelocity, 1).edit(|world| world.max_steps = 1);
    let mut environment = start(short.expect("one step is valid"));
    environment
        .step(Action::Continuous([0.0; 3]))
        .expect("the first step is allowed");
    let mut resumed = start(environment.state());
    assert_eq!(resumed.step(Action::Continuous([0.0; 3])), Err(EnvError::Ended));
}

#[test]
fn objects_far_outside_round_trip_through_a_state() {
    let mut prey = Object::new("barrel", [290.0, 0.0]);
    (prey.motion_model, prey.speed) = (MotionModel::Prey, 50.0);
    let mut outside = WorldDraft::with_objects(vec![prey]);
    outside.agent_params.coordinates = [280.0, 0.0];
    outside.agent_params.heading = 90.0;
    let mut environment = start(outside.check().expect("the world is valid"));
    for _ in 0..60 {
        environment
            .step(Action::Continuous([10.0, 0.0, 0.0]))
            .expect("the episode continues");
    }
    let read = World::from_json("state", &environment.state().to_json());
    assert!(read.is_ok(), "{read:?}");
}

#[test]
fn counters_at_their_limits_do_not_overflow() {
    let text = r#"{ "agent_params": { "action_model": "onrails" }, "progress": { "steps": 4294967295, "ticks": 4503599627370496, "rails": { "patience": 4294967295 }, "objects": [] } }"#;
    let mut environment = start(World::from_json("end", text).expect("the counters are in range"));
    environment
        .step(Action::Continuous([0.0; 3]))
        .expect("no step limit is set");
    assert_eq!(environment.num_steps(), u32::MAX);
}

#[test]
fn state_without_a_seed_uses_its_worlds_seed() {
    let heading = |tag: &str, seed: Option<u64>| {
        let mut wanderer = Object::new("barrel", [3.0, 3.0]);
        (wanderer.motion_model, wanderer.speed) = (MotionModel::RandomWaypoint, 1.0);
        wanderer.tag = Some(tag.to_owned());
        let world = WorldDraft {
            seed,
            objects: vec![wanderer],
            ..WorldDraft::default()
        };
        let mut state = start(world.check().expect("the world is valid")).state().into_draft();
        state.progress.as_mut().expect("a state has progress").seed = None;
        let mut environment = start(state.check().expect("the world is valid"));
        environment
            .step(Action::Continuous([0.0; 3]))
            .expect("the episode continues");
        environment.scene().items[0].heading_deg
    };
    assert_eq!(heading("a", None), heading("b", None), "both use the world's seed");
    assert_ne!(heading("a", None), heading("a", Some(0)));
    assert_ne!(heading("a", Some(1)), heading("a", Some(0)));
}

#[test]
fn old_state_without_per_object_random_numbers_resumes() {
    let text = r#"{ "objects": [{ "class": "barrel", "coordinates": [3, 3], "motion_model": "random_waypoint", "speed": 1 }],
        "progress": { "seed": "SEED", "steps": 2, "ticks": 2, "chance": 14, "objects": [{ "chance": 6, "goal": [1, 2] }] } }"#
        .replace("SEED", &"3a".repeat(32));
    let mut environment = start(World::from_json("old", &text).expect("old states are read"));
    environment
        .step(Action::Continuous([0.0; 3]))
        .expect("the episode continues");
    let written = environment.state().to_json();
    assert!(!written.contains("\"chance\""), "{written}");
}

#[test]
fn world_with_only_a_seed_as_progress_is_at_its_start() {
    // The agent starts in the barrel: that contact begins, and pays, in the first step.
    let touched = || {
        let mut barrel = Object::new("barrel", [0.0, 0.5]);
        barrel.reward = 5.0;
        barrel.reward_stimulus = vec![Stimulus::AgentCollide];
        let mut wanderer = Object::new("rock", [5.0, 5.0]);
        (wanderer.motion_model, wanderer.speed) = (MotionModel::RandomWaypoint, 2.0);
        let world = WorldDraft::with_objects(vec![barrel, wanderer]);
        world.check().expect("the world is valid")
    };
    let with_seed = |seed: String| {
        let seeded = touched().edit(|world| {
            world.progress = Some(Progress {
                seed: Some(seed),
                objects: vec![ObjectProgress::default(); 2],
                ..Progress::default()
            });
        });
        seeded.expect("the progress fits the world")
    };
    let seeded = |letter: char| with_seed(letter.to_string().repeat(64));
    let live = |world: World| {
        let mut environment = start(world);
        let rewards: Vec<f64> = (0..5)
            .map(|_| {
                environment
                    .step(Action::Continuous([0.0; 3]))
                    .expect("the episode continues")
                    .reward
            })
            .collect();
        (rewards, environment.scene().items[1].position)
    };
    let as_its_own = with_seed(touched().hash_of_places());
    assert_eq!(live(as_its_own), live(touched()));
    assert_eq!(live(seeded('a')).0, live(touched()).0);
    assert_ne!(live(seeded('a')).1, live(seeded('b')).1);
}

#[test]
fn instruction_is_at_the_end_of_the_state_vector() {
    let world = world(ActionModel::ByVelocity, 1);
    let mut environment = start(world.clone());
    for _ in 0..3 {
        let state = environment.state_vector();
        assert_eq!(state.len(), world.agent_params.state_len());
        assert_eq!(state[state.len() - 2..], [0.25, 1.0]);
        environment
            .step(Action::Continuous([0.0; 3]))
            .expect("the episode runs");
    }
}
