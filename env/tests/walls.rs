//! Sliding: along any obstacle, the agent, a mover or a pushed body keeps the velocity component parallel to it, and passes
//! through nothing.

#![expect(clippy::disallowed_methods, reason = "compared within a tolerance")]

use driftworld_env::{Action, Environment};
use driftworld_spec::{MotionModel, Object, Pushable, Wall, WorldDraft};
use proptest::prelude::*;

use crate::fixtures::{start, wall_of};

/// A wall with this length in metres through a point, at this bearing in degrees clockwise from +y.
fn wall(through: [f64; 2], bearing_deg: f64, length: f64) -> Wall {
    let along = direction(bearing_deg).map(|part| part * length / 2.0);
    let across = direction(bearing_deg + 90.0).map(|part| part * 0.1);
    let corner = |a: f64, b: f64| [0, 1].map(|axis| through[axis] + a * along[axis] + b * across[axis]);
    wall_of([
        corner(-1.0, 1.0),
        corner(1.0, 1.0),
        corner(1.0, -1.0),
        corner(-1.0, -1.0),
    ])
}

fn direction(bearing_deg: f64) -> [f64; 2] {
    let bearing = bearing_deg.to_radians();
    [bearing.sin(), bearing.cos()]
}

fn arena(metres: f64) -> WorldDraft {
    let mut world = WorldDraft::default();
    world.environment_params.map_size = [metres, metres];
    world
}

fn go(environment: &mut Environment, speed: f64) -> [f64; 2] {
    environment
        .step(Action::Continuous([speed, 0.0, 0.0]))
        .expect("the episode continues");
    environment.agent().position.map(f64::from)
}

fn dot(a: [f64; 2], b: [f64; 2]) -> f64 {
    a[0] * b[0] + a[1] * b[1]
}

fn minus(a: [f64; 2], b: [f64; 2]) -> [f64; 2] {
    [a[0] - b[0], a[1] - b[1]]
}

proptest! {
    #![proptest_config(ProptestConfig::with_cases(crate::tier::quick_or_full(24, 1000)))]

    #[test]
    fn agent_keeps_the_parallel_velocity_along_a_wall(
        bearing in 0.0..360.0_f64,
        // The angle from the wall's normal: 0 leads straight into the wall.
        angle in prop_oneof![-89.9..-0.5_f64, 0.5..89.9_f64],
        length in 2.0..160.0_f64,
        width in 0.1..3.0_f64,
        speed in 0.2..20.0_f64,
        seconds in 0.01..0.5_f64,
        at in (-40.0..40.0_f64, -40.0..40.0_f64),
    ) {
        let (along, normal) = (direction(bearing), direction(bearing + 90.0));
        let mut world = arena(300.0);
        world.environment_params.walls = vec![wall([at.0, at.1], bearing, length)];
        let agent = &mut world.agent_params;
        agent.agent_width = width;
        agent.max_linear_speed = speed;
        agent.time_step = seconds;
        // The agent starts in front of the wall and is driven into it. The wall's sides are 0.12 m from its centre line.
        let distance = 0.12 + width / 2.0 + 0.01;
        let sign = angle.signum();
        let behind = sign * length * 0.4;
        agent.coordinates = [0, 1].map(|axis| [at.0, at.1][axis] - along[axis] * behind + normal[axis] * distance);
        agent.heading = (bearing - 90.0 + angle).rem_euclid(360.0);
        let meant = speed * seconds * angle.to_radians().sin();
        let steps = ((length * 0.7 / meant.abs()).floor() as usize).min(200);
        prop_assume!(steps > 0);
        let mut environment = start(world);
        let begun = environment.agent().position.map(f64::from);
        let mut last = begun;
        for step in 1..=steps {
            let now = go(&mut environment, speed);
            let progress = dot(minus(now, last), along) * sign;
            prop_assert!(progress > 0.0 || meant.abs() < 1e-3, "step {step} of {steps}: {progress}");
            prop_assert!(dot(minus(now, [at.0, at.1]), normal) > 0.12 + width / 2.0, "step {step} is in the wall");
            last = now;
        }
        let progress = dot(minus(last, begun), along);
        let expected = meant * steps as f64;
        prop_assert!((progress - expected).abs() <= 0.01 * expected.abs() + 1e-3, "{progress} of {expected} in {steps} steps");
    }

    #[test]
    fn mover_keeps_the_parallel_velocity_along_a_wall(
        bearing in 0.0..360.0_f64,
        angle in prop_oneof![-85.0..-3.0_f64, 3.0..85.0_f64],
        length in 10.0..120.0_f64,
        speed in 0.5..10.0_f64,
        class in prop::sample::select(vec!["ball", "cube", "barrel", "rock"]),
    ) {
        let (along, normal) = (direction(bearing), direction(bearing + 90.0));
        let mut world = arena(300.0);
        world.environment_params.walls = vec![wall([0.0; 2], bearing, length)];
        world.agent_params.coordinates = [-145.0, -145.0];
        let sign = angle.signum();
        let mut mover = Object::new(class, [0, 1].map(|axis| normal[axis] * 2.0 - along[axis] * sign * length * 0.4));
        mover.motion_model = MotionModel::Patrol;
        mover.speed = speed;
        mover.heading = (bearing - 90.0 + angle).rem_euclid(360.0);
        // Far behind the wall: the direction to it changes by less than a degree.
        let far = direction(bearing - 90.0 + angle).map(|part| part * 2e4);
        let from = mover.coordinates;
        mover.waypoints = vec![[from[0] + far[0], from[1] + far[1]].map(|metres| metres.clamp(-290.0, 290.0))];
        let to = mover.waypoints[0];
        world.objects = vec![mover];
        let mut environment = start(world);
        let place = |environment: &Environment| environment.scene().items[0].position.map(f64::from);
        let mut last = place(&environment);
        for _ in 0..100 {
            environment.step(Action::Continuous([0.0; 3])).expect("the episode continues");
            let now = place(&environment);
            let moved = minus(now, last);
            let way = minus(to, last);
            let far = dot(way, way).sqrt();
            let meant = dot(way, along) / far * speed * 0.1;
            let (side, into) = (dot(last, normal), dot(way, normal));
            let ahead = dot(last, along) * meant.signum();
            if side > 0.0 && side < 2.5 && into < 0.0 && ahead < length / 2.0 - 3.0 && ahead > -length / 2.0 + 3.0 {
                let free = speed * 0.1;
                if (dot(moved, moved).sqrt() - free).abs() > 1e-4 {
                    prop_assert!((dot(moved, along) - meant).abs() < 0.01 * meant.abs() + 2e-4, "{moved:?} of {meant}");
                }
            }
            prop_assert!(dot(last, normal).signum() == dot(now, normal).signum() || ahead.abs() > length / 2.0 - 1.5, "through");
            last = now;
        }
    }

    #[test]
    fn wedges_and_tight_gaps_stop_the_body(
        bearing in 0.0..360.0_f64,
        opening in 1.0..60.0_f64,
        off in -0.4..0.4_f64,
        width in 0.2..2.0_f64,
        speed in 0.5..30.0_f64,
    ) {
        // Two walls that meet at a point, with the agent between them on its way to that point.
        let mut world = arena(300.0);
        let axis = direction(bearing);
        let polygon = |turn: f64| {
            let way = direction(bearing + turn).map(|part| part * 150.0);
            let thick = direction(bearing + turn + 90.0 * turn.signum()).map(|part| part * 0.5);
            vec![[0.0, 0.0], way, [way[0] + thick[0], way[1] + thick[1]], thick]
        };
        world.environment_params.walls = [opening / 2.0, -opening / 2.0]
            .map(|turn| wall_of(polygon(turn)))
            .to_vec();
        let agent = &mut world.agent_params;
        agent.agent_width = width;
        agent.max_linear_speed = speed;
        let room = (width / 2.0 + 0.05) / (opening / 2.0).to_radians().sin();
        prop_assume!(room < 100.0);
        agent.coordinates = axis.map(|part| part * (room + 10.0));
        agent.heading = (bearing + 180.0 + off * opening).rem_euclid(360.0);
        let mut environment = start(world);
        let mut last = [0.0; 2];
        for _ in 0..((room + 20.0) / speed * 10.0 * 2.0) as usize + 200 {
            last = go(&mut environment, speed);
            prop_assert!(dot(last, axis) > 0.0, "through the point");
            // The distance to each wall, from the angle.
            let (x, y) = (dot(last, axis), dot(last, direction(bearing + 90.0)));
            let half = (opening / 2.0).to_radians();
            let least = x * half.sin() - y.abs() * half.cos();
            prop_assert!(least > width / 2.0, "{least} from a wall");
        }
        let again = go(&mut environment, speed);
        prop_assert!(dot(minus(again, last), minus(again, last)).sqrt() < 1e-3, "at rest in the wedge");
        // The agent gets as deep as possible, so its width determines its distance from the point.
        let expected = (width / 2.0 + 0.03) / (opening / 2.0).to_radians().sin();
        prop_assert!(dot(again, axis) < expected + 0.2, "{again:?} {expected}");
    }
}

#[test]
fn agent_does_not_get_stuck_at_an_oblique_wall() {
    let mut world = arena(200.0);
    world.environment_params.walls = vec![wall_of([[-30.0, -30.0], [30.0, 30.0], [29.0, 31.0], [-31.0, -29.0]])];
    world.agent_params.coordinates = [-14.0, -18.0];
    world.agent_params.heading = 15.0;
    let mut environment = start(world);
    let mut last = [0.0; 2];
    for _ in 0..20 {
        go(&mut environment, 5.0);
    }
    for _ in 0..40 {
        let now = environment.agent().position.map(f64::from);
        last = go(&mut environment, 5.0);
        let speed = dot(minus(last, now), minus(last, now)).sqrt() * 10.0;
        // 5 m/s at 30° to the wall.
        assert!((speed - 5.0 * 30.0_f64.to_radians().cos()).abs() < 0.01, "{speed}");
    }
    assert!(last[0] > 2.0, "{last:?}");
}

#[test]
fn sliding_body_keeps_the_parallel_velocity_at_a_wall() {
    for (class, friction) in [("ball", 0.0), ("cube", 0.0), ("barrel", 0.0)] {
        for heading in [10.0_f64, 30.0, 45.0, 60.0, 80.0] {
            let mut world = arena(300.0);
            world.environment_params.walls = vec![wall_of([[-150.0, 6.0], [150.0, 6.0], [150.0, 7.0], [-150.0, 7.0]])];
            let mut body = Object::new(class, [-140.0, 0.0]);
            body.pushable = Some(Pushable { mass: 5.0, friction });
            body.heading = heading;
            let way = direction(heading);
            world.agent_params.coordinates = [-140.0 - way[0] * 1.5, -way[1] * 1.5];
            world.agent_params.heading = heading;
            world.objects = vec![body];
            let mut environment = start(world);
            let place = |environment: &Environment| environment.scene().items[0].position.map(f64::from);
            for _ in 0..4 {
                go(&mut environment, 8.0);
            }
            // From here on the body slides by itself, until some time after it has hit the wall.
            go(&mut environment, 0.0);
            let before = place(&environment);
            go(&mut environment, 0.0);
            let meant = minus(place(&environment), before)[0];
            assert!(meant > 0.01, "{class} {heading}: it slides, {meant}");
            // Its impact takes up to a sixtieth of a second, the longest step of the physics.
            let (begun, mut last, mut nearest) = (place(&environment), [0.0; 2], f64::NEG_INFINITY);
            for _ in 0..120 {
                go(&mut environment, 0.0);
                last = place(&environment);
                nearest = nearest.max(last[1]);
            }
            let progress = last[0] - begun[0];
            assert!(
                (progress / 120.0 - meant).abs() < 0.01 * meant,
                "{class} {heading}°: {progress} of {}",
                120.0 * meant
            );
            // A cube swings away again when its second corner hits.
            assert!(nearest > 4.0, "{class} {heading}°: it reached the wall: {nearest}");
        }
    }
}

#[test]
fn pushed_body_slides_along_a_wall() {
    // A body that is pushed obliquely at a wall moves on along it.
    for (class, friction) in [("ball", 0.0), ("cube", 0.0), ("ball", 0.5), ("cube", 0.5)] {
        for heading in [20.0_f64, 35.0, 60.0, 75.0] {
            let mut world = arena(300.0);
            world.environment_params.walls =
                vec![wall_of([[-150.0, 10.0], [150.0, 10.0], [150.0, 11.0], [-150.0, 11.0]])];
            let mut body = Object::new(class, [-100.0, 0.0]);
            body.heading = heading;
            body.pushable = Some(Pushable { mass: 5.0, friction });
            let way = direction(heading);
            world.agent_params.coordinates = [-100.0 - way[0] * 3.0, -way[1] * 3.0];
            world.agent_params.heading = heading;
            world.objects = vec![body];
            let mut environment = start(world);
            let mut last = f64::NEG_INFINITY;
            for step in 0..300 {
                go(&mut environment, 5.0);
                let [x, y] = environment.scene().items[0].position.map(f64::from);
                // A cube turns where a corner is pushed, and its centre swings back.
                let swing = if class == "cube" { 0.3 } else { 1e-3 };
                assert!(
                    x >= last - swing || last == f64::NEG_INFINITY,
                    "{class} {heading}° step {step}: {last} to {x}"
                );
                assert!(y < 10.0);
                last = x;
                if x > 130.0 {
                    break;
                }
            }
            assert!(last > -90.0, "{class} {heading}°: {last}");
        }
    }
}

proptest! {
    #![proptest_config(ProptestConfig::with_cases(crate::tier::quick_or_full(24, 300)))]

    #[test]
    fn mover_with_corners_gets_around_a_wall(
        class in prop::sample::select(vec!["cube", "car", "fence", "ball", "bench"]),
        across in -8.0..8.0_f64,
        beyond in 16.5..22.0_f64,
        speed in 0.5..6.0_f64,
        scale in 0.5..1.5_f64,
    ) {
        let mut world = arena(100.0);
        world.agent_params.coordinates = [48.0, 48.0];
        world.environment_params.walls = vec![wall_of([[-15.0, -6.0], [15.0, -6.0], [15.0, 0.0], [-15.0, 0.0]])];
        let mut mover = Object::new(class, [across, 3.5]);
        (mover.motion_model, mover.speed, mover.scale) = (MotionModel::Patrol, speed, scale);
        // Beyond the wall's end and slightly below its side: the path there leads along it.
        mover.waypoints = vec![[beyond + 2.0, -0.5], [42.0, -0.5]];
        world.objects = vec![mover];
        let mut environment = start(world);
        let mut least = f64::INFINITY;
        for _ in 0..(60.0 / speed * 10.0) as usize + 50 {
            environment.step(Action::Continuous([0.0; 3])).expect("the episode continues");
            let [x, y] = environment.scene().items[0].position.map(f64::from);
            if x.abs() < 14.0 {
                least = least.min(y);
            }
            if x > 30.0 {
                break;
            }
        }
        let [x, y] = environment.scene().items[0].position;
        prop_assert!(least > 0.0, "into the wall: {least}");
        prop_assert!(x > 30.0, "stopped at ({x}, {y})");
    }

    #[test]
    fn tip_of_a_wall_does_not_stop_the_agent(
        half in prop_oneof![Just(2.5), Just(10.0), Just(22.5), Just(45.0), Just(60.0), 2.0..75.0_f64],
        off in prop_oneof![-0.02..-0.002_f64, 0.002..0.02_f64],
        turn in 0.0..360.0_f64,
    ) {
        let mut world = arena(300.0);
        let way = |bearing: f64| direction(bearing + turn).map(|part| part * 30.0);
        let (left, right) = (way(-half), way(half));
        world.environment_params.walls = vec![wall_of([[0.0, 0.0], right, [left[0] + right[0], left[1] + right[1]], left])];
        let (ahead, across) = (direction(turn), direction(turn + 90.0));
        world.agent_params.coordinates = [0, 1].map(|axis| -3.0 * ahead[axis] + off * across[axis]);
        world.agent_params.heading = turn;
        let mut environment = start(world);
        for _ in 0..200 {
            go(&mut environment, 5.0);
        }
        let at = environment.agent().position.map(f64::from);
        prop_assert!(dot(at, across) * off.signum() > 1.0, "{at:?}");
    }
}

#[test]
fn sliding_around_a_disc_takes_the_same_time_at_any_time_step() {
    // In closed form: the tangent of half the angle from head-on grows with exp(v t / r).
    for share in [0.01_f64, 0.05, 0.1, 0.3] {
        for seconds in [1.0, 0.1, 0.01] {
            for scale in [1.0, 20.0] {
                let mut barrel = Object::new("barrel", [0.0, 0.0]);
                barrel.scale = scale;
                let mut world = arena(300.0);
                world.objects = vec![barrel];
                world.agent_params.time_step = seconds;
                let reach = {
                    let environment = start(world.clone());
                    let item = &environment.scene().items[0];
                    f64::from(item.asset.collider.radius() * item.scale) + 0.5 + 0.01
                };
                world.agent_params.coordinates = [share * reach, -reach - 5.0];
                let mut environment = start(world);
                let total = 12.0 + scale;
                for _ in 0..(total / seconds).round() as usize {
                    go(&mut environment, 5.0);
                }
                let [_, y] = environment.agent().position.map(f64::from);
                let first = share.asin();
                let met = reach + 5.0 - reach * first.cos();
                let round = -reach / 5.0 * (first / 2.0).tan().ln();
                let expected = (total - met / 5.0 - round) * 5.0;
                assert!(
                    (y - expected).abs() < 0.01 * expected + 0.02,
                    "{share} {seconds} s × {scale}: {y}, expected {expected}"
                );
            }
        }
    }
}
