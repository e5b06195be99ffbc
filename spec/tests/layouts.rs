//! Properties of plans, tested on random layouts. Invalid layouts are tested in `codes.rs`.

use std::collections::BTreeMap;

use driftworld_spec::{Layout, Legend, Maze, Plan, Rooms, World};
use proptest::prelude::*;

fn maze(maze: Maze, standing: f64) -> Layout {
    Layout {
        maze: Some(maze),
        standing,
        ..Layout::default()
    }
}

fn mazes() -> impl Strategy<Value = Maze> {
    let sides = (1_u32..12, 1_u32..12, 1.0..4.0, 0.05..0.9);
    (sides, 0.0..=1.0, 0_u64..1 << 53).prop_map(|((columns, rows, cell, wall), braid, seed)| Maze {
        cells: [columns, rows],
        cell,
        wall: wall * cell,
        height: None,
        braid,
        seed: Some(seed),
    })
}

fn rooms() -> impl Strategy<Value = Rooms> {
    let sides = (1_u32..5, 1_u32..5, 2.0..12.0, 2.0..12.0);
    (sides, 0.4..1.6, 0.05..0.4, 0.0..=1.0, 0_u64..1 << 53).prop_map(
        |((columns, rows, width, depth), doorway, wall, loops, seed)| Rooms {
            grid: [columns, rows],
            room: [width, depth],
            doorway,
            wall,
            loops,
            seed: Some(seed),
            ..Rooms::default()
        },
    )
}

/// A text of walls, floor and doorways inside a border of walls.
fn texts() -> impl Strategy<Value = Layout> {
    (1_usize..8, 1_usize..8).prop_flat_map(|(columns, rows)| {
        let letters = prop::sample::select(vec!['#', '*', ' ', '.', 'A', 'D', 'G']);
        prop::collection::vec(letters, columns * rows).prop_map(move |letters| {
            let border = "#".repeat(columns + 2);
            let inner = letters
                .chunks(columns)
                .map(|row| format!("#{}#", row.iter().collect::<String>()));
            Layout {
                text: Some(
                    std::iter::once(border.clone())
                        .chain(inner)
                        .chain([border.clone()])
                        .collect(),
                ),
                cell: Some(1.5),
                legend: BTreeMap::from([("G".to_owned(), Legend::Group("goal".to_owned()))]),
                ..Layout::default()
            }
        })
    })
}

fn layouts() -> impl Strategy<Value = Layout> {
    let drawn = prop_oneof![
        mazes().prop_map(|drawn| maze(drawn, 1.0)),
        rooms().prop_map(|rooms| Layout {
            rooms: Some(rooms),
            ..Layout::default()
        }),
        texts(),
    ];
    (drawn, 0.0..=1.0).prop_map(|(layout, standing)| Layout { standing, ..layout })
}

/// The number of pairs of neighbouring cells that are connected.
fn open_sides(plan: &Plan) -> usize {
    plan.cells.iter().map(|cell| cell.open_sides() as usize).sum::<usize>() / 2
}

/// Whether a convex, counterclockwise polygon contains a point, including its border.
fn contains(corners: &[[f64; 2]], point: [f64; 2]) -> bool {
    (0..corners.len()).all(|k| {
        let (a, b) = (corners[k], corners[(k + 1) % corners.len()]);
        (b[0] - a[0]) * (point[1] - a[1]) - (b[1] - a[1]) * (point[0] - a[0]) >= -1e-9
    })
}

/// Distance of a point to an axis-aligned rectangle, 0 inside.
fn distance(corners: &[[f64; 2]], point: [f64; 2]) -> f64 {
    let along = [0, 1].map(|axis| {
        let low = corners.iter().map(|corner| corner[axis]).fold(f64::INFINITY, f64::min);
        let high = corners
            .iter()
            .map(|corner| corner[axis])
            .fold(f64::NEG_INFINITY, f64::max);
        (low - point[axis]).max(point[axis] - high).max(0.0)
    });
    (along[0] * along[0] + along[1] * along[1]).sqrt()
}

fn is_in_a_wall(plan: &Plan, point: [f64; 2]) -> bool {
    plan.walls.iter().any(|wall| contains(&wall.polygon, point))
}

proptest! {
    #![proptest_config(ProptestConfig::with_cases(crate::tier::quick_or_full(24, 256)))]

    #[test]
    fn plan_depends_only_on_the_layouts_own_seed(layout in layouts(), other in 0_u64..9) {
        let plan = layout.plan(other);
        prop_assert_eq!(&plan, &layout.plan(other));
        prop_assert_eq!(&plan, &layout.plan(other + 1));
        prop_assert_eq!(Some(plan.size), layout.size());
    }

    #[test]
    fn every_cell_of_mazes_and_rooms_can_be_reached(layout in layouts()) {
        let plan = layout.plan(0);
        if layout.text.is_none() {
            prop_assert_eq!(plan.num_cut_off_cells(), 0);
            prop_assert!(plan.walking_distances(0).iter().all(|metres| metres.is_finite()));
        }
    }

    #[test]
    fn perfect_maze_has_one_path_between_any_two_cells(drawn in mazes()) {
        let plan = maze(Maze { braid: 0.0, ..drawn }, 1.0).plan(0);
        prop_assert_eq!(open_sides(&plan), plan.cells.len() - 1);
        prop_assert_eq!(plan.num_cut_off_cells(), 0);
    }

    #[test]
    fn fully_braided_maze_has_no_dead_end(drawn in mazes()) {
        let wide = drawn.cells.iter().all(|count| *count > 1);
        let plan = maze(Maze { braid: 1.0, ..drawn }, 1.0).plan(0);
        prop_assert!(!wide || plan.cells.iter().all(|cell| cell.open_sides() >= 2));
    }

    #[test]
    fn more_braid_opens_more_sides(drawn in mazes(), less in 0.0..=1.0) {
        let of = |braid| maze(Maze { braid, ..drawn.clone() }, 1.0).plan(0);
        let (fewer, more) = (of(less * drawn.braid), of(drawn.braid));
        for (fewer, more) in fewer.cells.iter().zip(&more.cells) {
            prop_assert_eq!(fewer.sides & more.sides, fewer.sides);
        }
    }

    #[test]
    fn walls_of_a_smaller_share_are_a_subset(layout in layouts(), share in 0.0..=1.0) {
        let [fewer, more] = [share * layout.standing, layout.standing]
            .map(|standing| Layout { standing, ..layout.clone() }.plan(0));
        // Checks the middle of each wall, and a grid of points.
        for wall in &fewer.walls {
            let middle = [0, 1].map(|axis| wall.polygon.iter().map(|corner| corner[axis]).sum::<f64>() / 4.0);
            prop_assert!(is_in_a_wall(&more, middle), "{middle:?}");
        }
        for x in 0..40 {
            for y in 0..40 {
                let point = [0, 1].map(|axis| (f64::from([x, y][axis]) / 40.0 + 0.0113 - 0.5) * fewer.size[axis]);
                prop_assert!(!is_in_a_wall(&fewer, point) || is_in_a_wall(&more, point));
            }
        }
        let none = Layout { standing: 0.0, ..layout.clone() }.plan(0);
        prop_assert!(layout.text.is_some() || none.walls.is_empty());
    }

    #[test]
    fn cells_are_in_free_space_with_half_a_corridor_around_them(layout in layouts()) {
        let plan = layout.plan(0);
        let wall = layout.maze.as_ref().map_or(0.0, |maze| maze.wall)
            .max(layout.rooms.as_ref().map_or(0.0, |rooms| rooms.wall));
        let half = (plan.cell[0].min(plan.cell[1]) - wall) / 2.0;
        for cell in &plan.cells {
            for axis in [0, 1] {
                prop_assert!(cell.center[axis].abs() + plan.cell[axis] / 2.0 <= plan.size[axis] / 2.0 + 1e-9);
            }
            for wall in &plan.walls {
                prop_assert!(distance(&wall.polygon, cell.center) >= half - 1e-9);
            }
        }
    }

    #[test]
    fn walls_stand_exactly_between_closed_cells(layout in layouts()) {
        let plan = layout.plan(0);
        for (number, cell) in plan.cells.iter().enumerate() {
            let open: Vec<usize> = plan.neighbours(number).collect();
            for (other, other_cell) in plan.cells.iter().enumerate() {
                let offset = [0, 1].map(|axis| (cell.center[axis] - other_cell.center[axis]).abs() / plan.cell[axis]);
                if (offset[0] + offset[1] - 1.0).abs() > 1e-6 || offset[0].min(offset[1]) > 1e-6 {
                    continue;
                }
                let middle = [0, 1].map(|axis| f64::midpoint(cell.center[axis], other_cell.center[axis]));
                let doorway = plan.doorways.iter().find(|doorway| distance(&[middle], doorway.center) < plan.cell[0].max(plan.cell[1]));
                if doorway.is_none() {
                    prop_assert_eq!(open.contains(&other), !is_in_a_wall(&plan, middle));
                }
                prop_assert!(plan.neighbours(other).any(|next| next == number) == open.contains(&other));
            }
        }
    }

    #[test]
    fn no_wall_crosses_a_doorway_and_all_rooms_are_connected(rooms in rooms()) {
        let layout = Layout { rooms: Some(rooms.clone()), ..Layout::default() };
        prop_assume!(rooms.doorway + rooms.wall <= rooms.room[0].min(rooms.room[1]));
        let plan = layout.plan(0);
        for doorway in &plan.doorways {
            let along = usize::from(doorway.heading != 0.0);
            for share in [-0.499, -0.25, 0.0, 0.25, 0.499] {
                let mut point = doorway.center;
                point[along] += share * doorway.width;
                prop_assert!(!is_in_a_wall(&plan, point), "{doorway:?} at {point:?}");
            }
            prop_assert!(doorway.rooms[0] < doorway.rooms[1]);
        }
        let [columns, rows] = rooms.grid.map(|count| count as usize);
        let pairs: std::collections::BTreeSet<[u32; 2]> = plan.doorways.iter().map(|doorway| doorway.rooms).collect();
        prop_assert_eq!(pairs.len(), plan.doorways.len());
        let walls = (columns - 1) * rows + columns * (rows - 1);
        prop_assert!((columns * rows - 1..=walls).contains(&plan.doorways.len()));
        if rooms.loops == 1.0 {
            prop_assert_eq!(plan.doorways.len(), walls);
        }
        prop_assert_eq!(plan.cells.iter().map(|cell| cell.room as usize + 1).max(), Some(columns * rows));
    }

    #[test]
    fn text_layout_keeps_its_letters_in_place(layout in texts()) {
        let plan = layout.plan(0);
        let rows: Vec<Vec<char>> = layout.text.iter().flatten().map(|row| row.chars().collect()).collect();
        for (number, row) in rows.iter().enumerate() {
            for (column, letter) in row.iter().enumerate() {
                let x = (column as f64 + 0.5) * 1.5 - plan.size[0] / 2.0;
                let y = plan.size[1] / 2.0 - (number as f64 + 0.5) * 1.5;
                let cell = plan.cell_at([x, y]);
                let is_wall = matches!(letter, '#' | '*');
                prop_assert_eq!(cell.is_none(), is_wall);
                prop_assert_eq!(is_in_a_wall(&plan, [x, y]), is_wall);
                let own = (!matches!(letter, '.' | ' ')).then_some(*letter);
                prop_assert!(cell.is_none_or(|cell| plan.cells[cell].letter == own));
            }
        }
    }
}

fn world(layout: &str) -> World {
    let text = format!(r#"{{ "environment_params": {{ "layout": {layout} }} }}"#);
    World::from_json("w.json", &text).unwrap_or_else(|error| panic!("{error}"))
}

#[test]
fn maps_of_minigrid_and_deepmind_lab_are_read() {
    let grid = world(
        &serde_json::json!({
            "text": ["#######", "#A..#.#", "#...D.#", "#...#G#", "#######"],
            "cell": 1,
            "legend": { "G": { "group": "goal" } },
        })
        .to_string(),
    );
    let plan = grid.plan().expect("the world has a layout");
    assert_eq!((plan.size, plan.cells.len(), plan.doorways.len()), ([7.0, 5.0], 13, 1));
    let doorway = plan.doorways[0];
    assert_eq!(
        (doorway.center, doorway.heading, doorway.rooms),
        ([1.0, 0.0], 90.0, [0, 1])
    );
    let goal = plan
        .cells
        .iter()
        .find(|cell| cell.letter == Some('G'))
        .expect("the text has a goal");
    assert_eq!((goal.center, goal.room, goal.open_sides()), ([2.0, -1.0], 1, 1));

    let lab = world(
        r#"{ "text": ["*********", "*  P*   *", "* * I G *", "*  A*   *", "*********"],
             "legend": { "A": { "group": "apples" }, "G": { "group": "goal" }, "I": "doorway" } }"#,
    );
    let plan = lab.plan().expect("the world has a layout");
    assert_eq!((plan.num_cut_off_cells(), plan.doorways.len()), (0, 1));
    let layout = lab.environment_params.layout.as_ref().expect("the world has a layout");
    assert_eq!(
        (layout.meaning('P'), layout.meaning('I')),
        (Some(Legend::Start), Some(Legend::Doorway))
    );
}

#[test]
fn predefined_layout_is_the_map_with_its_number() {
    let layout = world(r#"{ "predefined": 2 }"#);
    let map =
        World::from_json("w.json", r#"{ "environment_params": { "predefined_map": 2 } }"#).expect("the world is valid");
    let shapes = |world: &World| {
        let corners: Vec<Vec<[f64; 2]>> = world.obstacles().map(<[_]>::to_vec).collect();
        (corners, world.environment_params.arena_size())
    };
    assert_eq!(shapes(&layout), shapes(&map));
    let small = world(r#"{ "predefined": 2, "size": [100, 50] }"#);
    let ((large, _), (corners, size)) = (shapes(&map), shapes(&small));
    assert_eq!((size, corners.len()), ([100.0, 50.0], large.len()));
    for (small, large) in corners.iter().flatten().zip(large.iter().flatten()) {
        assert_eq!(*small, [large[0] / 2.0, large[1] / 4.0]);
    }
    let half = world(r#"{ "predefined": 2, "standing": 0.5 }"#);
    assert_eq!(shapes(&half).0, large[..large.len() / 2]);
}

#[test]
fn layout_without_a_seed_uses_the_worlds_seed() {
    let of = |seed: &str, own: &str| {
        let text =
            format!(r#"{{ {seed} "environment_params": {{ "layout": {{ "maze": {{ "cells": [6, 6]{own} }} }} }} }}"#);
        let world = World::from_json("w.json", &text).unwrap_or_else(|error| panic!("{error}"));
        world.plan().expect("the world has a layout").clone()
    };
    assert_eq!(of(r#""seed": 5,"#, ""), of("", r#", "seed": 5"#));
    assert_eq!(of(r#""seed": 7,"#, r#", "seed": 5"#), of("", r#", "seed": 5"#));
    assert_ne!(of(r#""seed": 5,"#, "").cells, of(r#""seed": 6,"#, "").cells);
}

#[test]
fn unreachable_cells_get_a_remark() {
    let text = "{ \"environment_params\": {\n \"layout\": { \"text\": [\"#####\", \"#.#.#\", \"#####\"] } } }";
    let remarks = World::from_json("w.json", text)
        .expect("the world is valid")
        .remarks("w.json", text);
    assert_eq!(
        remarks.iter().map(ToString::to_string).collect::<Vec<_>>(),
        [
            "w.json:1:1 (/agent_params/coordinates): the agent starts inside wall 3 of 5 of the layout",
            "w.json:2:12 (/environment_params/layout): 1 of 2 free cells cannot be reached from the others; open a way to them, or turn them into walls"
        ]
    );
}

#[test]
fn overlapping_walls_are_allowed() {
    let crossed = world(
        r#"{ "walls": [{ "from": [-3, 0], "to": [3, 0] }, { "from": [0, -3], "to": [0, 3], "thickness": 1, "height": 1 },
             { "circle": { "center": [0, 0], "radius": 2 } }, { "polygon": [[5, 5], [6, 5], [5, 6]], "color": "red" }] }"#,
    );
    let plan = crossed.plan().expect("the world has a layout");
    assert_eq!(
        (plan.walls.len(), plan.size, crossed.environment_params.arena_size()),
        (4, [0.0; 2], [100.0; 2])
    );
    assert!(crossed.enclosure([2.9, 0.1]).is_some() && crossed.enclosure([2.9, 0.2]).is_none());
    assert!(crossed.enclosure([0.4, 2.9]).is_some() && crossed.enclosure([1.0, 1.5]).is_some());
}
