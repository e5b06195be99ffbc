//! Random numbers inside a world: every object has its own, unaffected by anything else.

use driftworld_env::{Action, Environment};
use driftworld_spec::{MotionModel, Object, Respawn, Stimulus, WorldDraft};
use proptest::prelude::*;

const STAND: Action = Action::Continuous([0.0, 0.0, 0.0]);
const INTERACT: Action = Action::Continuous([0.0, 0.0, 1.0]);

fn start(seed: u64, objects: Vec<Object>) -> Environment {
    let world = WorldDraft {
        seed: Some(seed),
        objects,
        ..WorldDraft::default()
    };
    Environment::new(world.check().expect("the world is valid"))
}

fn arm(at: [f64; 2], odds: f64) -> Object {
    let mut arm = Object::new("pot", at);
    (arm.reward, arm.reward_probability) = (1.0, odds);
    arm.reward_stimulus = vec![Stimulus::AgentInteract];
    arm
}

/// Which pulls of an arm in front of the agent pay.
fn pulls(seed: u64, objects: Vec<Object>, count: usize) -> Vec<bool> {
    let mut environment = start(seed, objects);
    let mut pull = || environment.step(INTERACT).expect("the episode continues").reward > 0.0;
    (0..count).map(|_| pull()).collect()
}

fn wanderer(at: [f64; 2], seed: Option<u64>) -> Object {
    let mut wanderer = Object::new("mushroom", at);
    (wanderer.motion_model, wanderer.speed, wanderer.solid) = (MotionModel::RandomWaypoint, 3.0, false);
    wanderer.seed = seed;
    wanderer
}

proptest! {
    #![proptest_config(ProptestConfig::with_cases(24))]

    #[test]
    fn lowering_odds_only_removes_payments(seed in 0..1_u64 << 53, low in 0.0..1.0_f64, high in 0.0..=1.0_f64) {
        let (low, high) = (low.min(high), low.max(high));
        let [few, many] = [low, high].map(|odds| pulls(seed, vec![arm([0.0, 1.0], odds)], 100));
        prop_assert!(few.iter().zip(&many).all(|(few, many)| !few || *many));
    }

    #[test]
    fn pulls_do_not_depend_on_the_reward_or_on_other_objects(seed in 0..1_u64 << 53, odds in 0.0..1.0_f64) {
        let own = arm([0.0, 1.0], odds);
        let alone = pulls(seed, vec![own.clone()], 100);
        let mut dear = own.clone();
        (dear.reward, dear.tag, dear.unique_name) = (20.0, Some("dear".into()), Some("arm".into()));
        prop_assert_eq!(&pulls(seed, vec![dear], 100), &alone);
        // Another arm is pulled as well, but has a cost, which is not counted.
        let mut costs = arm([0.3, 1.0], 0.5);
        costs.reward = -1e-9;
        let others = vec![wanderer([9.0, 9.0], None), costs, own];
        let paid = pulls(seed, others, 100);
        prop_assert_eq!(&paid, &alone);
    }

    #[test]
    fn wanderers_path_does_not_depend_on_other_objects_or_list_order(
        seed in 0..1_u64 << 53,
        others in prop::collection::vec(([-40.0..40.0_f64, -40.0..40.0_f64], prop::option::of(1_u64..9)), 0..6),
        place in any::<prop::sample::Index>(),
        own_seed in prop_oneof![Just(None), Just(Some(0))],
    ) {
        let own = wanderer([5.0, -7.0], own_seed);
        let walk = |objects: Vec<Object>, index: usize| {
            let mut environment = start(seed, objects);
            (0..200).map(|_| {
                environment.step(STAND).expect("the episode continues");
                environment.scene().items[index].position
            }).collect::<Vec<_>>()
        };
        let alone = walk(vec![own.clone()], 0);
        let mut objects: Vec<Object> = others.into_iter().map(|(at, seed)| wanderer(at, seed)).collect();
        let index = place.index(objects.len() + 1);
        objects.insert(index, own);
        prop_assert_eq!(walk(objects, index), alone);
    }
}

#[test]
fn seeded_object_keeps_its_random_numbers_at_any_place() {
    let first_goal = |at| {
        let mut environment = start(4, vec![wanderer(at, Some(11))]);
        environment.step(STAND).expect("the episode continues");
        let progress = environment.state().into_draft().progress.expect("a state has progress");
        progress.objects[0].goal.expect("the wanderer has a goal")
    };
    assert_eq!(first_goal([3.0, 4.0]), first_goal([-20.0, 1.0]));
}

#[test]
fn respawn_places_do_not_depend_on_rewards_or_other_objects() {
    let coin = |reward: f64, at: [f64; 2]| {
        let mut coin = Object::new("geometric", at);
        (coin.reward, coin.solid, coin.range_stimulus_distance) = (reward, false, 900.0);
        coin.reward_stimulus = vec![Stimulus::AgentInRange];
        coin.destroy_stimulus = vec![Stimulus::AgentInRange, Stimulus::AgentInteract];
        coin.respawn = Some(Respawn {
            delay: 0.2,
            radius: 20.0,
        });
        coin
    };
    let places = |objects: Vec<Object>, index: usize| {
        let mut environment = start(8, objects);
        (0..100)
            .map(|_| {
                environment.step(INTERACT).expect("the episode continues");
                environment.scene().items[index].position
            })
            .collect::<Vec<_>>()
    };
    let alone = places(vec![coin(1.0, [0.0, 1.0])], 0);
    assert!(alone.iter().any(|place| *place != alone[0]), "it comes back elsewhere");
    assert_eq!(places(vec![coin(20.0, [0.0, 1.0])], 0), alone);
    assert_eq!(places(vec![coin(1.0, [0.3, 1.0]), coin(1.0, [0.0, 1.0])], 1), alone);
}
