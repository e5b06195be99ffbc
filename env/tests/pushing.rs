//! Pushed objects: how far they go, which obstacles stop them, and that none is pushed through a wall.

use driftworld_env::{Action, Environment, Warning};
use driftworld_spec::{MotionModel, Object, Pushable, Stimulus, WorldDraft};
use proptest::prelude::*;

const AHEAD: Action = Action::Continuous([2.0, 0.0, 0.0]);
const STAND: Action = Action::Continuous([0.0; 3]);

fn body(at: [f64; 2], mass: f64, friction: f64) -> Object {
    let mut body = Object::new("cube", at);
    body.pushable = Some(Pushable { mass, friction });
    body
}

fn start(objects: Vec<Object>) -> Environment {
    let mut world = WorldDraft::with_objects(objects);
    world.environment_params.map_size = [20.0, 20.0];
    Environment::new(world.check().expect("the world is valid"))
}

fn go(environment: &mut Environment, action: Action, steps: usize) {
    for _ in 0..steps {
        environment.step(action).expect("the episode continues");
    }
}

fn place(environment: &Environment, index: usize) -> [f32; 2] {
    environment.scene().items[index].position
}

#[test]
fn pushed_object_moves_with_the_agent_and_stays_where_it_is_left() {
    let mut environment = start(vec![body([0.0, 2.0], 10.0, 0.5)]);
    go(&mut environment, AHEAD, 25);
    let [x, y] = place(&environment, 0);
    assert!(y > 4.0 && x.abs() < 0.2, "pushed a few metres ahead: {x}, {y}");
    let gap = y - environment.agent().position[1];
    assert!((0.9..1.6).contains(&gap), "it stays in front of the agent: {gap}");
    go(&mut environment, STAND, 20);
    let rest = place(&environment, 0);
    go(&mut environment, STAND, 20);
    assert_eq!(place(&environment, 0), rest, "friction brings it to rest");
}

#[test]
fn heavy_and_static_objects_stop_the_agent() {
    let reached = |mass: f64| {
        let mut environment = start(vec![body([0.0, 2.0], mass, 0.5)]);
        go(&mut environment, AHEAD, 25);
        (environment.agent().position[1], place(&environment, 0)[1])
    };
    let (light, heavy, rock) = (reached(5.0), reached(60.0), reached(100_000.0));
    assert!(light.0 > heavy.0 && heavy.0 > rock.0, "{light:?} {heavy:?} {rock:?}");
    assert!(rock.1 < 2.05, "100 t do not move: {rock:?}");
    let mut fast = start(vec![Object::new("cube", [0.0, 2.0])]);
    go(&mut fast, AHEAD, 25);
    assert_eq!(place(&fast, 0), [0.0, 2.0]);
}

#[test]
fn object_on_ice_keeps_sliding() {
    let slid = |friction: f64| {
        let mut environment = start(vec![body([0.0, 2.0], 10.0, friction)]);
        go(&mut environment, AHEAD, 8);
        let left = place(&environment, 0)[1];
        go(&mut environment, STAND, 15);
        place(&environment, 0)[1] - left
    };
    assert!(slid(0.0) > 1.0, "{}", slid(0.0));
    assert!(slid(1.0) < 0.3, "{}", slid(1.0));
}

#[test]
fn off_centre_push_rotates_the_object() {
    let mut environment = start(vec![body([0.35, 2.0], 10.0, 0.3)]);
    go(&mut environment, AHEAD, 12);
    let turned = environment.scene().items[0].heading_deg;
    assert!(
        (2.0..358.0).contains(&turned),
        "the left side is pushed and the right side lags behind: {turned}"
    );
}

#[test]
fn pushed_object_pushes_the_next() {
    let mut environment = start(vec![body([0.0, 2.0], 5.0, 0.3), body([0.0, 3.2], 5.0, 0.3)]);
    go(&mut environment, AHEAD, 25);
    assert!(place(&environment, 1)[1] > 4.0, "{:?}", place(&environment, 1));
}

#[test]
fn pushing_counts_as_a_contact() {
    let mut pays = body([0.0, 2.0], 10.0, 0.5);
    pays.reward = 1.0;
    pays.reward_once_stimulus = vec![Stimulus::AgentCollide];
    let mut environment = start(vec![pays]);
    go(&mut environment, AHEAD, 10);
    assert_eq!(environment.episode_return(), 1.0);
}

#[test]
fn unpushable_object_gives_a_warning() {
    let mut ghost = body([0.0, 2.0], 5.0, 0.5);
    ghost.solid = false;
    let mut mover = body([3.0, 2.0], 5.0, 0.5);
    (mover.motion_model, mover.speed) = (MotionModel::Prey, 1.0);
    let warnings = start(vec![ghost, mover]).warnings();
    assert_eq!(
        warnings,
        [Warning::IsNotPushed { object: 0 }, Warning::IsNotPushed { object: 1 }]
    );
    assert!(warnings[0].to_string().starts_with("/objects/0/pushable: found"));
}

proptest! {
    #![proptest_config(ProptestConfig::with_cases(crate::tier::quick_or_full(24, 32)))]

    #[test]
    fn nothing_is_pushed_out_of_the_arena(
        speed in 1.0f64..40.0,
        mass in 0.1f64..200.0,
        friction in 0.0f64..1.0,
        side in -0.6f64..0.6,
        turns in proptest::collection::vec(-40.0f64..40.0, 60),
    ) {
        let mut world = WorldDraft::with_objects(vec![body([side, 2.0], mass, friction), body([side, 3.5], mass, friction)]);
        world.environment_params.map_size = [12.0, 12.0];
        world.agent_params.max_linear_speed = 40.0;
        let mut environment = Environment::new(world.check().expect("the world is valid"));
        for turn in turns {
            environment.step(Action::Continuous([speed, turn, 0.0])).expect("the episode continues");
            for index in 0..2 {
                let [x, y] = place(&environment, index);
                prop_assert!(x.abs() < 6.0 && y.abs() < 6.0, "pushed to {x}, {y}");
            }
            let [x, y] = environment.agent().position;
            prop_assert!(x.abs() <= 5.5 && y.abs() <= 5.5, "the agent is at {x}, {y}");
        }
    }
}

#[test]
fn pushed_distance_does_not_depend_on_the_time_step() {
    for (class, speed) in [
        ("barrel", 0.5),
        ("barrel", 2.0),
        ("barrel", 5.0),
        ("ball", 5.0),
        ("cube", 5.0),
    ] {
        for seconds in [0.1, 0.05, 0.03, 0.02, 0.01, 0.004] {
            let mut body = Object::new(class, [0.0, 0.0]);
            body.pushable = Some(Pushable {
                mass: 5.0,
                friction: 0.5,
            });
            let mut world = WorldDraft::with_objects(vec![body]);
            world.agent_params.coordinates = [0.0, -1.2];
            world.agent_params.time_step = seconds;
            let mut environment = Environment::new(world.check().expect("the world is valid"));
            let first = f64::from(environment.agent().position[1]);
            let steps = (4.0 / seconds).round() as usize;
            for _ in 0..steps {
                environment
                    .step(Action::Continuous([speed, 0.0, 0.0]))
                    .expect("the episode continues");
            }
            let walked = f64::from(environment.agent().position[1]) - first;
            let pushed = f64::from(environment.scene().items[0].position[1]);
            let met = walked - pushed;
            assert!(
                walked > 0.95 * 4.0 * speed,
                "{class} {speed} m/s in steps of {seconds} s: {walked}"
            );
            assert!(
                (0.2..0.5).contains(&met),
                "{class} {speed} m/s in steps of {seconds} s: {pushed} of {walked}"
            );
        }
    }
}
