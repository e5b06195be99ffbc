//! Changes to a running world from outside: spawning, destroying, teleporting, and restoring a snapshot.

use driftworld_env::{Action, EnvError, Environment, Obstacle};
use driftworld_spec::{Object, Respawn, Stimulus, WorldDraft};

const AHEAD: Action = Action::Continuous([10.0, 0.0, 0.0]);
const STAY: Action = Action::Continuous([0.0; 3]);

fn start(objects: Vec<Object>) -> Environment {
    let world = WorldDraft::with_objects(objects);
    Environment::new(world.check().expect("the world is valid"))
}

fn coin(metres: f64) -> Object {
    let mut coin = Object::new("barrel", [0.0, metres]);
    coin.reward = 3.0;
    coin.reward_stimulus = vec![Stimulus::AgentCollide];
    coin.unique_name = Some(format!("coin {metres}"));
    coin
}

fn reward(environment: &mut Environment, action: Action) -> f64 {
    environment.step(action).expect("the episode continues").reward
}

#[test]
fn spawned_object_is_present_and_pays() {
    let mut environment = start(vec![Object::new("tree", [3.0, 12.0])]);
    let index = environment.spawn(coin(1.8)).expect("the coin is valid");
    assert_eq!((index, environment.find("coin 1.8")), (1, Some(1)));
    assert!(environment.observe().instance.contains(&2), "and is seen");
    assert_eq!(reward(&mut environment, AHEAD), 3.0);
}

#[test]
fn spawning_onto_the_agent_is_a_new_contact() {
    let mut environment = start(Vec::new());
    environment.spawn(coin(0.0)).expect("the coin is valid");
    assert_eq!(reward(&mut environment, STAY), 3.0);
}

#[test]
fn invalid_objects_are_not_spawned() {
    let mut environment = start(vec![coin(1.8)]);
    let mut broken = coin(3.0);
    broken.scale = -1.0;
    let error = environment.spawn(broken).expect_err("no object has a negative size");
    assert_eq!(error.code(), "env/bad-object");
    assert!(error.to_string().contains("(/scale): found -1"), "{error}");
    let taken = environment.spawn(coin(1.8)).expect_err("the name is taken");
    assert_eq!(
        taken,
        EnvError::NameTaken {
            name: "coin 1.8".to_owned(),
            object: 0
        }
    );
    assert_eq!(environment.objects().len(), 1);
}

#[test]
fn destroyed_object_is_gone_and_its_sequence_continues() {
    let mut first = coin(-5.0);
    first.order = Some(1);
    first.respawn = Some(Respawn {
        delay: 0.1,
        radius: 0.0,
    });
    let mut second = coin(1.8);
    second.order = Some(2);
    let mut environment = start(vec![first, second]);
    environment.destroy(0).expect("the object is present");
    assert_eq!(environment.destroy(0), Err(EnvError::AlreadyGone { object: 0 }));
    assert_eq!(
        environment.destroy(2),
        Err(EnvError::NoSuchObject { found: 2, count: 2 })
    );
    assert_eq!(reward(&mut environment, AHEAD), 3.0, "the second is due now");
    assert!((0..20).all(|_| reward(&mut environment, STAY) == 0.0));
    assert!(!environment.objects()[0].present);
}

#[test]
fn teleport_requires_room() {
    let mut environment = start(vec![coin(1.8)]);
    environment.teleport([10.0, -10.0], -90.0).expect("free ground");
    assert_eq!(
        (environment.agent().position, environment.agent().heading_deg),
        ([10.0, -10.0], 270.0)
    );
    let obstacle = |position| match environment.clone_of_start().teleport(position, 0.0) {
        Err(EnvError::NoRoom { found, .. }) => found,
        other => panic!("{position:?}: {other:?}"),
    };
    assert_eq!(obstacle([60.0, 0.0]), Obstacle::Outside);
    assert_eq!(obstacle([49.8, 0.0]), Obstacle::Wall);
    assert_eq!(obstacle([0.0, 1.8]), Obstacle::Object { index: 0 });
    assert_eq!(obstacle([f64::NAN, 2.0]), Obstacle::Outside);
    let turned = environment.teleport([0.0, 0.0], f64::INFINITY);
    assert_eq!(turned, Err(EnvError::NoHeading { found: f64::INFINITY }));
    assert_eq!(environment.agent().position, [10.0, -10.0]);
}

#[test]
fn teleporting_beside_an_object_is_not_a_contact() {
    let mut environment = start(vec![coin(5.0)]);
    // The radii: 0.4 m for the barrel and 0.5 m for the agent.
    environment.teleport([0.0, 4.075], 0.0).expect("there is room");
    assert_eq!(reward(&mut environment, STAY), 0.0);
}

/// A fresh environment of the same world.
trait Restart {
    fn clone_of_start(&self) -> Environment;
}

impl Restart for Environment {
    fn clone_of_start(&self) -> Environment {
        Environment::new(self.world().clone())
    }
}

#[test]
fn restoring_a_snapshot_undoes_spawns_and_destructions() {
    let mut environment = start(vec![coin(1.8), Object::new("tree", [3.0, 12.0])]);
    let moment = environment.snapshot();
    environment.spawn(coin(1.0)).expect("the coin is valid");
    environment.destroy(1).expect("the object is present");
    reward(&mut environment, AHEAD);
    environment.restore(&moment);
    assert_eq!(environment.objects().len(), 2);
    assert!(environment.objects()[1].present && environment.observe().instance.contains(&2));
    assert_eq!(reward(&mut environment, AHEAD), 3.0);
    let mut other = start(Vec::new());
    other.restore(&moment);
    assert_eq!(reward(&mut other, AHEAD), 3.0);
}

#[test]
fn agent_walks_out_of_an_object_spawned_onto_it() {
    let mut environment = start(Vec::new());
    let mut cube = Object::new("cube", [0.1, 0.3]);
    cube.scale = 3.0;
    environment.spawn(cube).expect("the cube is valid");
    for _ in 0..30 {
        reward(&mut environment, AHEAD);
    }
    let [_, y] = environment.agent().position;
    assert!(y > 3.0, "{y}");
}
