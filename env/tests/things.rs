//! Doors, switches and carriable objects: opening, picking up and putting down, and saved worlds that resume.

use driftworld_env::{Action, Effect, Environment, Event};
use driftworld_spec::{
    Delivery, Door, EndCondition, Object, Portable, Respawn, StateFeature, Stimulus, Switch, SwitchAction, WorldDraft,
};

use crate::fixtures::{key, start, thing, wall_of};

const AHEAD: Action = Action::Continuous([2.0, 0.0, 0.0]);
const USE: Action = Action::Continuous([0.0, 0.0, 1.0]);
const WAIT: Action = Action::Continuous([0.0, 0.0, 0.0]);

/// A door 2 m wide in a wall from west to east through the arena, 4 m north of the agent, which faces it.
fn draft(door: Door) -> WorldDraft {
    let mut world = WorldDraft::default();
    world.environment_params.map_size = [20.0, 20.0];
    let wall = |from: f64, to: f64| wall_of([[from, 3.9], [to, 3.9], [to, 4.1], [from, 4.1]]);
    world.environment_params.walls = vec![wall(-10.0, -1.0), wall(1.0, 10.0)];
    world.agent_params.carry_limit = 1;
    let mut leaf = thing("door", "gate", [0.0, 4.0]);
    leaf.scale = 2.0;
    leaf.door = Some(door);
    world.objects = vec![leaf];
    world
}

fn steps(environment: &mut Environment, action: Action, count: usize) -> Vec<Event> {
    let mut events = Vec::new();
    for _ in 0..count {
        events.extend(environment.step(action).expect("the episode continues").events);
    }
    events
}

/// Reactions of objects, from the events.
fn effects(events: &[Event]) -> Vec<(usize, Effect)> {
    events
        .iter()
        .filter_map(|event| Some((event.object, event.effect?)))
        .collect()
}

fn north(environment: &Environment) -> f32 {
    environment.agent().position[1]
}

#[test]
fn closed_door_stops_the_agent_and_opens_by_interaction() {
    let mut environment = start(draft(Door::default()));
    steps(&mut environment, AHEAD, 40);
    assert!(
        (3.0..3.41).contains(&north(&environment)),
        "it is stopped: {}",
        north(&environment)
    );
    assert_eq!(effects(&steps(&mut environment, USE, 1)), [(0, Effect::Opened)]);
    assert!(environment.objects()[0].open);
    assert_eq!(
        effects(&steps(&mut environment, USE, 1)),
        [],
        "an open door does not react"
    );
    steps(&mut environment, AHEAD, 20);
    assert!(north(&environment) > 6.0, "nothing stops it: {}", north(&environment));
}

#[test]
fn door_that_opens_on_touch_closes_after_its_time_behind_the_agent() {
    let door = Door {
        opens_on: vec![Stimulus::AgentCollide],
        closes_after: Some(1.0),
        ..Door::default()
    };
    let mut environment = start(draft(door));
    let events = steps(&mut environment, AHEAD, 17);
    assert_eq!(effects(&events), [(0, Effect::Opened)]);
    // The agent stands in the doorway for longer than the door would stay open.
    steps(&mut environment, AHEAD, 4);
    steps(&mut environment, WAIT, 30);
    let stands = environment.agent();
    assert!(environment.objects()[0].open && (3.0..5.0).contains(&stands.position[1]));
    steps(&mut environment, AHEAD, 20);
    assert!(
        !environment.objects()[0].open,
        "it closed as soon as nobody stood in it"
    );
    assert!(north(&environment) > 6.0);
}

#[test]
fn door_that_closes_on_a_stimulus_is_a_toggle() {
    let stimuli = || vec![Stimulus::AgentInteract];
    let door = Door {
        opens_on: stimuli(),
        closes_on: stimuli(),
        ..Door::default()
    };
    let mut world = draft(door);
    world.agent_params.coordinates = [0.0, 3.2];
    world.objects[0].reward = 1.0;
    world.objects[0].reward_stimulus = stimuli();
    let mut environment = start(world);
    let events = steps(&mut environment, USE, 3);
    let effects = effects(&events);
    assert_eq!(effects, [(0, Effect::Opened), (0, Effect::Closed), (0, Effect::Opened)]);
    let rewards: Vec<f64> = events.iter().map(|event| event.reward).collect();
    assert_eq!(rewards, [1.0, 0.0, 1.0], "it pays for being opened");
}

#[test]
fn key_unlocks_its_door_and_disappears_if_consumed() {
    for consumed in [false, true] {
        let mut world = draft(Door {
            key: Some("red".to_owned()),
            ..Door::default()
        });
        world.agent_params.state_features = vec![StateFeature::Carrying];
        world.agent_params.coordinates = [0.0, 3.2];
        world.objects[0].reward = 5.0;
        world.objects[0].reward_once_stimulus = vec![Stimulus::AgentInteract];
        let mut red = key("red", [0.0, 2.0]);
        red.portable = Some(Portable {
            consumed,
            ..Portable::default()
        });
        world.objects.extend([key("blue", [0.0, -9.0]), red]);
        let mut environment = start(world);
        let events = steps(&mut environment, USE, 1);
        assert_eq!(
            (effects(&events), events[0].reward),
            (vec![], 0.0),
            "locked doors pay nothing"
        );
        // Turns around to the key behind the agent.
        steps(&mut environment, Action::Continuous([0.0, 90.0, 0.0]), 20);
        assert_eq!(effects(&steps(&mut environment, USE, 1)), [(2, Effect::PickedUp)]);
        assert_eq!(environment.state_vector(), [1.0, 25.0, 3.0]);
        let own = &environment.objects()[2];
        assert!(own.carried && !own.present && !environment.scene().items[2].visible);
        steps(&mut environment, Action::Continuous([0.0, 90.0, 0.0]), 20);
        let events = steps(&mut environment, USE, 1);
        assert_eq!((effects(&events), events[0].reward), (vec![(0, Effect::Opened)], 5.0));
        assert_eq!(environment.state_vector()[0], if consumed { 0.0 } else { 1.0 });
        steps(&mut environment, AHEAD, 20);
        assert!(north(&environment) > 6.0);
        let put = effects(&steps(&mut environment, USE, 1));
        let expected: &[_] = if consumed { &[] } else { &[(2, Effect::PutDown)] };
        assert_eq!(put, expected);
        let own = &environment.objects()[2];
        assert_eq!((own.present, own.carried), (!consumed, false));
        if !consumed {
            let ahead = own.position[1] - north(&environment);
            assert!((0.7..0.8).contains(&ahead), "it lies right in front: {ahead}");
        }
    }
}

#[test]
fn carry_limit_holds_and_an_interaction_moves_one_thing() {
    let mut world = draft(Door::default());
    world.objects = vec![key("a", [0.2, 1.2]), key("b", [-0.1, 1.0]), key("c", [0.0, -3.0])];
    world.agent_params.carry_limit = 0;
    assert_eq!(effects(&steps(&mut start(world.clone()), USE, 1)), []);
    world.agent_params.carry_limit = 2;
    let mut environment = start(world);
    assert_eq!(
        effects(&steps(&mut environment, USE, 1)),
        [(1, Effect::PickedUp)],
        "the nearer one"
    );
    assert_eq!(effects(&steps(&mut environment, USE, 1)), [(0, Effect::PickedUp)]);
    assert_eq!(
        effects(&steps(&mut environment, USE, 2)),
        [(0, Effect::PutDown), (0, Effect::PickedUp)],
        "the last one"
    );
}

#[test]
fn switches_move_all_target_doors_including_locked_ones() {
    for (action, open, expected) in [
        (SwitchAction::Toggle, [false, true], [true, false]),
        (SwitchAction::Open, [false, true], [true, true]),
        (SwitchAction::Close, [false, true], [false, false]),
    ] {
        let mut world = draft(Door {
            opens_on: Vec::new(),
            key: Some("none".to_owned()),
            open: open[0],
            ..Door::default()
        });
        let mut other = thing("door", "gate", [8.0, -8.0]);
        other.door = Some(Door {
            open: open[1],
            ..Door::default()
        });
        let mut lever = thing("switch", "lever", [0.0, 1.2]);
        lever.switch = Some(Switch {
            action,
            ..Switch::of("gate")
        });
        world.objects.extend([other, lever]);
        let mut environment = start(world);
        assert_eq!(effects(&steps(&mut environment, USE, 1)), [(2, Effect::Switched)]);
        assert_eq!(
            [0, 1].map(|door: usize| environment.objects()[door].open),
            expected,
            "{action:?}"
        );
    }
}

#[test]
fn held_action_interacts_once_and_rules_end_the_episode() {
    let mut world = draft(Door {
        closes_on: vec![Stimulus::AgentInteract],
        ..Door::default()
    });
    world.agent_params.frame_skip = 4;
    world.agent_params.coordinates = [0.0, 3.2];
    let mut environment = start(world.clone());
    steps(&mut environment, USE, 1);
    assert!(environment.objects()[0].open, "not toggled four times");
    let ends = |world: &WorldDraft, success: EndCondition| {
        let mut world = world.clone();
        world.rules.success = vec![success];
        start(world).step(USE).expect("the world is valid").success
    };
    assert!(ends(&world, EndCondition::Opened("gate".to_owned())));
    assert!(!ends(&world, EndCondition::Opened("other".to_owned())));
    world.objects.push(key("red", [0.0, 3.9]));
    world.objects.remove(0);
    assert!(ends(&world, EndCondition::Carried("red".to_owned())));
    assert!(!ends(&world, EndCondition::Carried("blue".to_owned())));
}

#[test]
fn delivery_requires_all_objects_with_the_tag() {
    let mut world = draft(Door::default());
    world.objects = vec![
        key("ball", [0.0, 1.0]),
        thing("cube", "box", [0.0, -3.0]),
        key("ball", [0.5, -2.0]),
    ];
    world.rules.success = vec![EndCondition::Delivered(Delivery {
        tag: "ball".to_owned(),
        to: "box".to_owned(),
        within: 2.5,
    })];
    let mut environment = start(world);
    steps(&mut environment, USE, 1);
    steps(&mut environment, Action::Continuous([0.0, 90.0, 0.0]), 20);
    assert!(!environment.ended(), "the carried object has not been delivered");
    assert!(environment.step(USE).expect("the episode continues").success);
}

#[test]
fn carried_target_counts_only_once_put_down() {
    let mut world = draft(Door::default());
    let mut coin = key("coin", [0.0, 1.0]);
    coin.reward = 2.0;
    coin.reward_stimulus = vec![Stimulus::AgentInteract];
    world.objects = vec![coin];
    world.agent_params.state_features = vec![StateFeature::Counts];
    let mut environment = start(world);
    assert_eq!(environment.state_vector()[0], 1.0);
    let step = environment.step(USE).expect("the world is valid");
    assert_eq!(
        (step.reward, environment.state_vector()[0]),
        (2.0, 0.0),
        "it pays for being picked up"
    );
    let step = environment.step(USE).expect("the world is valid");
    assert_eq!(
        (step.reward, environment.state_vector()[0]),
        (0.0, 1.0),
        "and not for being put down"
    );
}

/// An agent that carries one thing, and an object that it has at once.
fn carrier(objects: Vec<Object>) -> WorldDraft {
    let mut world = WorldDraft::default();
    world.environment_params.map_size = [40.0, 40.0];
    (world.agent_params.carry_limit, world.objects) = (1, objects);
    world
}

/// A key 1 m ahead that is picked up on contact.
fn key_on_the_way() -> Object {
    let mut key = key("k", [0.0, 1.0]);
    key.solid = false;
    key.portable.as_mut().expect("it is portable").on = vec![Stimulus::AgentCollide];
    key
}

#[test]
fn key_used_in_the_time_step_of_an_interaction_is_put_down_unless_consumed() {
    for consumed in [false, true] {
        let mut gate = thing("door", "gate", [0.0, 8.0]);
        gate.range_stimulus_distance = 3.5;
        gate.door = Some(Door {
            key: Some("k".to_owned()),
            opens_on: vec![Stimulus::AgentInRange],
            ..Door::default()
        });
        let mut key = key_on_the_way();
        key.portable.as_mut().expect("it is portable").consumed = consumed;
        let world = carrier(vec![gate, key]);
        let opened = (0..100).find(|&before| {
            let mut environment = start(world.clone());
            steps(&mut environment, AHEAD, before);
            let events = effects(&steps(&mut environment, Action::Continuous([2.0, 0.0, 1.0]), 1));
            let opens = events.contains(&(0, Effect::Opened));
            let lies = (events.contains(&(1, Effect::PutDown)), environment.objects()[1].present);
            assert!(!opens || lies == (!consumed, !consumed), "{consumed}: {events:?}");
            opens
        });
        assert!(
            opened.is_some(),
            "no interaction fell into the step in which the door opened"
        );
    }
}

#[test]
fn open_door_put_down_after_resuming_is_open() {
    let mut leaf = thing("door", "gate", [0.0, 3.0]);
    leaf.range_stimulus_distance = 2.6;
    leaf.door = Some(Door {
        opens_on: vec![Stimulus::AgentInRange],
        ..Door::default()
    });
    leaf.portable = Some(Portable {
        on: vec![Stimulus::AgentInteract],
        ..Portable::default()
    });
    let mut environment = start(carrier(vec![leaf]));
    while !environment.objects()[0].open {
        steps(&mut environment, AHEAD, 1);
    }
    while !environment.objects()[0].carried {
        steps(&mut environment, AHEAD, 1);
        steps(&mut environment, USE, 1);
    }
    let mut resumed = Environment::new(environment.state());
    for action in [USE].into_iter().chain([AHEAD; 30]) {
        let [here, there] = [&mut environment, &mut resumed].map(|one| (steps(one, action, 1), one.agent().position));
        assert_eq!(here, there);
    }
    assert!(!environment.objects()[0].carried);
}

#[test]
fn carried_things_are_teleported_with_the_agent() {
    let mut world = carrier(vec![key_on_the_way()]);
    let zone = r#"{ "disc": { "center": [0, 5], "radius": 1 }, "teleport": [10, 10] }"#;
    world.environment_params.zones = vec![serde_json::from_str(zone).expect("it is a zone")];
    let mut environment = start(world);
    let follows =
        |environment: &Environment| assert_eq!(environment.objects()[0].position, environment.agent().position);
    while !environment.objects()[0].carried {
        steps(&mut environment, AHEAD, 1);
    }
    while north(&environment) < 9.0 {
        steps(&mut environment, AHEAD, 1);
        follows(&environment);
    }
    environment.teleport([-3.0, 2.0], 0.0).expect("the place is free");
    follows(&environment);
}

#[test]
fn things_return_after_their_delay_whatever_the_time_step() {
    for (time_step, thousandths) in [(0.02, 20), (0.05, 50), (0.1, 100)] {
        // Whole and half numbers of time steps: between two, it returns at the later one.
        for halves in 1..=120 {
            let mut berry = thing("cube", "berry", [0.0, 1.2]);
            berry.destroy_stimulus = vec![Stimulus::AgentInteract];
            berry.respawn = Some(Respawn {
                delay: f64::from(halves * thousandths / 2) / 1000.0,
                radius: 0.0,
            });
            let mut world = carrier(vec![berry]);
            world.agent_params.time_step = time_step;
            let mut environment = start(world);
            steps(&mut environment, USE, 1);
            assert!(!environment.objects()[0].present);
            let waited = (1..100).find(|_| {
                steps(&mut environment, WAIT, 1);
                environment.objects()[0].present
            });
            assert_eq!(waited, Some((halves + 1) / 2), "{halves} halves of {time_step} s");
        }
    }
}
