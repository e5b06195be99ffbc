//! Objects that move by themselves, and objects that respawn.

use driftworld_env::{Action, Environment};
use driftworld_spec::{MotionModel, Object, Respawn, Stimulus, WorldDraft};

use crate::fixtures::wall_of;

const STAND: Action = Action::Continuous([0.0, 0.0, 0.0]);

fn mover(model: MotionModel, at: [f64; 2], speed: f64) -> Object {
    let mut object = Object::new("barrel", at);
    object.motion_model = model;
    object.speed = speed;
    object
}

fn start(objects: Vec<Object>) -> Environment {
    let mut world = WorldDraft::with_objects(objects);
    world.environment_params.map_size = [40.0, 40.0];
    begin(&world)
}

fn begin(world: &WorldDraft) -> Environment {
    let world = world.clone().check().expect("the world is valid");
    Environment::new(world)
}

fn position(environment: &Environment, index: usize) -> [f32; 2] {
    environment.scene().items[index].position
}

fn distance([ax, ay]: [f32; 2], [bx, by]: [f32; 2]) -> f32 {
    ((ax - bx) * (ax - bx) + (ay - by) * (ay - by)).sqrt()
}

fn step(environment: &mut Environment) -> driftworld_env::Step {
    environment.step(STAND).unwrap_or_else(|error| panic!("{error}"))
}

#[test]
fn predator_comes_and_touches_the_agent_once() {
    let mut predator = mover(MotionModel::Predator, [0.0, 10.0], 2.0);
    predator.reward = -5.0;
    predator.reward_stimulus = vec![Stimulus::AgentCollide];
    let mut environment = start(vec![predator]);
    let paid: Vec<f64> = (0..100).map(|_| step(&mut environment).reward).collect();
    assert_eq!(
        paid.iter().filter(|reward| **reward == -5.0).count(),
        1,
        "one contact, however long it lasts"
    );
    let apart = distance(position(&environment, 0), environment.agent().position);
    assert!((0.5..1.2).contains(&apart), "it stops in front of the agent: {apart}");
}

#[test]
fn predator_out_of_sight_stands_still() {
    let mut predator = mover(MotionModel::Predator, [0.0, 10.0], 2.0);
    predator.sight_range = Some(5.0);
    let mut environment = start(vec![predator]);
    step(&mut environment);
    assert_eq!(position(&environment, 0), [0.0, 10.0]);
}

#[test]
fn prey_flees_from_the_agent_and_stays_in_the_arena() {
    let mut environment = start(vec![mover(MotionModel::Prey, [1.0, 5.0], 3.0)]);
    let before = distance(position(&environment, 0), [0.0, 0.0]);
    step(&mut environment);
    assert!(
        distance(position(&environment, 0), [0.0, 0.0]) > before + 0.25,
        "3 m/s for 0.1 s"
    );
    for _ in 0..300 {
        step(&mut environment);
        assert!(position(&environment, 0).iter().all(|metres| metres.abs() < 20.0));
    }
}

#[test]
fn patrol_visits_its_points_in_order_repeatedly() {
    let mut guard = mover(MotionModel::Patrol, [-5.0, 5.0], 4.0);
    guard.waypoints = vec![[5.0, 5.0], [5.0, 10.0], [-5.0, 10.0]];
    let points: Vec<[f32; 2]> = guard
        .waypoints
        .iter()
        .map(|point| point.map(|metres| metres as f32))
        .collect();
    let mut environment = start(vec![guard]);
    let mut visited = Vec::new();
    for _ in 0..250 {
        step(&mut environment);
        let here = points
            .iter()
            .position(|point| distance(*point, position(&environment, 0)) < 0.35);
        if let Some(point) = here.filter(|point| visited.last() != Some(point)) {
            visited.push(point);
        }
    }
    assert!(
        visited.len() >= 6 && visited.windows(2).all(|pair| (pair[0] + 1) % 3 == pair[1]),
        "{visited:?}"
    );
}

#[test]
fn turn_rate_limits_the_bend() {
    let mut slow = mover(MotionModel::Predator, [10.0, 0.0], 2.0);
    slow.turn_rate = Some(30.0);
    let mut environment = start(vec![slow]);
    for steps in 1..=10 {
        step(&mut environment);
        let turned = 360.0 - environment.scene().items[0].heading_deg;
        assert!(
            (turned - 3.0 * steps as f32).abs() < 1e-3,
            "3 degrees a step, to the west: {turned}"
        );
    }
}

#[test]
fn wanderers_cover_the_arena_stay_in_it_and_out_of_walls() {
    let mut world = WorldDraft::with_objects(vec![mover(MotionModel::RandomWaypoint, [10.0, 10.0], 8.0)]);
    world.environment_params.map_size = [40.0, 40.0];
    let block = vec![[-3.0, -15.0], [3.0, -15.0], [3.0, -5.0], [-3.0, -5.0]];
    world.environment_params.walls.push(wall_of(block));
    let walk = |world: &WorldDraft| -> Vec<[f32; 2]> {
        let mut environment = begin(world);
        (0..3000)
            .map(|_| {
                step(&mut environment);
                position(&environment, 0)
            })
            .collect()
    };
    let places = walk(&world);
    assert_eq!(places, walk(&world), "the same world gives the same walk");
    assert!(places.iter().all(|[x, y]| x.abs() < 20.0 && y.abs() < 20.0));
    assert!(
        !places.iter().any(|[x, y]| x.abs() < 2.9 && (-14.9..-5.1).contains(y)),
        "the block is not entered"
    );
    for corner in [[-1.0, -1.0], [-1.0, 1.0], [1.0, -1.0], [1.0, 1.0]] {
        let there = |[x, y]: &[f32; 2]| x * corner[0] > 5.0 && y * corner[1] > 5.0;
        assert!(places.iter().any(there), "every corner is visited: {corner:?}");
    }
    world.objects.push(Object::new("tree", [-15.0, 15.0]));
    assert_ne!(
        places,
        walk(&world),
        "an additional object changes the random numbers of a world without a seed"
    );
    world.seed = Some(1);
    let seeded = walk(&world);
    world.objects.insert(0, Object::new("tree", [-17.0, 17.0]));
    let after_the_tree = |world: &WorldDraft| -> Vec<[f32; 2]> {
        let mut environment = begin(world);
        (0..100)
            .map(|_| (step(&mut environment), position(&environment, 1)).1)
            .collect()
    };
    assert_eq!(after_the_tree(&world), seeded[..100], "with a seed they stay the same");
}

#[test]
fn destroyed_object_respawns_after_its_delay_and_pays_again() {
    let mut coin = Object::new("barrel", [0.0, 1.2]);
    coin.reward = 1.0;
    coin.reward_once_stimulus = vec![Stimulus::AgentInRange];
    coin.destroy_stimulus = vec![Stimulus::AgentInRange];
    coin.range_stimulus_distance = 3.0;
    coin.respawn = Some(Respawn {
        delay: 0.5,
        radius: 0.4,
    });
    coin.coordinates = [0.0, 3.5];
    let mut environment = start(vec![coin]);
    assert!(environment.warnings().is_empty());
    // A step ahead brings the coin into range; then the agent stands still.
    let reward = environment
        .step(Action::Continuous([10.0, 0.0, 0.0]))
        .unwrap_or_else(|error| panic!("{error}"))
        .reward;
    assert_eq!(reward, 1.0);
    assert!(!environment.objects()[0].present);
    let paid: Vec<(u32, f64)> = (2..40)
        .map(|number| (number, step(&mut environment).reward))
        .filter(|(_, reward)| *reward != 0.0)
        .collect();
    assert!(paid.len() >= 4, "it pays repeatedly: {paid:?}");
    assert!(
        paid.windows(2).all(|pair| pair[1].0 - pair[0].0 >= 5),
        "never before half a second has passed: {paid:?}"
    );
    let first = position(&environment, 0);
    assert!(
        distance(first, [0.0, 3.5]) <= 0.4 + 1e-4,
        "within 0.4 m of its original position: {first:?}"
    );
}

#[test]
fn movers_never_leave_the_arena_or_pass_walls() {
    for (number, model) in [MotionModel::Prey, MotionModel::Predator, MotionModel::RandomWaypoint]
        .into_iter()
        .cycle()
        .take(24)
        .enumerate()
    {
        let mut moving = mover(model, [-9.0 + number as f64 * 0.7, 6.0], 4.0 + 2.0 * number as f64);
        moving.class = if number % 2 == 0 { "barrel" } else { "rock" }.to_owned();
        let mut world = WorldDraft::with_objects(vec![moving]);
        world.environment_params.map_size = [24.0, 24.0];
        world.environment_params.walls = vec![wall_of([[-12.0, 0.0], [12.0, 0.0], [12.0, 0.4], [-12.0, 0.4]])];
        world.agent_params.coordinates = [3.0, -6.0];
        let mut environment = begin(&world);
        for turn in 0..150 {
            environment
                .step(Action::Continuous([5.0, f64::from(turn % 40) * 9.0 - 180.0, 0.0]))
                .unwrap_or_else(|error| panic!("{error}"));
            let [x, y] = position(&environment, 0);
            assert!(x.abs() <= 12.0 && (0.0..=12.0).contains(&y), "{model:?} at {x}, {y}");
        }
    }
}

#[test]
fn objects_respawn_outside_of_regions() {
    let mut coin = Object::new("geometric", [0.0, 3.0]);
    coin.destroy_stimulus = vec![Stimulus::AgentCollide];
    coin.respawn = Some(Respawn {
        delay: 0.1,
        radius: 12.0,
    });
    for seed in 0..30 {
        let mut world = WorldDraft {
            seed: Some(seed),
            objects: vec![coin.clone()],
            ..WorldDraft::default()
        };
        world.environment_params.walls = vec![wall_of([[4.0, -20.0], [20.0, -20.0], [20.0, 20.0], [4.0, 20.0]])];
        let mut environment = begin(&world);
        for _ in 0..12 {
            environment
                .step(Action::Continuous([10.0, 0.0, 0.0]))
                .unwrap_or_else(|error| panic!("{error}"));
        }
        let [x, _] = position(&environment, 0);
        assert!(x < 4.0, "in the region at {x}");
    }
}

#[test]
fn slowly_turning_patrol_arrives() {
    let mut patrol = mover(MotionModel::Patrol, [0.0, 10.0], 5.0);
    patrol.turn_rate = Some(45.0);
    patrol.waypoints = vec![[0.0, 10.0], [3.0, 10.0]];
    let mut environment = start(vec![patrol]);
    let mut nearest = f32::INFINITY;
    for _ in 0..300 {
        step(&mut environment);
        nearest = nearest.min(distance(position(&environment, 0), [3.0, 10.0]));
    }
    assert!(nearest < 0.5, "{nearest}");
}
