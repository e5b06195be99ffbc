//! The expert in worlds with doors, keys, switches and carriable objects: it works out the necessary order of its subgoals.

use driftworld_env::Environment;
use driftworld_spec::{
    ActionModel, ActionSpace, Delivery, Door, EndCondition, Object, Portable, Stimulus, Switch, SwitchAction, World,
    WorldDraft,
};
use proptest::prelude::*;

use crate::fixtures::{by_expert, key, thing, wall_of};

/// Three rooms in a row, 6 × 8 m each, separated by walls with a doorway of 1.5 m at x = −3 and x = 3. The agent is in the
/// middle room.
fn rooms(doorways: [f64; 2]) -> WorldDraft {
    let mut world = WorldDraft {
        max_steps: 3000,
        seed: Some(3),
        ..WorldDraft::default()
    };
    world.environment_params.map_size = [18.0, 8.0];
    let wall =
        |x: f64, from: f64, to: f64| wall_of([[x - 0.15, from], [x + 0.15, from], [x + 0.15, to], [x - 0.15, to]]);
    for (x, y) in [-3.0, 3.0].into_iter().zip(doorways) {
        world
            .environment_params
            .walls
            .extend([wall(x, -4.0, y - 0.75), wall(x, y + 0.75, 4.0)]);
    }
    world.agent_params.agent_width = 0.8;
    world.agent_params.max_linear_speed = 3.0;
    world.agent_params.carry_limit = 1;
    world
}

fn door(tag: &str, at: [f64; 2], door: Door) -> Object {
    let mut object = thing("door", tag, at);
    (object.scale, object.heading, object.door) = (1.5, 90.0, Some(door));
    object
}

fn locked(key: &str) -> Door {
    Door {
        key: Some(key.to_owned()),
        ..Door::default()
    }
}

fn goal(at: [f64; 2]) -> Object {
    thing("barrel", "goal", at)
}

fn touch() -> EndCondition {
    EndCondition::Touch("goal".to_owned())
}

/// Number of steps of the expert until success; `None` without success.
fn steps_to_success(world: &World) -> Option<u32> {
    let (environment, last) = by_expert(world.clone(), |_, _| ());
    last.success.then(|| environment.num_steps())
}

/// Checks that the expert succeeds with the objects at various positions and in every action space.
fn check(name: &str, make: impl Fn([f64; 2], &dyn Fn(usize) -> f64) -> WorldDraft) {
    let mut failed = Vec::new();
    for number in 0..60_usize {
        // Positions that differ from world to world: fractional parts of multiples of irrational numbers.
        let unit = |k: usize| ((number + 1) as f64 * [1.618_034, 1.732_05, 2.236_067, 2.645_751][k % 4]).fract();
        let doorways = [unit(0) * 4.0 - 2.0, unit(1) * 4.0 - 2.0];
        let mut world = make(doorways, &unit);
        world.agent_params.coordinates = [unit(2) * 3.0 - 1.5, unit(3) * 4.0 - 2.0];
        world.agent_params.heading = unit(0) * 359.0;
        if number % 3 == 1 {
            world.agent_params.actions = ActionSpace::DefaultDiscrete;
        }
        if number % 6 == 5 {
            (world.agent_params.frame_skip, world.agent_params.time_step) = (2, 0.05);
        }
        let world = world.check().expect("the world is valid");
        if steps_to_success(&world).is_none() {
            failed.push(number);
        }
    }
    assert!(failed.is_empty(), "{name}: worlds {failed:?} of 60");
}

#[test]
fn expert_opens_a_door_on_its_path_by_hand_and_by_touch() {
    for stimulus in [Stimulus::AgentInteract, Stimulus::AgentCollide] {
        check("one door", |ways, unit| {
            let mut world = rooms(ways);
            let leaf = Door {
                opens_on: vec![stimulus],
                ..Door::default()
            };
            world.objects = vec![
                door("a", [3.0, ways[1]], leaf),
                goal([6.0 + unit(1), unit(2) * 5.0 - 2.5]),
            ];
            world.rules.success = vec![touch()];
            world
        });
    }
}

#[test]
fn expert_fetches_the_keys_of_successive_doors() {
    check("a locked door", |ways, unit| {
        let mut world = rooms(ways);
        world.objects = vec![
            door("a", [3.0, ways[1]], locked("red")),
            key("blue", [0.0, 3.0]),
            key("red", [unit(0) * 3.0 - 1.5, -3.3]),
            goal([7.0, unit(2) * 5.0 - 2.5]),
        ];
        world.rules.success = vec![touch()];
        world
    });
    check("a key behind another door", |ways, unit| {
        let mut world = rooms(ways);
        world.objects = vec![
            door("a", [3.0, ways[1]], locked("red")),
            door("b", [-3.0, ways[0]], locked("blue")),
            key("red", [-6.0 - unit(1), unit(0) * 5.0 - 2.5]),
            key("blue", [unit(2) * 3.0 - 1.5, 3.0]),
            goal([7.0, unit(2) * 5.0 - 2.5]),
        ];
        world.rules.success = vec![touch()];
        world
    });
}

#[test]
fn expert_uses_switches_and_waits_for_clocks() {
    check("a switch", |ways, unit| {
        let mut world = rooms(ways);
        let mut lever = thing("switch", "lever", [-6.0, unit(0) * 4.0 - 2.0]);
        lever.switch = Some(Switch {
            action: SwitchAction::Open,
            ..Switch::of("a")
        });
        let shut = Door {
            opens_on: Vec::new(),
            ..Door::default()
        };
        world.objects = vec![
            door("a", [3.0, ways[1]], shut),
            door("b", [-3.0, ways[0]], Door::default()),
            lever,
            goal([7.0, unit(2) * 5.0 - 2.5]),
        ];
        world.rules.success = vec![touch()];
        world
    });
    check("a clock", |ways, unit| {
        let mut world = rooms(ways);
        let clock = Door {
            opens_on: Vec::new(),
            period: Some(4.0 + 8.0 * unit(1)),
            ..Door::default()
        };
        world.objects = vec![door("a", [3.0, ways[1]], clock), goal([7.0, unit(2) * 5.0 - 2.5])];
        world.rules.success = vec![touch()];
        world
    });
}

#[test]
fn expert_opens_carries_and_delivers_as_rules_require() {
    check("opened", |ways, _| {
        let mut world = rooms(ways);
        world.objects = vec![door("a", [3.0, ways[1]], locked("red")), key("red", [0.0, -3.3])];
        world.rules.success = vec![EndCondition::Opened("a".to_owned())];
        world
    });
    check("carried, with its hands full of a key", |ways, unit| {
        let mut world = rooms(ways);
        let ball = |at: [f64; 2]| {
            let mut ball = thing("icosphere", "ball", at);
            (ball.scale, ball.portable) = (0.5, Some(Portable::default()));
            ball
        };
        world.objects = vec![
            door("a", [3.0, ways[1]], locked("red")),
            key("red", [unit(0) * 2.0 - 1.0, -3.3]),
            ball([6.0, unit(0) * 5.0 - 2.5]),
        ];
        world.rules.success = vec![EndCondition::Carried("ball".to_owned())];
        world
    });
    check("delivered", |ways, unit| {
        let mut world = rooms(ways);
        let mut first = key("ball", [-6.0, unit(0) * 5.0 - 2.5]);
        first.class = "pot".to_owned();
        let second = Object {
            coordinates: [unit(1) * 2.0 - 1.0, 3.0],
            ..first.clone()
        };
        world.objects = vec![
            door(
                "a",
                [3.0, ways[1]],
                Door {
                    closes_after: Some(3.0),
                    ..Door::default()
                },
            ),
            door("b", [-3.0, ways[0]], Door::default()),
            first,
            second,
            thing("cube", "box", [6.5, unit(2) * 4.0 - 2.0]),
        ];
        let (tag, to) = ("ball".to_owned(), "box".to_owned());
        world.rules.success = vec![EndCondition::Delivered(Delivery { tag, to, within: 2.0 })];
        world
    });
}

#[test]
fn expert_opens_doors_in_sequence_and_collects_rewards_first() {
    check("a sequence", |ways, _| {
        let mut world = rooms(ways);
        let mut red = door("red", [3.0, ways[1]], Door::default());
        let mut blue = door("blue", [-3.0, ways[0]], Door::default());
        (red.order, blue.order) = (Some(1), Some(2));
        world.objects = vec![blue, red];
        world.rules.success = vec![EndCondition::Opened("blue".to_owned())];
        world
    });
    check("coins behind a door", |ways, unit| {
        let mut world = rooms(ways);
        let coin = |at: [f64; 2]| {
            let mut coin = thing("geometric", "coin", at);
            (coin.scale, coin.reward, coin.destroy_stimulus) = (0.4, 1.0, vec![Stimulus::AgentCollide]);
            coin.reward_once_stimulus = vec![Stimulus::AgentCollide];
            coin
        };
        world.objects = vec![
            door("a", [3.0, ways[1]], locked("red")),
            key("red", [unit(0) * 2.0 - 1.0, -3.3]),
            coin([6.0, unit(0) * 5.0 - 2.5]),
            coin([0.0, 2.5]),
        ];
        world.rules.success = vec![EndCondition::AllCollected];
        world
    });
}

/// The world with a locked door in `docs/worlds.md` behaves as described there.
#[test]
fn world_in_the_docs_is_solved() {
    let page = include_str!("../../docs/worlds.md");
    let text = page.split("```").find_map(|part| part.strip_prefix("json\n"));
    let world = World::from_json("docs/worlds.md", text.expect("the page has a world")).expect("the world is valid");
    assert_eq!(world.remarks("docs/worlds.md", text.unwrap_or_default()), []);
    assert!(steps_to_success(&world).is_some_and(|steps| steps < 300));
}

/// The expert does not attempt the impossible: the agent stands still, and the episode ends at its limit.
#[test]
fn expert_stands_still_if_nothing_can_be_done() {
    let stands = |change: &dyn Fn(&mut WorldDraft)| {
        let mut world = rooms([0.0, 0.0]);
        world.max_steps = 200;
        world.objects = vec![
            door("a", [3.0, 0.0], locked("red")),
            key("red", [7.0, 2.0]),
            goal([7.0, -2.0]),
        ];
        // The other room is permanently shut.
        world.objects.push(door(
            "b",
            [-3.0, 0.0],
            Door {
                opens_on: Vec::new(),
                ..Door::default()
            },
        ));
        world.rules.success = vec![touch()];
        change(&mut world);
        let world = world.check().expect("the world is valid");
        let start = Environment::new(world.clone()).agent().position;
        let (environment, _) = by_expert(world, |_, step| assert!(step.events.is_empty(), "{:?}", step.events));
        assert_eq!((environment.agent().position, environment.num_steps()), (start, 200));
    };
    stands(&|_| {});
    let key_is_here = |world: &mut WorldDraft| world.objects[1].coordinates = [0.0, 3.0];
    stands(&|world| {
        key_is_here(world);
        world.agent_params.interact = false;
    });
    stands(&|world| {
        key_is_here(world);
        world.agent_params.carry_limit = 0;
    });
    stands(&|world| {
        key_is_here(world);
        world.agent_params.actions =
            ActionSpace::Discrete(vec![[3.0, 0.0, 0.0], [0.0, 90.0, 0.0], [0.0, -90.0, 0.0], [0.0; 3]]);
    });
    let closed_switch = |world: &mut WorldDraft| {
        let mut lever = thing("switch", "lever", [0.0, 2.0]);
        lever.switch = Some(Switch {
            action: SwitchAction::Close,
            ..Switch::of("a")
        });
        world.objects.push(lever);
    };
    stands(&closed_switch);
}

proptest! {
    #![proptest_config(ProptestConfig::with_cases(16))]

    #[test]
    fn world_on_rails_resumes_bit_for_bit(written_at in 0..250_u32, unit in 0.0..1.0_f64) {
        let mut world = rooms([unit * 3.0 - 1.5, 1.0 - unit]);
        world.agent_params.action_model = ActionModel::OnRails;
        world.agent_params.heading = unit * 300.0;
        let mut coin = goal([-7.0, unit * 4.0 - 2.0]);
        (coin.reward, coin.reward_once_stimulus) = (1.0, vec![Stimulus::AgentCollide]);
        let clock = Door { opens_on: Vec::new(), period: Some(5.0), ..Door::default() };
        world.objects = vec![
            door("a", [3.0, 1.0 - unit], locked("red")),
            door("b", [-3.0, unit * 3.0 - 1.5], clock),
            key("red", [unit * 2.0 - 1.0, -3.3]),
            coin,
            key("ball", [6.0, unit]),
        ];
        world.rules.success = vec![EndCondition::Carried("ball".to_owned())];
        let mut environment = Environment::new(world.check().expect("the world is valid"));
        let action = driftworld_env::Action::Continuous([0.0; 3]);
        let mut other = None;
        while !environment.ended() {
            if environment.num_steps() == written_at {
                let text = environment.state().to_json();
                other = Some(Environment::new(World::from_json("state", &text).expect("the world is valid")));
            }
            let step = environment.step(action).expect("the episode continues");
            if let Some(other) = &mut other {
                prop_assert_eq!(&other.step(action).expect("the episode continues"), &step);
                prop_assert_eq!(other.state().to_json(), environment.state().to_json());
            }
        }
        prop_assert!(environment.num_steps() < 3000, "the episode ends in success");
    }
}
