//! All action formats, and rules about steps: frame skip, penalties for wrong order, shaping.

use driftworld_env::{Action, EnvError, Environment, Obstacle, Warning};
use driftworld_spec::{ActionModel, ActionSpace, EndCondition, Object, Shaping, StateFeature, Stimulus, WorldDraft};

use crate::fixtures::start;

fn coin(at: [f64; 2], reward: f64) -> Object {
    let mut coin = Object::new("barrel", at);
    coin.reward = reward;
    coin.reward_once_stimulus = vec![Stimulus::AgentCollide];
    coin
}

/// An object directly in front of the agent that pays 1 per interaction.
fn button() -> Object {
    Object {
        reward: 1.0,
        reward_stimulus: vec![Stimulus::AgentInteract],
        ..Object::new("barrel", [0.0, 1.2])
    }
}

/// Total reward of this many steps forwards, or backwards if the speed is negative.
fn drive(environment: &mut Environment, speed: f64, steps: usize) -> f64 {
    let mut step = || environment.step(Action::Continuous([speed, 0.0, 0.0]));
    (0..steps).map(|_| step().expect("the episode continues").reward).sum()
}

fn with_actions(actions: ActionSpace) -> WorldDraft {
    let mut world = WorldDraft::default();
    world.agent_params.actions = actions;
    world
}

#[test]
fn normalised_actions_scale_to_the_agents_limits() {
    let mut environment = start(with_actions(ActionSpace::Normalized));
    environment
        .step(Action::Continuous([0.5, 1.0, -1.0]))
        .expect("the action is valid");
    let agent = environment.agent();
    assert_eq!(agent.heading_deg, 9.0);
    let speed = (agent.velocity[0].powi(2) + agent.velocity[1].powi(2)).sqrt();
    assert!((speed - 5.0).abs() < 1e-4, "{speed}");
    environment
        .step(Action::Continuous([0.0, 7.0, 0.0]))
        .expect("values beyond 1 are clamped");
    assert_eq!(environment.agent().heading_deg, 18.0);
}

#[test]
fn normalised_waypoints_scale_to_the_arena() {
    let mut world = with_actions(ActionSpace::Normalized);
    world.agent_params.action_model = ActionModel::ByWaypoint;
    world.environment_params.map_size = [4.0, 20.0];
    world.agent_params.max_linear_speed = 100.0;
    let mut environment = start(world);
    environment
        .step(Action::Continuous([0.5, -0.25, 0.0]))
        .expect("the action is valid");
    assert_eq!(environment.agent().position, [1.0, -2.5]);
}

#[test]
fn default_table_has_six_moves_and_interact() {
    let mut environment = start(with_actions(ActionSpace::DefaultDiscrete));
    for (row, turn) in [(1, -9.0), (2, 9.0), (3, -9.0), (4, 9.0)] {
        let before = environment.agent().heading_deg;
        environment.step(Action::Discrete(row)).expect("the row exists");
        let turned = (environment.agent().heading_deg - before + 540.0).rem_euclid(360.0) - 180.0;
        assert!((turned - turn).abs() < 1e-3, "row {row} turns {turned}");
    }
    let place = environment.agent().position;
    environment.step(Action::Discrete(0)).expect("the row exists");
    assert!((environment.agent().position[1] - place[1] - 1.0).abs() < 1e-4);
    environment.step(Action::Discrete(6)).expect("interact is the seventh");
    assert_eq!(
        environment.step(Action::Discrete(7)),
        Err(EnvError::NoSuchAction { found: 7, last: 6 })
    );
    let mut world = with_actions(ActionSpace::DefaultDiscrete);
    world.agent_params.interact = false;
    assert_eq!(
        start(world).step(Action::Discrete(6)),
        Err(EnvError::NoSuchAction { found: 6, last: 5 })
    );
}

#[test]
fn third_number_has_no_effect_without_interact() {
    let paid = |interact: bool| {
        let mut world = WorldDraft::with_objects(vec![button()]);
        world.agent_params.interact = interact;
        start(world)
            .step(Action::Continuous([0.0, 0.0, 1.0]))
            .expect("the action is valid")
            .reward
    };
    assert_eq!((paid(true), paid(false)), (1.0, 0.0));
}

#[test]
fn held_action_lasts_several_time_steps_of_one_step() {
    let run = |frame_skip: u32, steps: usize| {
        let mut world = WorldDraft {
            max_steps: 20,
            objects: vec![coin([0.0, 3.4], 2.0)],
            ..WorldDraft::default()
        };
        world.agent_params.frame_skip = frame_skip;
        world.rules.step_reward = -0.5;
        let mut environment = start(world);
        for _ in 0..steps {
            environment
                .step(Action::Continuous([5.0, 10.0, 0.0]))
                .expect("the episode continues");
        }
        (
            environment.agent().position,
            environment.num_steps(),
            environment.episode_return(),
        )
    };
    let (single, held) = (run(1, 8), run(4, 2));
    assert_eq!(single.0, held.0, "the same trajectory");
    assert_eq!((single.1, held.1), (8, 2));
    assert_eq!(
        (single.2 + 4.0, held.2 + 1.0),
        (2.0, 2.0),
        "the step reward is paid once per step"
    );
}

#[test]
fn held_action_interacts_once() {
    let mut world = WorldDraft::with_objects(vec![button()]);
    world.agent_params.frame_skip = 5;
    let step = start(world)
        .step(Action::Continuous([0.0, 0.0, 1.0]))
        .expect("the action is valid");
    assert_eq!(step.reward, 1.0);
}

#[test]
fn touching_out_of_turn_costs_the_penalty() {
    let mut second = coin([0.0, 2.0], 5.0);
    second.order = Some(2);
    let mut first = coin([0.0, -2.0], 5.0);
    first.order = Some(1);
    let mut world = WorldDraft::with_objects(vec![first, second]);
    world.rules.order_penalty = -3.0;
    let mut environment = start(world);
    assert_eq!(drive(&mut environment, 10.0, 3), -3.0, "second before first");
    assert_eq!(drive(&mut environment, -10.0, 6), 5.0);
    assert_eq!(drive(&mut environment, 10.0, 6), 5.0);
}

#[test]
fn total_shaping_does_not_depend_on_how_an_episode_terminates() {
    let total = |turn: f64, conditions: Vec<EndCondition>| {
        let mut world = WorldDraft::with_objects(vec![coin([0.0, 4.0], 1.0)]);
        world.objects[0].tag = Some("goal".to_owned());
        world.rules.shaping = Some(Shaping {
            toward: None,
            scale: 0.5,
            discount: 1.0,
        });
        world.rules.success = conditions;
        let mut environment = start(world);
        let mut steps = 0;
        while !environment.ended() && steps < 200 {
            let turn = if steps < 10 { turn } else { 0.0 };
            let [x, y] = environment.agent().position;
            let home = if steps < 10 {
                turn
            } else {
                let bearing = libm::atan2(f64::from(-x), f64::from(4.0 - y)).to_degrees();
                (bearing - f64::from(environment.agent().heading_deg) + 540.0).rem_euclid(360.0) - 180.0
            };
            environment
                .step(Action::Continuous([1.0, home * 10.0, 0.0]))
                .expect("the episode continues");
            steps += 1;
        }
        assert!(environment.ended(), "the goal is reached");
        environment.episode_return()
    };
    let touch = || vec![EndCondition::Touch("goal".to_owned())];
    let (straight, around) = (total(0.0, touch()), total(40.0, touch()));
    assert!((straight - 3.0).abs() < 1e-5, "1 for the coin, 0.5 × 4 m: {straight}");
    assert!((around - straight).abs() < 1e-5, "{around} {straight}");
    let counted = total(0.0, vec![EndCondition::ReturnAtLeast(1.0)]);
    assert!(
        (counted - 3.0).abs() < 1e-5,
        "the counted rewards exclude shaping: {counted}"
    );
}

#[test]
fn state_vector_contains_the_requested_features() {
    let mut world = WorldDraft {
        max_steps: 10,
        objects: vec![coin([3.0, 0.0], 2.0), coin([-20.0, 0.0], 2.0)],
        ..WorldDraft::default()
    };
    world.objects[1].tag = Some("home".to_owned());
    world.rules.success = vec![EndCondition::Touch("home".to_owned())];
    world.agent_params.heading = 90.0;
    world.agent_params.state_features = vec![
        StateFeature::Direction,
        StateFeature::OwnVelocity,
        StateFeature::Goal,
        StateFeature::NearestTarget,
        StateFeature::Counts,
        StateFeature::LastReward,
        StateFeature::LastEvent,
        StateFeature::StepsLeft,
        StateFeature::Heading,
    ];
    let mut environment = start(world);
    let close = |found: Vec<f32>, expected: [f32; 18]| {
        assert!(
            found.iter().zip(expected).all(|(a, b)| (a - b).abs() < 1e-3) && found.len() == 18,
            "{found:?}\n{expected:?}"
        );
    };
    close(
        environment.state_vector(),
        [
            1.0, 0.0, 0.0, 0.0, -20.0, 0.0, 1.0, 3.0, 0.0, 1.0, 2.0, 0.0, 0.0, 0.0, 0.0, 0.0, 1.0, 90.0,
        ],
    );
    for _ in 0..3 {
        environment
            .step(Action::Continuous([10.0, 0.0, 0.0]))
            .expect("the episode continues");
        if environment.episode_return() > 0.0 {
            break;
        }
    }
    let state = environment.state_vector();
    assert_eq!(state[10..12], [1.0, 1.0], "one left, one collected");
    assert_eq!(state[12..16], [2.0, 1.0, 2.0, 0.0], "paid 2 for a contact");
    assert!(state[7] < -20.0, "the nearest target is the other one, behind");
    let mut short = [0.0; 3];
    assert_eq!(
        environment.write_state(&mut short),
        Err(EnvError::StateLength { found: 3, expected: 18 })
    );
}

#[test]
fn start_inside_a_wall_gives_a_warning() {
    let mut world = WorldDraft::default();
    world.agent_params.coordinates = [49.9, 0.0];
    let warnings = start(world).warnings();
    assert_eq!(
        warnings,
        [Warning::StartsInside {
            obstacle: Obstacle::Wall
        }]
    );
    assert_eq!(
        warnings[0].to_string(),
        "/agent_params/coordinates: found a wall, expected free ground; it may be stuck"
    );
}

#[test]
fn huge_waypoints_are_accepted() {
    let mut world = WorldDraft::default();
    world.agent_params.action_model = ActionModel::ByWaypoint;
    let mut environment = start(world);
    for far in [1e20, 1e39, f64::MAX] {
        environment
            .step(Action::Continuous([far, 0.0, 0.0]))
            .expect("every finite waypoint is valid");
    }
    let [x, y] = environment.agent().position;
    assert!((x - 3.0).abs() < 1e-3 && y.abs() < 1e-3, "{x}, {y}");
}

#[test]
fn destroyed_key_opens_its_door_and_a_door_out_of_turn_stays_shut() {
    let mut key = Object::new("barrel", [0.0, 2.0]);
    (key.order, key.destroy_stimulus) = (Some(1), vec![Stimulus::AgentCollide]);
    let mut door = coin([0.0, -2.0], 5.0);
    (door.order, door.destroy_stimulus) = (Some(2), vec![Stimulus::AgentCollide]);
    let mut environment = start(WorldDraft::with_objects(vec![key, door]));
    assert_eq!(
        drive(&mut environment, -10.0, 3),
        0.0,
        "the door out of turn has no effect and stays in place"
    );
    assert_eq!(drive(&mut environment, 10.0, 6), 0.0, "the key");
    assert_eq!(drive(&mut environment, -10.0, 6), 5.0, "the door");
}

#[test]
fn arm_that_did_not_pay_may_pay_later() {
    let mut arm = coin([0.0, 2.0], 1.0);
    arm.reward_probability = 0.3;
    let mut environment = start(WorldDraft::with_objects(vec![arm]));
    let mut paid = 0.0;
    for step in 0..120 {
        let speed = if step % 6 < 3 { 10.0 } else { -10.0 };
        paid += environment
            .step(Action::Continuous([speed, 0.0, 0.0]))
            .expect("the episode continues")
            .reward;
    }
    assert_eq!(paid, 1.0, "it pays once, however often it is touched");
}
