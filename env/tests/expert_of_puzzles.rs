//! The expert in puzzles in which a step can be an irreversible mistake, because keys open only one door. The test determines
//! by exhaustive search whether a puzzle is solvable.

use driftworld_env::{EndedBy, Environment};
use driftworld_spec::{Delivery, Door, EndCondition, Object, Portable, Stimulus, World, WorldDraft, Zone, ZoneEnd};
use proptest::prelude::*;

use crate::fixtures::{by_expert, wall_of};

/// Side of a room in metres.
const ROOM: f64 = 4.0;

/// A puzzle of 2 × 3 rooms: between neighbours a wall, an open doorway, or a door with a lock.
#[derive(Clone, Debug)]
struct Puzzle {
    /// Between rooms 0 and 1, 2 and 3, 4 and 5, then between 0 and 2, 1 and 3, 2 and 4, 3 and 5.
    between: [Between; 7],
    /// Room and lock of each key.
    keys: Vec<(usize, u8)>,
    /// Whether a key is gone once it has opened a door.
    consumed: bool,
    goal: usize,
}

#[derive(Clone, Copy, Debug, PartialEq)]
enum Between {
    Wall,
    Gap,
    Lock(u8),
}

const NEIGHBOURS: [[usize; 2]; 7] = [[0, 1], [2, 3], [4, 5], [0, 2], [1, 3], [2, 4], [3, 5]];

impl Puzzle {
    /// Whether the goal can be reached from room 0, by exhaustive search over doors and keys.
    fn can_be_solved(&self) -> bool {
        self.is_solvable_from([false; 7], &vec![false; self.keys.len()])
    }

    fn is_solvable_from(&self, opened: [bool; 7], used: &[bool]) -> bool {
        let mut reached = [false; 6];
        reached[0] = true;
        for _ in 0..6 {
            for (number, [a, b]) in NEIGHBOURS.into_iter().enumerate() {
                if (self.between[number] == Between::Gap || opened[number]) && (reached[a] || reached[b]) {
                    (reached[a], reached[b]) = (true, true);
                }
            }
        }
        if reached[self.goal] {
            return true;
        }
        (0..7).any(|number| {
            let Between::Lock(lock) = self.between[number] else {
                return false;
            };
            let [a, b] = NEIGHBOURS[number];
            if opened[number] || !(reached[a] || reached[b]) {
                return false;
            }
            let fits = |key: &usize| self.keys[*key].1 == lock && !used[*key] && reached[self.keys[*key].0];
            (0..self.keys.len()).filter(fits).any(|key| {
                let (mut opened, mut used) = (opened, used.to_vec());
                opened[number] = true;
                used[key] = self.consumed;
                self.is_solvable_from(opened, &used)
            })
        })
    }

    fn world(&self, order: &[usize]) -> World {
        let mut world = WorldDraft {
            max_steps: 4000,
            ..WorldDraft::default()
        };
        world.environment_params.map_size = [2.0 * ROOM, 3.0 * ROOM];
        world.agent_params.agent_width = 0.6;
        world.agent_params.max_linear_speed = 3.0;
        world.agent_params.carry_limit = 1;
        world.agent_params.coordinates = middle(0);
        world.rules.success = vec![EndCondition::Touch("goal".to_owned())];
        let mut objects = vec![thing("barrel", "goal", middle(self.goal), [0.0, 0.5])];
        for (number, [a, b]) in NEIGHBOURS.into_iter().enumerate() {
            let ([ax, ay], [bx, by]) = (middle(a), middle(b));
            let (at, is_upright) = ([f64::midpoint(ax, bx), f64::midpoint(ay, by)], ay == by);
            let wall = |from: f64, to: f64| {
                let half = 0.1;
                let corners = [[from, -half], [to, -half], [to, half], [from, half]];
                let turned = corners.map(|[along, across]| {
                    let [dx, dy] = if is_upright { [-across, along] } else { [along, across] };
                    [at[0] + dx, at[1] + dy]
                });
                wall_of(turned)
            };
            let walls = &mut world.environment_params.walls;
            match self.between[number] {
                Between::Wall => walls.push(wall(-ROOM / 2.0, ROOM / 2.0)),
                _ => walls.extend([wall(-ROOM / 2.0, -0.6), wall(0.6, ROOM / 2.0)]),
            }
            if let Between::Lock(lock) = self.between[number] {
                let mut door = thing("door", "door", at, [0.0; 2]);
                (door.scale, door.heading) = (1.2, if is_upright { 90.0 } else { 0.0 });
                door.door = Some(Door {
                    key: Some(format!("key {lock}")),
                    ..Door::default()
                });
                objects.push(door);
            }
        }
        for (number, (room, lock)) in self.keys.iter().enumerate() {
            let aside = [[-1.0, -0.8], [1.0, -0.8], [-1.0, 0.2], [1.0, 0.2]][number % 4];
            let mut key = thing("key", &format!("key {lock}"), middle(*room), aside);
            key.solid = false;
            key.portable = Some(Portable {
                consumed: self.consumed,
                ..Portable::default()
            });
            objects.push(key);
        }
        let mut numbers: Vec<usize> = (0..objects.len()).collect();
        numbers.sort_by_key(|number| (order.get(*number).copied().unwrap_or(*number), *number));
        world.objects = numbers.into_iter().map(|number| objects[number].clone()).collect();
        world.check().expect("the world is valid")
    }
}

fn middle(room: usize) -> [f64; 2] {
    [((room % 2) as f64 - 0.5) * ROOM, ((room / 2) as f64 - 1.0) * ROOM]
}

fn thing(class: &str, tag: &str, [x, y]: [f64; 2], [dx, dy]: [f64; 2]) -> Object {
    let mut object = Object::new(class, [x + dx, y + dy]);
    object.tag = Some(tag.to_owned());
    object
}

/// Runs an episode and returns whether it was a success. Checks the carry limit.
fn succeeds(world: World) -> bool {
    let most = world.agent_params.carry_limit as usize;
    let (_, last) = by_expert(world, |environment, _| {
        assert!(environment.objects().iter().filter(|own| own.carried).count() <= most);
    });
    last.success
}

fn puzzle() -> impl Strategy<Value = Puzzle> {
    let between = prop_oneof![
        2 => Just(Between::Wall),
        1 => Just(Between::Gap),
        4 => (0..2_u8).prop_map(Between::Lock),
    ];
    (
        prop::array::uniform7(between),
        prop::collection::vec((0..6_usize, 0..2_u8), 1..5),
        any::<bool>(),
        1..6_usize,
    )
        .prop_map(|(between, keys, consumed, goal)| Puzzle {
            between,
            keys,
            consumed,
            goal,
        })
}

/// The return and the cause of the end of an episode in which the agent carries a ball through a ford in lava to a box. The
/// lava ends the episode, or costs 20 on entering and 1 per second.
fn carried_past_lava([ford, key_x, thickness]: [f64; 3], fails: bool, is_discrete: bool) -> (f64, Option<EndedBy>) {
    let mut world = hall();
    world.agent_params.coordinates = [-key_x, -5.0];
    if is_discrete {
        world.agent_params.actions = driftworld_spec::ActionSpace::DefaultDiscrete;
    }
    for [from, to] in [[-6.0, ford - 0.9], [ford + 0.9, 6.0]] {
        let mut lava = Zone::polygon(vec![
            [from, -1.0],
            [to, -1.0],
            [to, thickness - 1.0],
            [from, thickness - 1.0],
        ]);
        if fails {
            lava.ends = Some(ZoneEnd::Failure);
        } else {
            (lava.reward_per_second, lava.reward_on_entering) = (-1.0, -20.0);
        }
        world.environment_params.zones.push(lava);
    }
    let mut key = thing("key", "ball", [key_x, 4.5], [0.0; 2]);
    key.portable = Some(Portable::default());
    world.agent_params.carry_limit = 1;
    world.objects = vec![key, thing("barrel", "box", [0.0, -4.0], [0.0; 2])];
    let (tag, to) = ("ball".to_owned(), "box".to_owned());
    world.rules.success = vec![EndCondition::Delivered(Delivery { tag, to, within: 2.0 })];
    let mut paid = 0.0;
    let (_, last) = by_expert(world.check().expect("the world is valid"), |_, step| {
        paid += step.reward;
    });
    (paid, last.ended_by)
}

proptest! {
    #![proptest_config(ProptestConfig { cases: crate::tier::quick_or_full(24, 48), max_global_rejects: 4000, ..ProptestConfig::default() })]

    /// Holds for every order of the list of objects.
    #[test]
    fn solvable_puzzles_are_solved(
        puzzle in puzzle().prop_filter("solvable", Puzzle::can_be_solved),
        order in prop::collection::vec(0..100_usize, 12),
    ) {
        prop_assert!(succeeds(puzzle.world(&order)));
    }
}

/// Some of these puzzles require search: opening the first door that can be opened makes them unsolvable.
#[test]
fn key_is_not_used_on_the_wrong_door() {
    // The key in room 0 opens the doors to rooms 1 and 2; the goal is behind one of them.
    for goal in [1, 2] {
        let mut between = [Between::Wall; 7];
        (between[0], between[3]) = (Between::Lock(0), Between::Lock(0));
        let puzzle = Puzzle {
            between,
            keys: vec![(0, 0)],
            consumed: true,
            goal,
        };
        assert!(puzzle.can_be_solved() && succeeds(puzzle.world(&[])), "{goal}");
        // A reward behind the other door is worth less than the success.
        let coin_too = puzzle.world(&[]).edit(|world| {
            let mut coin = thing("geometric", "coin", middle(3 - goal), [0.0, 0.5]);
            (coin.reward, coin.reward_once_stimulus) = (1.0, vec![Stimulus::AgentCollide]);
            world.objects.insert(0, coin);
        });
        assert!(succeeds(coin_too.expect("the world is valid")), "{goal}");
        // With two keys, the second of which is behind a door, that door must be opened first.
        let more = Puzzle {
            keys: vec![(0, 0), (3 - goal, 0)],
            ..puzzle
        };
        assert!(more.can_be_solved() && succeeds(more.world(&[])), "{goal}");
    }
}

/// A room of 12 × 12 m without walls.
fn hall() -> WorldDraft {
    let mut world = WorldDraft {
        max_steps: 3000,
        ..WorldDraft::default()
    };
    world.environment_params.map_size = [12.0, 12.0];
    (world.agent_params.agent_width, world.agent_params.max_linear_speed) = (0.8, 3.0);
    world
}

proptest! {
    #![proptest_config(ProptestConfig::with_cases(24))]

    /// An agent that can carry several objects collects them before it goes to the box, so that it goes there only once.
    #[test]
    fn things_are_collected_before_delivery(
        places in prop::collection::vec(prop::array::uniform2(-5.0..5.0_f64), 2..5),
        hands in 1..5_u32,
    ) {
        let mut world = hall();
        world.agent_params.carry_limit = hands;
        world.agent_params.coordinates = [-5.0, 5.0];
        let far = |[x, y]: &[f64; 2]| x + y < 2.0;
        let places: Vec<[f64; 2]> = places.into_iter().filter(far).collect();
        prop_assume!(places.len() > 1);
        for place in &places {
            let mut ball = thing("geometric", "ball", *place, [0.0; 2]);
            (ball.scale, ball.solid, ball.portable) = (0.4, false, Some(Portable::default()));
            world.objects.push(ball);
        }
        world.objects.push(thing("barrel", "box", [4.0, 4.0], [0.0; 2]));
        let (tag, to) = ("ball".to_owned(), "box".to_owned());
        world.rules.success = vec![EndCondition::Delivered(Delivery { tag, to, within: 3.0 })];
        let (mut carried, mut most, mut trips) = (0_usize, 0, 0);
        let (_, last) = by_expert(world.check().expect("the world is valid"), |environment, _| {
            let now = environment.objects().iter().filter(|own| own.carried).count();
            trips += usize::from(carried > 0 && now == 0);
            (carried, most) = (now, most.max(now));
        });
        prop_assert!(last.success, "{:?}", places);
        prop_assert!(most <= hands as usize);
        if hands as usize >= places.len() {
            prop_assert_eq!((most, trips), (places.len(), 1));
        }
    }

    /// Lava with a ford lies between the agent and its ball, and again in front of the box: it is never entered, whether it
    /// ends the episode or costs, even with the steps of an action table.
    #[test]
    fn plans_avoid_zones_that_fail_or_cost(
        ford in -4.0..4.0_f64,
        key_x in -5.0..5.0_f64,
        thickness in 0.1..1.5_f64,
        fails in any::<bool>(),
        is_discrete in any::<bool>(),
    ) {
        let result = carried_past_lava([ford, key_x, thickness], fails, is_discrete);
        prop_assert_eq!(result, (0.0, Some(EndedBy::Delivered)), "no zone was entered");
    }

    /// If the only path leads through a zone that costs, it is taken; through one that fails, never.
    #[test]
    fn plans_cross_costly_zones_only_if_there_is_no_other_path(
        key_x in -5.0..5.0_f64,
        thickness in 0.1..3.0_f64,
        is_discrete in any::<bool>(),
    ) {
        let (paid, ended_by) = carried_past_lava([100.0, key_x, thickness], false, is_discrete);
        prop_assert!(ended_by == Some(EndedBy::Delivered) && paid <= -40.0, "{:?} {}", ended_by, paid);
        let result = carried_past_lava([100.0, key_x, thickness], true, is_discrete);
        prop_assert_eq!(result, (0.0, Some(EndedBy::Steps)), "an enclosed agent does not cross the lava");
    }

    /// If the only goal is a zone behind a door, the expert goes there and stays.
    #[test]
    fn zone_behind_a_locked_door_is_reached(x in -5.0..5.0_f64, ends in any::<bool>()) {
        let mut between = [Between::Wall; 7];
        between[3] = Between::Lock(0);
        let puzzle = Puzzle { between, keys: vec![(0, 0)], consumed: true, goal: 5 };
        let world = puzzle.world(&[]).edit(|world| {
            let [east, north] = middle(2);
            let mut zone = Zone::disc([east + x / 10.0, north], 0.8);
            zone.reward_per_second = 1.0;
            zone.ends = ends.then_some(ZoneEnd::Success);
            world.environment_params.zones.push(zone);
            world.max_steps = 400;
        });
        let (environment, last) = by_expert(world.expect("the world is valid"), |_, _| ());
        prop_assert!(!ends || last.success);
        prop_assert!(ends || environment.episode_return() > 15.0, "{}", environment.episode_return());
    }
}

/// A world that was saved in the middle of a plan resumes bit for bit: with a key carried, a door open, and half the energy.
#[test]
fn saved_plan_resumes_bit_for_bit() {
    let mut between = [Between::Wall; 7];
    (between[0], between[3], between[1]) = (Between::Lock(0), Between::Lock(0), Between::Lock(1));
    let puzzle = Puzzle {
        between,
        keys: vec![(0, 0), (2, 1), (0, 0)],
        consumed: true,
        goal: 3,
    };
    let world = puzzle.world(&[]).edit(|world| {
        world.agent_params.action_model = driftworld_spec::ActionModel::OnRails;
        world.agent_params.energy = Some(driftworld_spec::Energy {
            start: 50.0,
            per_second: -0.5,
            ..driftworld_spec::Energy::default()
        });
        let mut mud = Zone::disc(middle(2), 0.5);
        mud.reward_per_second = -3.0;
        world.environment_params.zones.push(mud);
        let mut coin = thing("geometric", "coin", middle(1), [0.0; 2]);
        (coin.reward, coin.reward_once_stimulus) = (1.0, vec![Stimulus::AgentCollide]);
        world.objects.push(coin);
    });
    let world = world.expect("the world is valid");
    let action = driftworld_env::Action::Continuous([0.0; 3]);
    let mut length = 400;
    let mut written_at = 0;
    while written_at < length {
        let mut environment = Environment::new(world.clone());
        let mut other: Option<Environment> = None;
        while !environment.ended() {
            if environment.num_steps() == written_at {
                let text = environment.state().to_json();
                other = Some(Environment::new(
                    World::from_json("state", &text).expect("the world is valid"),
                ));
            }
            let step = environment.step(action).expect("the episode continues");
            if let Some(other) = &mut other {
                assert_eq!(
                    other.step(action).expect("the episode continues"),
                    step,
                    "written at {written_at}"
                );
            }
        }
        assert!(environment.num_steps() < 4000, "the episode ends in success");
        if let Some(other) = other {
            assert_eq!(other.state().to_json(), environment.state().to_json());
        }
        length = environment.num_steps();
        written_at += 7;
    }
}
