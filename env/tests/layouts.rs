//! Worlds with layouts behave like worlds with separate walls, and the expert finds its way through them.

use driftworld_env::{Action, Agent, Environment, OnRailsAgent, RandomAgent};
use driftworld_spec::{Layout, Maze, Object, Rooms, Stimulus, Wall, World, WorldDraft};
use proptest::prelude::*;

fn maze(cells: [u32; 2], cell: f64, braid: f64, seed: u64) -> Layout {
    Layout {
        maze: Some(Maze {
            cells,
            cell,
            braid,
            seed: Some(seed),
            ..Maze::default()
        }),
        ..Layout::default()
    }
}

fn rooms(grid: [u32; 2], room: [f64; 2], doorway: f64, loops: f64, seed: u64) -> Layout {
    Layout {
        rooms: Some(Rooms {
            grid,
            room,
            doorway,
            loops,
            seed: Some(seed),
            ..Rooms::default()
        }),
        ..Layout::default()
    }
}

fn layouts() -> impl Strategy<Value = Layout> {
    prop_oneof![
        (2_u32..9, 2_u32..9, 2.0..3.5, 0.0..=1.0, 0_u64..1 << 40).prop_map(|(columns, rows, cell, braid, seed)| maze(
            [columns, rows],
            cell,
            braid,
            seed
        )),
        (
            2_u32..4,
            2_u32..4,
            (4.0..9.0, 4.0..9.0),
            1.6..2.5,
            0.0..=1.0,
            0_u64..1 << 40
        )
            .prop_map(|(columns, rows, (width, depth), doorway, loops, seed)| {
                rooms([columns, rows], [width, depth], doorway, loops, seed)
            }),
    ]
}

/// A world with a layout: the agent starts in one of its cells, and a goal in another ends the episode.
fn world(layout: Layout, start: usize, goal: usize, change: impl FnOnce(&mut WorldDraft)) -> World {
    let plan = layout.plan(0);
    let cell = |number: usize| plan.cells[number % plan.cells.len()].center;
    let mut target = Object::new("geometric", cell(goal));
    (target.reward, target.scale) = (1.0, 0.4);
    target.reward_once_stimulus = vec![Stimulus::AgentCollide];
    target.destroy_stimulus = vec![Stimulus::AgentCollide];
    let mut world = WorldDraft::with_objects(vec![target]);
    world.environment_params.layout = Some(layout);
    world.agent_params.coordinates = cell(start);
    world.agent_params.observation_size = 24;
    change(&mut world);
    world.check().unwrap_or_else(|error| panic!("{error}"))
}

/// The world with its layout's walls as separate walls.
fn with_single_walls(world: &World) -> World {
    let plan = world.plan().expect("the world has a layout").clone();
    let walls = plan.walls.into_iter().map(|wall| Wall {
        polygon: wall.polygon,
        height: wall.height,
        color: wall.color,
    });
    let single = world.clone().edit(|world| {
        world.environment_params.layout = None;
        world.environment_params.map_size = plan.size;
        world.environment_params.walls = walls.collect();
    });
    single.unwrap_or_else(|error| panic!("{error}"))
}

/// All observations of an agent in a step.
fn observe_step(environment: &mut Environment, action: Action) -> (String, Vec<u8>, Vec<u32>) {
    let step = environment.step(action).expect("the action is valid");
    let said = format!("{:?} {} {}", environment.agent(), step.reward, step.terminated);
    let frame = environment.observe();
    let depth = frame.depth.iter().map(|metres| metres.to_bits()).collect();
    (said, frame.rgb.clone(), depth)
}

proptest! {
    #![proptest_config(ProptestConfig::with_cases(12))]

    #[test]
    fn layout_equals_its_separate_walls(layout in layouts(), start in 0_usize..99, goal in 0_usize..99, seed in 0_u64..99) {
        let whole = world(layout, start, goal, |_| {});
        let mut agents = [RandomAgent::new(0), RandomAgent::new(0)];
        let mut environments = [with_single_walls(&whole), whole].map(Environment::new);
        for agent in &mut agents {
            agent.begin(seed);
        }
        for _ in 0..40 {
            let [single, layout] = [0, 1].map(|k| {
                let action = agents[k].act(&environments[k]);
                observe_step(&mut environments[k], action)
            });
            prop_assert!(single == layout, "{} {}", single.0, layout.0);
        }
    }

    #[test]
    fn saved_world_resumes_in_its_layout(layout in layouts(), start in 0_usize..99, seed in 0_u64..99) {
        // The layout uses the world's own seed.
        let mut layout = layout;
        let seeds = [
            layout.maze.as_mut().map(|maze| &mut maze.seed),
            layout.rooms.as_mut().map(|rooms| &mut rooms.seed),
        ];
        for seed in seeds.into_iter().flatten() {
            *seed = None;
        }
        let mut environment = Environment::new(world(layout, start, 0, |world| world.seed = Some(0)));
        let mut agent = RandomAgent::new(0);
        agent.begin(seed);
        for _ in 0..15 {
            let action = agent.act(&environment);
            observe_step(&mut environment, action);
        }
        let text = environment.state().to_json();
        let mut again = Environment::new(World::from_json("state.json", &text).unwrap());
        prop_assert_eq!(again.world().plan(), environment.world().plan());
        for _ in 0..15 {
            let action = agent.act(&environment);
            prop_assert!(observe_step(&mut again, action) == observe_step(&mut environment, action));
        }
    }

    #[test]
    fn agent_is_never_inside_a_wall(layout in layouts(), start in 0_usize..99, seed in 0_u64..99) {
        let world = world(layout, start, 0, |world| world.objects.clear());
        let radius = (world.agent_params.agent_width / 2.0) as f32;
        let walls: Vec<Vec<[f64; 2]>> = world.obstacles().map(<[_]>::to_vec).collect();
        let mut environment = Environment::new(world);
        let mut agent = RandomAgent::new(0);
        agent.begin(seed);
        for _ in 0..80 {
            let action = agent.act(&environment);
            observe_step(&mut environment, action);
            let at = environment.agent().position;
            for wall in &walls {
                let beyond = [0, 1].map(|axis| {
                    let side = |sign: f64| wall.iter().map(|corner| corner[axis] * sign).fold(f64::NEG_INFINITY, f64::max);
                    (f64::from(at[axis]) - side(1.0)).max(-side(-1.0) - f64::from(at[axis])).max(0.0) as f32
                });
                let distance = (beyond[0] * beyond[0] + beyond[1] * beyond[1]).sqrt();
                prop_assert!(distance > radius - 0.01, "{} m from {:?} at {:?}", distance, wall, at);
            }
        }
    }
}

/// Whether the expert collects the goal within 1500 steps.
fn expert_arrives(world: World) -> bool {
    let mut environment = Environment::new(world);
    let mut agent = OnRailsAgent::new();
    agent.begin(0);
    for _ in 0..1500 {
        let action = agent.act(&environment);
        environment.step(action).expect("the action is valid");
        if !environment.objects()[0].present {
            return true;
        }
    }
    false
}

proptest! {
    #![proptest_config(ProptestConfig::with_cases(crate::tier::quick_or_full(24, 30)))]

    #[test]
    fn expert_finds_the_goal(layout in layouts(), start in 0_usize..99, goal in 0_usize..99) {
        let arrives = expert_arrives(world(layout, start, goal, |_| {}));
        prop_assert!(arrives);
    }

    #[test]
    fn expert_walks_through_a_maze_of_narrow_cells(
        side in 2_u32..13, braid in 0.0..=1.0, seed in 0_u64..1 << 40, start in 0_usize..999, goal in 0_usize..999,
    ) {
        let arrives = expert_arrives(world(maze([side, side], 2.0, braid, seed), start, goal, |_| {}));
        prop_assert!(arrives);
    }
}

#[test]
fn layout_walls_hide_objects_behind_them() {
    let layout = |standing| {
        let text = ["*****", "*.*.*", "*****"].map(str::to_owned).to_vec();
        Layout {
            text: Some(text),
            cell: Some(4.0),
            standing,
            ..Layout::default()
        }
    };
    let seen = |standing| {
        let mut environment = Environment::new(world(layout(standing), 0, 0, |world| {
            (world.objects[0].coordinates, world.objects[0].scale) = ([4.0, 0.0], 2.0);
            (world.agent_params.coordinates, world.agent_params.heading) = ([-4.0, 0.0], 90.0);
            world.agent_params.modalities = vec![driftworld_spec::Modality::Rgb, driftworld_spec::Modality::Instance];
        }));
        environment.observe().instance.contains(&1)
    };
    assert!(seen(0.0) && !seen(1.0));
}
