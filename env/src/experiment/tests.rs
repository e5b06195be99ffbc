//! Compares a world with itself and with variants that have one change, in both orders.

use driftworld_spec::{
    ActionModel, ActionSpace, Color, Door, Element, Energy, MotionModel, Object, Portable, Stimulus, Switch, Wall,
    World, WorldDraft, Zone, ZoneEnd,
};
use proptest::prelude::*;

use super::*;

/// A world with cubes that pay when touched, a barrel that costs points, and a tree.
fn world() -> WorldDraft {
    let mut world = WorldDraft::default();
    world.environment_params.map_size = [30.0, 30.0];
    world.rules.reward_per_second = -1.0;
    world.max_steps = 60;
    world.agent_params.instruction = vec![0.0, 0.0];
    for (tag, class, at, reward) in [
        ("cubes", "geometric", [0.0, 8.0], 10.0),
        ("cubes", "geometric", [6.0, -4.0], 10.0),
        ("barrels", "barrel", [-6.0, 3.0], -5.0),
        ("trees", "tree", [8.0, 8.0], 0.0),
    ] {
        let mut object = Object::new(class, at);
        object.tag = Some(tag.to_owned());
        object.reward = reward;
        if reward != 0.0 {
            object.reward_once_stimulus = vec![Stimulus::AgentCollide];
            object.destroy_stimulus = vec![Stimulus::AgentCollide];
        }
        world.objects.push(object);
    }
    world
}

fn checked(world: &WorldDraft) -> World {
    world.clone().check().expect("the world is valid")
}

fn elements(a: &WorldDraft, b: &WorldDraft) -> Vec<Element> {
    let found = Experiment::default()
        .compare(&[(checked(a), checked(b))])
        .expect("the experiment runs");
    assert_eq!(found.proof.worlds, 1);
    found.elements()
}

#[track_caller]
fn check(expected: &[Element], change: impl Fn(&mut WorldDraft)) {
    let (own, mut changed) = (world(), world());
    change(&mut changed);
    assert_eq!(elements(&own, &changed), expected);
    assert_eq!(elements(&changed, &own), expected);
}

#[test]
fn world_does_not_differ_from_itself() {
    let pairs: Vec<_> = (0..3).map(|_| (checked(&world()), checked(&world()))).collect();
    let found = Experiment::default().compare(&pairs).expect("the experiment runs");
    assert_eq!(found.differences, []);
    assert_eq!((found.proof.worlds, found.proof.runs), (3, 3 * 8));
    assert!(
        found.proof.steps > 1000 && found.proof.observations > 30,
        "{:?}",
        found.proof
    );
    assert_eq!(found.proof.without_counterpart, 0);
}

#[test]
fn objects_and_ground_belong_to_the_state_space() {
    check(&[Element::S], |world| {
        world.objects.push(Object::new("tent", [12.0, 0.0]));
    });
    check(&[Element::S], |world| {
        world.objects.retain(|object| object.class != "tree");
    });
}

#[test]
fn positions_belong_to_the_initial_state() {
    check(&[Element::P], |world| world.objects[0].coordinates = [2.0, 9.0]);
    check(&[Element::P], |world| world.agent_params.heading = 30.0);
    check(&[Element::P], |world| world.agent_params.coordinates = [1.0, 1.0]);
}

#[test]
fn meaning_of_actions_belongs_to_the_action_space() {
    check(&[Element::A], |world| world.agent_params.max_linear_speed = 5.0);
    check(&[Element::A], |world| world.agent_params.max_angular_speed = 45.0);
    check(&[Element::A], |world| {
        world.agent_params.action_model = ActionModel::ByWaypoint;
    });
    check(&[Element::A], |world| {
        world.agent_params.actions = ActionSpace::DefaultDiscrete;
    });
    check(&[Element::A], |world| world.agent_params.interact = false);
}

#[test]
fn dynamics_belong_to_the_transitions() {
    check(&[Element::T], |world| world.agent_params.frame_skip = 3);
    check(&[Element::T], |world| world.agent_params.agent_width = 0.3);
    check(&[Element::T], |world| world.objects[0].destroy_stimulus = vec![]);
    check(&[Element::T], |world| {
        world.objects[1].motion_model = MotionModel::Prey;
        world.objects[1].speed = 2.0;
    });
}

/// A room with a lever, a key, and a door that opens on touch on the way to a goal.
fn rooms() -> WorldDraft {
    let mut world = WorldDraft::default();
    world.environment_params.map_size = [6.0, 12.0];
    let wall = |x: [f64; 2]| Wall {
        polygon: vec![[x[0], -0.1], [x[1], -0.1], [x[1], 0.1], [x[0], 0.1]],
        height: None,
        color: None,
    };
    world.environment_params.walls = vec![wall([-3.0, -0.75]), wall([0.75, 3.0])];
    let mut door = Object::new("door", [0.0, 0.0]);
    (door.tag, door.scale) = (Some("gate".to_owned()), 1.5);
    door.door = Some(Door {
        opens_on: vec![Stimulus::AgentCollide],
        ..Door::default()
    });
    let mut key = Object::new("key", [0.0, -2.0]);
    (key.tag, key.portable) = (Some("gold".to_owned()), Some(Portable::default()));
    let mut goal = Object::new("cube", [0.0, 4.0]);
    (goal.tag, goal.reward) = (Some("goal".to_owned()), 1.0);
    goal.reward_once_stimulus = vec![Stimulus::AgentCollide];
    let mut lever = Object::new("switch", [2.0, -2.0]);
    (lever.tag, lever.switch) = (Some("lever".to_owned()), Some(Switch::of("gate")));
    world.objects = vec![door, key, goal, lever];
    (world.agent_params.coordinates, world.agent_params.agent_width) = ([0.0, -4.0], 0.6);
    world.agent_params.carry_limit = 1;
    world.agent_params.energy = Some(Energy::default());
    world
}

#[test]
fn changes_to_doors_switches_keys_and_energy_are_found() {
    // Two pairs, so that the visitor also goes through the tags backwards.
    let elements = |a: &WorldDraft, b: &WorldDraft| {
        let pair = (checked(a), checked(b));
        let found = Experiment::default()
            .compare(&[pair.clone(), pair])
            .expect("the experiment runs");
        found.elements()
    };
    let mut num_changes = 0;
    let mut check = |expected: &[Element], change: &dyn Fn(&mut WorldDraft)| {
        num_changes += 1;
        // A row of the table either moves or interacts; continuous actions can do both at once.
        for actions in [ActionSpace::Continuous, ActionSpace::DefaultDiscrete] {
            let mut own = rooms();
            own.agent_params.actions = actions;
            let mut changed = own.clone();
            change(&mut changed);
            assert_eq!(elements(&own, &changed), expected, "change {num_changes}");
            assert_eq!(
                elements(&changed, &own),
                expected,
                "change {num_changes} the other way round"
            );
        }
    };
    let door = |change: fn(&mut Door)| {
        move |world: &mut WorldDraft| change(world.objects[0].door.as_mut().expect("the object is a door"))
    };
    check(&[], &|_| {});
    check(&[Element::P], &door(|door| door.open = true));
    check(&[Element::T], &door(|door| door.closes_after = Some(60.0)));
    check(&[Element::T], &door(|door| door.opens_on = vec![]));
    check(
        &[Element::T],
        &door(|door| door.closes_on = vec![Stimulus::AgentInteract]),
    );
    check(&[Element::T], &door(|door| door.key = Some("gold".to_owned())));
    check(&[Element::T], &door(|door| door.period = Some(4.0)));
    check(&[Element::T], &|world| world.objects[1].portable = None);
    check(&[Element::T], &|world| {
        world.objects[3].switch = Some(Switch::of("nothing"));
    });
    check(&[Element::T], &|world| world.agent_params.carry_limit = 0);
    let energy = |change: fn(&mut Energy)| {
        move |world: &mut WorldDraft| change(world.agent_params.energy.as_mut().expect("the agent has energy"))
    };
    check(&[Element::P], &energy(|energy| energy.start = 50.0));
    check(&[Element::T], &energy(|energy| energy.per_second = -2.0));
    check(&[Element::T], &energy(|energy| energy.per_metre = -0.1));
    check(&[Element::T], &|world| world.objects[2].energy = 5.0);
}

#[test]
fn zones_that_pay_or_end_the_episode_belong_to_the_rewards() {
    let zone = |change: fn(&mut Zone)| {
        move |world: &mut WorldDraft| {
            let mut zone = Zone::disc([0.0, -2.0], 1.5);
            zone.visible = false;
            change(&mut zone);
            world.environment_params.zones.push(zone);
        }
    };
    let check = |expected: &[Element], change: &dyn Fn(&mut WorldDraft)| {
        let mut changed = rooms();
        change(&mut changed);
        assert_eq!(elements(&rooms(), &changed), expected);
        assert_eq!(elements(&changed, &rooms()), expected);
    };
    check(&[], &zone(|_| {}));
    check(&[Element::R], &zone(|zone| zone.reward_per_second = -5.0));
    check(&[Element::R], &zone(|zone| zone.reward_on_entering = 3.0));
    check(&[Element::R], &zone(|zone| zone.ends = Some(ZoneEnd::Failure)));
    check(&[Element::T], &zone(|zone| zone.speed_factor = 0.5));
}

/// The two pieces together have the same outline, but sums are rounded differently.
#[test]
fn wall_in_two_pieces_looks_like_one() {
    let wall = |x: [f64; 2]| Wall {
        polygon: vec![[x[0], 5.0], [x[1], 5.0], [x[1], 5.3], [x[0], 5.3]],
        height: None,
        color: None,
    };
    let with = |walls: Vec<Wall>| {
        let mut world = world();
        world.agent_params.modalities = vec![Modality::Depth];
        world.environment_params.walls = walls;
        world
    };
    let found = elements(
        &with(vec![wall([-9.0, 9.0])]),
        &with(vec![wall([-9.0, 0.7]), wall([0.7, 9.0])]),
    );
    assert!(!found.contains(&Element::Phi), "{found:?}");
}

#[test]
fn position_of_a_respawning_object_belongs_only_to_the_initial_state() {
    let returning = |at: [f64; 2]| {
        let mut world = world();
        world.objects[0].coordinates = at;
        world.objects[0].respawn = Some(driftworld_spec::Respawn {
            delay: 0.5,
            radius: 0.0,
        });
        world
    };
    assert_eq!(elements(&returning([0.0, 8.0]), &returning([2.0, 9.0])), [Element::P]);
}

#[test]
fn rewards_are_compared_even_if_all_transitions_differ() {
    check(&[Element::T, Element::R], |world| {
        world.agent_params.frame_skip = 2;
        world.objects[0].reward = 3.0;
    });
}

#[test]
fn rewards_and_episode_ends_belong_to_the_rewards() {
    check(&[Element::R], |world| world.objects[0].reward = 3.0);
    check(&[Element::R], |world| world.objects[2].reward = -50.0);
    check(&[Element::R], |world| world.rules.reward_per_second = -2.0);
    check(&[Element::R], |world| {
        world.rules.success = vec![driftworld_spec::EndCondition::AllCollected];
    });
    check(&[Element::R], |world| world.max_steps = 50);
}

#[test]
fn looks_belong_to_the_emission() {
    check(&[Element::Phi], |world| {
        world.objects[0].color = Some(Color([1.0, 0.0, 0.0]));
    });
    check(&[Element::Phi], |world| world.environment_params.light_intensity = 0.4);
    check(&[Element::Phi], |world| world.agent_params.field_of_view = 80.0);
    check(&[Element::Phi], |world| world.agent_params.instruction = vec![1.0, 0.0]);
}

#[test]
fn form_of_observations_belongs_to_the_observation_space() {
    check(&[Element::O], |world| world.agent_params.observation_size = 32);
    check(&[Element::O], |world| world.agent_params.state_features.truncate(1));
    check(&[Element::O], |world| world.agent_params.instruction.push(0.0));
    check(&[Element::O], |world| {
        world.agent_params.modalities = vec![Modality::Rgb];
    });
}

#[test]
fn reward_sign_shows_only_in_the_segmentation() {
    let (own, mut changed) = (world(), world());
    for object in changed.objects.iter_mut().filter(|object| object.class == "geometric") {
        object.reward = -10.0;
    }
    for (modalities, expected) in [
        (
            vec![Modality::Rgb, Modality::Depth, Modality::Class, Modality::Instance],
            vec![Element::R],
        ),
        (vec![Modality::Segmentation], vec![Element::R, Element::Phi]),
    ] {
        let experiment = Experiment {
            modalities: Some(modalities),
            ..Experiment::default()
        };
        let found = experiment
            .compare(&[(checked(&own), checked(&changed))])
            .expect("the experiment runs");
        assert_eq!(found.elements(), expected);
    }
}

#[test]
fn overlapping_object_counts_differ_in_the_initial_state_and_disjoint_ones_in_space() {
    let with = |trees: usize| {
        let mut world = world();
        let tree = |number: usize| Object::new("tent", [12.0, number as f64 * 3.0]);
        world.objects.extend((0..trees).map(tree));
        world
    };
    let found = |pairs: &[(usize, usize)]| {
        let pairs: Vec<_> = pairs
            .iter()
            .map(|(a, b)| (checked(&with(*a)), checked(&with(*b))))
            .collect();
        Experiment::default()
            .compare(&pairs)
            .expect("the experiment runs")
            .elements()
    };
    assert_eq!(found(&[(1, 2), (3, 3)]), [Element::P]);
    assert_eq!(found(&[(1, 3), (2, 4)]), [Element::S]);
    assert_eq!(found(&[(0, 1), (0, 2)]), [Element::S]);
}

#[test]
fn witness_names_the_world_and_both_values() {
    let (own, mut changed) = (world(), world());
    changed.objects[0].reward = 3.0;
    let found = Experiment::default()
        .compare(&[(checked(&own), checked(&changed))])
        .expect("the experiment runs");
    let witness = found.witness(Element::R).expect("the reward differs");
    assert_eq!((witness.world, witness.what.as_str()), (Some(0), "the reward"));
    let [a, b] = [&witness.a, &witness.b].map(|text| text.parse::<f64>().expect("the value is a number"));
    assert_eq!(a - b, 7.0, "{witness:?}");
    let back = Experiment::default()
        .compare(&[(checked(&changed), checked(&own))])
        .expect("the experiment runs");
    let back = back.witness(Element::R).expect("the reward differs");
    assert_eq!((&back.a, &back.b), (&witness.b, &witness.a));
}

/// One of the changes from the tests above.
fn change(world: &mut WorldDraft, which: u8) {
    match which {
        0 => world.objects[0].coordinates = [2.0, 9.0],
        1 => world.agent_params.max_linear_speed = 4.0,
        2 => world.agent_params.frame_skip = 2,
        3 => world.objects[1].reward = 77.0,
        4 => world.environment_params.light_intensity = 1.0,
        5 => world.objects.push(Object::new("bench", [-12.0, 0.0])),
        6 => world.agent_params.action_model = ActionModel::ByWaypoint,
        7 => world.objects[2].motion_model = MotionModel::Predator,
        _ => {}
    }
}

proptest! {
    #![proptest_config(ProptestConfig::with_cases(12))]

    /// The order of the two worlds makes no difference, regardless of the changes to them.
    #[test]
    fn findings_are_order_independent(ours in prop::collection::vec(0u8..9, 0..3), theirs in prop::collection::vec(0u8..9, 0..3)) {
        let (mut a, mut b) = (world(), world());
        for which in ours {
            change(&mut a, which);
        }
        for which in theirs {
            change(&mut b, which);
        }
        let experiment = Experiment { steps: 40, side: 16, ..Experiment::default() };
        let there = experiment.compare(&[(checked(&a), checked(&b))]).expect("the experiment runs");
        let back = experiment.compare(&[(checked(&b), checked(&a))]).expect("the experiment runs");
        prop_assert_eq!(there.elements(), back.elements());
        prop_assert_eq!(there.proof, back.proof);
    }
}
