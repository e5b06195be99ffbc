//! Touching and approaching: the stimuli that occur as the agent passes an object depend neither on its speed nor on the time
//! step.

#![expect(clippy::disallowed_methods, reason = "compared within a tolerance")]

use driftworld_env::Action;
use driftworld_spec::{Object, Stimulus, WorldDraft};
use proptest::prelude::*;

use crate::fixtures::start;

/// Number of times that each stimulus occurs on a path of legs (turn in degrees, metres), at this speed and with this time step.
fn count(mut world: WorldDraft, legs: &[(f64, f64)], speed: f64, seconds: f64) -> [usize; 2] {
    let agent = &mut world.agent_params;
    (agent.max_linear_speed, agent.max_angular_speed, agent.time_step) = (100.0, 3600.0, seconds);
    let mut environment = start(world);
    let mut counts = [0; 2];
    let mut act = |ahead: f64, turn: f64| {
        let step = environment
            .step(Action::Continuous([ahead / seconds, turn / seconds, 0.0]))
            .expect("the episode continues");
        for event in &step.events {
            match event.stimulus {
                Stimulus::AgentCollide => counts[0] += 1,
                Stimulus::AgentInRange => counts[1] += 1,
                Stimulus::AgentInteract => {}
            }
        }
    };
    act(0.0, 0.0);
    for &(turn, metres) in legs {
        let turns = (turn.abs() / (3600.0 * seconds)).ceil().max(1.0);
        for _ in 0..turns as usize {
            act(0.0, turn / turns);
        }
        let steps = (metres / (speed * seconds)).ceil().max(1.0);
        for _ in 0..steps as usize {
            act(metres / steps, 0.0);
        }
    }
    counts
}

fn touchable(class: &str, at: [f64; 2]) -> Object {
    let mut object = Object::new(class, at);
    object.reward = 1.0;
    object.reward_stimulus = vec![Stimulus::AgentCollide, Stimulus::AgentInRange];
    object
}

/// Speeds and time steps: from more than a metre per step down to a centimetre.
const PACES: [(f64, f64); 7] = [
    (1.0, 0.1),
    (2.0, 0.1),
    (5.0, 0.1),
    (10.0, 0.1),
    (5.0, 0.02),
    (0.5, 0.02),
    (30.0, 0.1),
];

proptest! {
    #![proptest_config(ProptestConfig::with_cases(crate::tier::quick_or_full(24, 200)))]

    #[test]
    fn one_pass_is_one_contact_at_any_speed(
        class in prop::sample::select(vec!["barrel", "ball", "rock", "tree", "cube", "bush"]),
        off in -0.9..0.9_f64,
        scale in 0.5..3.0_f64,
        heading in 0.0..360.0_f64,
        solid in any::<bool>(),
    ) {
        let mut object = touchable(class, [0.0, 0.0]);
        (object.scale, object.heading, object.solid) = (scale, heading, solid);
        let mut world = WorldDraft::with_objects(vec![object]);
        let reach = f64::from(start(world.clone()).scene().items[0].asset.collider.radius()) * scale;
        // The agent hits the object off-centre and keeps walking until it is past it.
        let room = if class == "cube" { reach / 1.5 } else { reach };
        world.agent_params.coordinates = [off * room, -reach - 4.0];
        for (speed, seconds) in PACES {
            let [touches, _] = count(world.clone(), &[(0.0, 4.0 * reach + 30.0)], speed, seconds);
            prop_assert_eq!(touches, 1, "{} m/s in steps of {} s", speed, seconds);
        }
    }

    #[test]
    fn stimuli_of_a_path_do_not_depend_on_the_speed(
        legs in prop::collection::vec((-180.0..180.0_f64, 0.5..12.0_f64), 1..12),
        places in prop::collection::vec((-8.0..8.0_f64, -8.0..8.0_f64, 0.3..4.0_f64), 1..8),
    ) {
        // Ghosts stop nothing, so the path is the same at every speed.
        let objects = places.iter().map(|&(x, y, range)| {
            let mut object = touchable("ball", [x, y]);
            object.solid = false;
            object.range_stimulus_distance = range;
            object
        });
        let world = WorldDraft::with_objects(objects.collect());
        let slow = count(world.clone(), &legs, 0.2, 0.05);
        for (speed, seconds) in PACES {
            let found = count(world.clone(), &legs, speed, seconds);
            let off = [0, 1].map(|kind| found[kind].abs_diff(slow[kind]));
            prop_assert!(off == [0, 0], "{found:?} beside {slow:?} at {speed} m/s in steps of {seconds} s");
        }
    }
}

#[test]
fn range_crossed_within_a_step_is_entered() {
    let mut object = touchable("ball", [3.0, 5.0]);
    object.range_stimulus_distance = 3.5;
    let world = WorldDraft::with_objects(vec![object]);
    for (speed, seconds) in PACES {
        assert_eq!(
            count(world.clone(), &[(0.0, 20.0)], speed, seconds)[1],
            1,
            "{speed} {seconds}"
        );
    }
    assert_eq!(count(world, &[(0.0, 40.0)], 100.0, 0.4)[1], 1, "in one step");
}

#[test]
fn stimuli_at_the_start_occur_once_in_the_first_step() {
    let mut zone = touchable("ball", [0.5, 0.0]);
    (zone.solid, zone.range_stimulus_distance) = (false, 4.0);
    let mut environment = start(WorldDraft::with_objects(vec![zone]));
    let mut step = || {
        let step = environment
            .step(Action::Continuous([0.0; 3]))
            .expect("the episode continues");
        step.events.iter().map(|event| event.stimulus).collect::<Vec<_>>()
    };
    assert_eq!(step(), [Stimulus::AgentCollide, Stimulus::AgentInRange]);
    assert_eq!(step(), []);
}

#[test]
fn contact_ends_at_a_gap_of_a_quarter_metre() {
    let world = WorldDraft::with_objects(vec![touchable("cube", [0.0, 3.0])]);
    // Towards the object, back by this distance, and towards it again.
    for (back, expected) in [(0.1, 1), (0.2, 1), (0.3, 2), (1.0, 2)] {
        for (speed, seconds) in [(1.0, 0.1), (10.0, 0.1), (5.0, 0.02)] {
            let found = count(
                world.clone(),
                &[(0.0, 3.0), (180.0, back), (180.0, 3.0)],
                speed,
                seconds,
            );
            assert_eq!(
                found[0], expected,
                "back by {back} m at {speed} m/s in steps of {seconds} s"
            );
        }
    }
}

#[test]
fn fast_mover_touches_and_comes_near_once() {
    for speed in [1.0, 5.0, 20.0, 60.0] {
        let mut ghost = touchable("ball", [-30.0, 0.2]);
        (ghost.solid, ghost.range_stimulus_distance) = (false, 1.0);
        ghost.motion_model = driftworld_spec::MotionModel::Patrol;
        ghost.speed = speed;
        ghost.heading = 90.0;
        ghost.waypoints = vec![[40.0, 0.2]];
        let mut environment = start(WorldDraft::with_objects(vec![ghost]));
        let mut counts = [0; 2];
        for _ in 0..(700.0 / speed) as usize + 10 {
            let step = environment
                .step(Action::Continuous([0.0; 3]))
                .expect("the episode continues");
            counts[0] += step
                .events
                .iter()
                .filter(|event| event.stimulus == Stimulus::AgentCollide)
                .count();
            counts[1] += step
                .events
                .iter()
                .filter(|event| event.stimulus == Stimulus::AgentInRange)
                .count();
        }
        assert_eq!(counts, [1, 1], "{speed} m/s");
    }
}

/// Number of touches and approaches between an agent and a ball that move at the same time, both straight, with this time step.
fn meeting(mut object: Object, agent: ([f64; 2], f64, f64), seconds: f64, total: f64) -> [usize; 2] {
    let (at, heading, speed) = agent;
    object.motion_model = driftworld_spec::MotionModel::Patrol;
    let mut world = WorldDraft::with_objects(vec![object]);
    world.agent_params.coordinates = at;
    world.agent_params.heading = heading;
    world.agent_params.time_step = seconds;
    world.agent_params.max_linear_speed = 100.0;
    let mut environment = start(world);
    let mut counts = [0; 2];
    for _ in 0..(total / seconds).round() as usize {
        let step = environment
            .step(Action::Continuous([speed, 0.0, 0.0]))
            .expect("the episode continues");
        for event in &step.events {
            counts[usize::from(event.stimulus == Stimulus::AgentInRange)] += 1;
        }
    }
    counts
}

proptest! {
    #![proptest_config(ProptestConfig::with_cases(crate::tier::quick_or_full(24, 200)))]

    #[test]
    fn moving_bodies_meet_if_their_paths_do(
        from in -20.0..20.0_f64,
        off in -6.0..6.0_f64,
        heading in 0.0..360.0_f64,
        own in 0.5..10.0_f64,
        others in 0.5..10.0_f64,
        range in 1.0..4.0_f64,
    ) {
        let mut ghost = touchable("ball", [from, off]);
        (ghost.solid, ghost.range_stimulus_distance, ghost.speed, ghost.heading) = (false, range, others, 90.0);
        ghost.waypoints = vec![[250.0, off]];
        let agent = ([0.0, -15.0], heading, own);
        // The smallest distance within 4 s, centre to centre on the ground.
        let (sine, cosine) = (heading.to_radians().sin(), heading.to_radians().cos());
        let nearest = (0..=40_000).map(|k| f64::from(k) * 1e-4).map(|time| {
            let x = from + others * time - sine * own * time;
            let y = off + 15.0 - cosine * own * time;
            x.hypot(y)
        }).fold(f64::INFINITY, f64::min);
        let environment = start(WorldDraft::with_objects(vec![ghost.clone()]));
        let item = &environment.scene().items[0];
        let radius = f64::from(item.asset.collider.radius() * item.scale);
        let height = (f64::from(item.asset.height * item.scale) - 1.0) / 2.0;
        let near = usize::from(nearest.hypot(height) < range);
        let touch = usize::from(nearest < radius + 0.5 + 0.03);
        let edge = (nearest.hypot(height) - range).abs() < 0.01 || (nearest - radius - 0.53).abs() < 0.01;
        prop_assume!(!edge);
        for seconds in [0.1, 0.05, 0.02, 0.01] {
            let found = meeting(ghost.clone(), agent, seconds, 4.0);
            prop_assert_eq!(found, [touch, near], "in steps of {} s, {} m", seconds, nearest);
        }
    }
}

#[test]
fn following_closely_is_one_touch() {
    for others in [1.0, 2.4, 2.6, 4.0, 6.0, 9.0] {
        for seconds in [0.1, 0.05, 0.02, 0.01] {
            let mut ball = touchable("ball", [0.0, -45.0]);
            ball.speed = others;
            ball.waypoints = vec![[0.0, 48.0]];
            let found = meeting(ball, ([0.0, -47.0], 0.0, 10.0), seconds, 6.0);
            assert_eq!(found[0], 1, "{others} m/s in steps of {seconds} s");
        }
    }
}

#[test]
fn moving_alongside_outside_the_range_is_never_near() {
    let mut ball = touchable("ball", [0.0, -36.95]);
    (ball.speed, ball.range_stimulus_distance) = (2.0, 3.0);
    ball.waypoints = vec![[0.0, 40.0]];
    for seconds in [0.1, 0.02] {
        assert_eq!(meeting(ball.clone(), ([0.0, -40.0], 0.0, 2.0), seconds, 10.0), [0, 0]);
    }
}
