//! Touching, interacting and approaching; walls; ends of episodes; and exact reproducibility.

use driftworld_env::{Action, Agent, EnvError, Environment, OnRailsAgent, RandomAgent, Warning};
use driftworld_spec::{ActionModel, ActionSpace, EndCondition, MotionModel, Object, Shaping, Stimulus, WorldDraft};
use proptest::prelude::*;

use crate::fixtures::{start, step, wall_of};

const AHEAD: Action = Action::Continuous([10.0, 0.0, 0.0]);
const BACK: Action = Action::Continuous([-10.0, 0.0, 0.0]);
const STAY: Action = Action::Continuous([0.0, 0.0, 0.0]);
const INTERACT: Action = Action::Continuous([0.0, 0.0, 1.0]);

/// A cube that pays 5, `metres` ahead of the agent.
fn cube(metres: f64) -> Object {
    let mut object = Object::new("cube", [0.0, metres]);
    object.reward = 5.0;
    object.tag = Some("cube".to_owned());
    object
}

fn environment(objects: Vec<Object>) -> Environment {
    start(WorldDraft::with_objects(objects))
}

/// The rewards of a sequence of actions.
fn rewards(environment: &mut Environment, actions: &[Action]) -> Vec<f64> {
    actions.iter().map(|action| step(environment, *action).reward).collect()
}

#[test]
fn touch_pays_once_per_contact() {
    let mut object = cube(2.2);
    object.reward_stimulus = vec![Stimulus::AgentCollide];
    let mut environment = environment(vec![object]);
    assert_eq!(
        rewards(&mut environment, &[AHEAD, AHEAD, AHEAD, BACK, AHEAD]),
        [0.0, 5.0, 0.0, 0.0, 5.0]
    );
}

#[test]
fn one_time_reward_is_not_paid_again() {
    let mut object = cube(2.2);
    object.reward_once_stimulus = vec![Stimulus::AgentCollide];
    let mut environment = environment(vec![object]);
    assert_eq!(
        rewards(&mut environment, &[AHEAD, AHEAD, BACK, AHEAD]),
        [0.0, 5.0, 0.0, 0.0]
    );
    assert_eq!(environment.objects()[0].reward, 0.0);
    assert!(environment.objects()[0].present);
}

#[test]
fn destroyed_object_neither_blocks_nor_shows() {
    let mut object = cube(2.2);
    object.destroy_stimulus = vec![Stimulus::AgentCollide];
    let mut environment = environment(vec![object]);
    assert!(environment.observe().instance.contains(&1));
    let events = [AHEAD, AHEAD].map(|action| step(&mut environment, action).events);
    assert!(events[1][0].destroyed && events[1][0].tag.as_deref() == Some("cube"));
    assert!(!environment.observe().instance.contains(&1));
    rewards(&mut environment, &[AHEAD, AHEAD]);
    assert!(
        environment.agent().position[1] > 3.0,
        "the agent walks through its former position"
    );
}

#[test]
fn interaction_reaches_one_metre_ahead() {
    for (metres, reward) in [(1.5, 5.0), (1.9, 5.0), (2.1, 0.0)] {
        let mut object = cube(metres);
        object.reward_stimulus = vec![Stimulus::AgentInteract];
        assert_eq!(
            step(&mut environment(vec![object.clone()]), INTERACT).reward,
            reward,
            "{metres} m ahead"
        );
        assert_eq!(
            step(&mut environment(vec![object]), STAY).reward,
            0.0,
            "not without the interact action"
        );
    }
    let mut behind = cube(-1.2);
    behind.reward_stimulus = vec![Stimulus::AgentInteract];
    assert_eq!(
        step(&mut environment(vec![behind]), INTERACT).reward,
        0.0,
        "not behind the agent"
    );
}

#[test]
fn range_reward_is_paid_on_entering() {
    let mut object = cube(5.0);
    object.reward_stimulus = vec![Stimulus::AgentInRange];
    object.range_stimulus_distance = 3.5;
    let mut environment = environment(vec![object]);
    assert_eq!(
        rewards(&mut environment, &[AHEAD, AHEAD, STAY, BACK, AHEAD]),
        [0.0, 5.0, 0.0, 0.0, 5.0]
    );
}

#[test]
fn ghost_is_touched_in_passing_at_any_speed() {
    let mut object = cube(5.0);
    object.solid = false;
    object.reward_stimulus = vec![Stimulus::AgentCollide];
    let mut world = WorldDraft::with_objects(vec![object]);
    world.agent_params.max_linear_speed = 100.0;
    let mut environment = start(world);
    let passed = step(&mut environment, Action::Continuous([100.0, 0.0, 0.0]));
    assert_eq!((passed.reward, environment.agent().position), (5.0, [0.0, 10.0]));
}

#[test]
fn scavenger_hunt_pays_only_in_order() {
    let mut hunt = [cube(2.2), cube(-2.2)];
    for (object, order) in hunt.iter_mut().zip([2, 1]) {
        object.order = Some(order);
        object.reward_once_stimulus = vec![Stimulus::AgentCollide];
    }
    let mut environment = environment(hunt.to_vec());
    // The second one first: no reward. Then the first, then the second.
    let path = [AHEAD, AHEAD, BACK, BACK, BACK, AHEAD, AHEAD, AHEAD];
    let paid = rewards(&mut environment, &path);
    assert_eq!(paid.iter().filter(|reward| **reward == 5.0).count(), 2, "{paid:?}");
    assert_eq!(paid[1], 0.0);
}

#[test]
fn bandit_arm_pays_at_its_odds_and_reproducibly() {
    let arm = |odds: f64| {
        let mut object = cube(1.2);
        object.reward_stimulus = vec![Stimulus::AgentInteract];
        object.reward_probability = odds;
        let mut environment = environment(vec![object]);
        rewards(&mut environment, &[INTERACT; 400])
    };
    let paid = arm(0.3);
    assert_eq!(paid, arm(0.3));
    let share = paid.iter().filter(|reward| **reward > 0.0).count() as f64 / 400.0;
    assert!((0.2..0.4).contains(&share), "{share}");
    assert!(arm(0.0).iter().all(|reward| *reward == 0.0));
}

#[test]
fn shaping_pays_progress_and_nothing_over_a_round_trip() {
    let mut world = WorldDraft::with_objects(vec![cube(10.0)]);
    world.rules.shaping = Some(Shaping {
        toward: Some("cube".to_owned()),
        scale: 2.0,
        discount: 1.0,
    });
    let mut environment = start(world);
    let paid = rewards(&mut environment, &[AHEAD, BACK]);
    assert!((paid[0] - 2.0).abs() < 1e-5, "one metre nearer at 2 a metre: {paid:?}");
    assert!((paid[0] + paid[1]).abs() < 1e-5);
}

#[test]
fn ends_have_distinct_causes() {
    let touch = |success: Vec<EndCondition>, failure: Vec<EndCondition>| {
        let mut object = cube(2.2);
        object.reward_once_stimulus = vec![Stimulus::AgentCollide];
        let mut world = WorldDraft::with_objects(vec![object]);
        world.max_steps = 2;
        world.rules.success = success;
        world.rules.failure = failure;
        let mut environment = start(world);
        step(&mut environment, AHEAD);
        let last = step(&mut environment, AHEAD);
        assert_eq!(environment.step(AHEAD), Err(EnvError::Ended));
        (last.terminated, last.truncated, last.success)
    };
    let by_touch = || EndCondition::Touch("cube".to_owned());
    assert_eq!(touch(vec![], vec![]), (false, true, false));
    assert_eq!(touch(vec![by_touch()], vec![]), (true, false, true));
    assert_eq!(touch(vec![], vec![by_touch()]), (true, false, false));
    assert_eq!(touch(vec![EndCondition::AllCollected], vec![]), (true, false, true));
    assert_eq!(
        touch(vec![EndCondition::ReturnAtLeast(5.0)], vec![]),
        (true, false, true)
    );
    assert_eq!(
        touch(vec![EndCondition::ReturnAtMost(-1.0)], vec![]),
        (false, true, false)
    );
}

#[test]
fn world_without_targets_does_not_start_as_a_success() {
    let mut world = WorldDraft::default();
    world.rules.success = vec![EndCondition::AllCollected];
    assert!(!step(&mut start(world), STAY).terminated);
}

#[test]
fn invalid_action_is_refused_and_changes_nothing() {
    let mut continuous = environment(vec![]);
    let before = continuous.agent();
    let nan = continuous
        .step(Action::Continuous([f64::NAN, 0.0, 0.0]))
        .expect_err("NaN is not a speed");
    assert_eq!(
        nan.to_string(),
        "action: found [NaN, 0.0, 0.0], expected three finite numbers; nothing was changed"
    );
    assert_eq!(nan.code(), "env/not-finite");
    assert_eq!(
        continuous.step(Action::Discrete(0)),
        Err(EnvError::NotDiscrete { found: 0 })
    );
    assert_eq!((continuous.agent(), continuous.num_steps()), (before, 0));
    let mut world = WorldDraft::default();
    world.agent_params.actions = ActionSpace::Discrete(vec![[10.0, 0.0, 0.0], [0.0, 90.0, 0.0]]);
    let mut discrete = start(world);
    let beyond = discrete.step(Action::Discrete(2)).expect_err("the table has two rows");
    assert_eq!(
        beyond.to_string(),
        "action: found row 2, expected 0 to 1 of the world's action table; nothing was changed"
    );
    step(&mut discrete, Action::Discrete(1));
    assert_eq!(discrete.agent().heading_deg, 9.0);
}

#[test]
fn every_action_model_moves_as_documented() {
    let after = |model, numbers| {
        let mut world = WorldDraft::default();
        world.agent_params.action_model = model;
        let mut environment = start(world);
        step(&mut environment, Action::Continuous(numbers));
        (environment.agent().position, environment.agent().heading_deg)
    };
    assert_eq!(
        after(ActionModel::ByVelocity, [1e9, 0.0, 0.0]),
        ([0.0, 1.0], 0.0),
        "limits are kept"
    );
    assert_eq!(after(ActionModel::ByWaypoint, [5.0, 0.0, -90.0]), ([1.0, 0.0], 351.0));
    assert_eq!(after(ActionModel::None, [10.0, 90.0, 1.0]), ([0.0, 0.0], 0.0));
}

#[test]
fn agent_on_rails_tours_by_itself() {
    let mut object = cube(6.0);
    object.reward_once_stimulus = vec![Stimulus::AgentCollide];
    let mut world = WorldDraft::with_objects(vec![object]);
    world.agent_params.action_model = ActionModel::OnRails;
    let mut environment = start(world);
    let total: f64 = rewards(&mut environment, &[STAY; 20]).iter().sum();
    assert_eq!(total, 5.0);
}

#[test]
fn warnings_name_unintended_settings() {
    let mut odd = Object::new("dragon", [3.0, 3.0]);
    odd.motion_model = MotionModel::Prey;
    let environment = environment(vec![odd]);
    let warnings = environment.warnings();
    assert!(matches!(&warnings[0], Warning::UnknownAsset { class, .. } if class == "dragon"));
    assert_eq!(
        warnings[1].to_string(),
        "/objects/0/motion_model: found no speed, or a patrol without waypoints; it stands still"
    );
    assert_eq!(warnings.len(), 2);
}

#[test]
fn agent_slides_along_a_wall() {
    let mut world = WorldDraft::default();
    world.agent_params.coordinates = [0.0, 48.0];
    world.agent_params.heading = 45.0;
    let mut environment = start(world);
    rewards(&mut environment, &[AHEAD; 10]);
    let [x, y] = environment.agent().position;
    assert!(
        (y - 49.49).abs() < 0.02,
        "half a metre plus a skin from the wall at 50 m: {y}"
    );
    assert!(x > 5.0, "and slides along it: {x}");
}

#[test]
fn start_inside_a_body_or_outside_the_arena_does_not_panic() {
    for coordinates in [[0.0, 0.0], [300.0, 300.0], [49.9, 49.9]] {
        let mut world = WorldDraft::with_objects(vec![Object::new("building", [0.0, 0.0])]);
        world.agent_params.coordinates = coordinates;
        let mut environment = start(world);
        let mut agent = RandomAgent::new(3);
        for _ in 0..200 {
            let action = agent.act(&environment);
            step(&mut environment, action);
            assert!(environment.agent().position.iter().all(|metres| metres.is_finite()));
        }
        environment.observe();
    }
}

#[test]
fn ten_thousand_objects_can_be_stepped() {
    let objects = (0..10_000)
        .map(|k| Object::new("rock", [f64::from(k % 100) - 50.0, f64::from(k / 100) - 50.0]))
        .collect();
    let mut environment = environment(objects);
    step(&mut environment, AHEAD);
    environment.observe();
}

proptest! {
    #![proptest_config(ProptestConfig::with_cases(crate::tier::quick_or_full(24, 128)))]

    #[test]
    fn agent_never_passes_a_wall(
        heading in 0.0..360.0_f64,
        turns in prop::collection::vec(-400.0..400.0_f64, 1..30),
        speed in 0.1..100.0_f64,
        seconds in 0.001..10.0_f64,
    ) {
        let mut world = WorldDraft::default();
        world.environment_params.map_size = [20.0, 12.0];
        // A thin pillar and a long thin wall.
        world.environment_params.walls = vec![
            wall_of([[-10.0, 2.0], [9.0, 2.0], [9.0, 2.05], [-10.0, 2.05]]),
            wall_of([[3.0, -3.0], [3.1, -3.0], [3.05, -2.9]]),
        ];
        world.agent_params.agent_width = 0.6;
        world.agent_params.coordinates = [-5.0, -2.0];
        world.agent_params.heading = heading;
        world.agent_params.max_linear_speed = 100.0;
        world.agent_params.max_angular_speed = 3600.0;
        world.agent_params.time_step = seconds;
        let mut environment = start(world);
        for turn in turns {
            let from = environment.agent().position;
            step(&mut environment, Action::Continuous([speed, turn, 0.0]));
            let [x, y] = environment.agent().position;
            prop_assert!(x.abs() <= 9.75 && y.abs() <= 5.75, "left the arena at {x}, {y}");
            // The only way past the long wall is around its eastern end, which is farther than half a metre.
            let crossed = (from[1] < 2.0) != (y < 2.0);
            prop_assert!(!crossed || from[0] > 8.0 || x > 8.0, "through the wall from {from:?} to {x}, {y}");
        }
    }

    #[test]
    fn same_actions_give_the_same_bits(seed in any::<u64>()) {
        let run = || {
            let mut environment = start(arena());
            let mut agent = RandomAgent::new(seed);
            let mut trace = Vec::new();
            for _ in 0..60 {
                let action = agent.act(&environment);
                let step = step(&mut environment, action);
                trace.push((step.reward.to_bits(), bits(&environment)));
            }
            (trace, environment.observe().rgb.clone())
        };
        prop_assert_eq!(run(), run());
    }
}

fn bits(environment: &Environment) -> Vec<u32> {
    environment.state_vector().into_iter().map(f32::to_bits).collect()
}

/// A small world with many kinds of objects.
fn arena() -> WorldDraft {
    let mut objects = vec![
        cube(4.0),
        Object::new("tree", [3.0, 3.0]),
        Object::new("rock", [-3.0, 1.0]),
    ];
    objects[0].reward_once_stimulus = vec![Stimulus::AgentCollide];
    objects[0].destroy_stimulus = vec![Stimulus::AgentCollide];
    let mut barrel = Object::new("barrel", [-2.0, -4.0]);
    barrel.reward = -2.0;
    barrel.reward_stimulus = vec![Stimulus::AgentCollide];
    objects.push(barrel);
    let mut world = WorldDraft::with_objects(objects);
    world.environment_params.map_size = [14.0, 14.0];
    world.agent_params.observation_size = 32;
    world
}

#[test]
fn reset_equals_a_new_environment() {
    let mut used = start(WorldDraft::default());
    rewards(&mut used, &[AHEAD; 5]);
    used.reset(arena().check().expect("the world is valid"));
    let mut fresh = start(arena());
    for action in [AHEAD; 12] {
        assert_eq!(step(&mut used, action), step(&mut fresh, action));
        assert_eq!(used.state_vector(), fresh.state_vector());
    }
    assert_eq!(used.observe().rgb, fresh.observe().rgb);
}

/// Rewards and poses of a sequence of actions. `DRIFTWORLD_UPDATE_GOLDEN=1` rewrites the file, which is a value-breaking
/// change.
#[test]
fn golden_episode_is_unchanged() {
    let mut environment = start(arena());
    let mut agent = OnRailsAgent::new();
    let mut lines = vec!["action; reward; x y heading".to_owned()];
    for number in 0..80 {
        let action = if number < 30 {
            agent.act(&environment)
        } else {
            Action::Continuous([8.0, 40.0, 0.0])
        };
        let step = step(&mut environment, action);
        let driftworld_env::AgentState {
            position: [x, y],
            heading_deg: heading,
            ..
        } = environment.agent();
        lines.push(format!("{action:?}; {}; {x} {y} {heading}", step.reward));
    }
    let found = lines.join("\n") + "\n";
    let path = concat!(env!("CARGO_MANIFEST_DIR"), "/tests/golden/episode.txt");
    if std::env::var_os("DRIFTWORLD_UPDATE_GOLDEN").is_some() {
        std::fs::write(path, &found).expect("the golden file can be written");
    }
    let golden = std::fs::read_to_string(path).expect("the golden file is committed");
    for (number, (found, golden)) in found.lines().zip(golden.lines()).enumerate() {
        assert_eq!(found, golden, "line {} of {path}", number + 1);
    }
    assert_eq!(found.lines().count(), golden.lines().count());
}
