//! Maps from above show a layout: filled walls, free cells, open and closed doors, and a path.

use driftworld_env::{Camera, CpuRenderer, Environment, Frame, Image, Scene, top_down, top_down_with_way};
use driftworld_spec::{Color, Door, Layout, Maze, Object, Rooms, World, WorldDraft};
use proptest::prelude::*;

const SIZE: u32 = 400;

fn layouts() -> impl Strategy<Value = Layout> {
    let maze = (2_u32..7, 2_u32..7, 0.0..=1.0_f64, any::<u64>()).prop_map(|(columns, rows, braid, seed)| Layout {
        maze: Some(Maze {
            cells: [columns, rows],
            braid,
            seed: Some(seed >> 24),
            ..Maze::default()
        }),
        ..Layout::default()
    });
    let rooms = (1_u32..4, 1_u32..4, any::<u64>()).prop_map(|(columns, rows, seed)| Layout {
        rooms: Some(Rooms {
            grid: [columns, rows],
            seed: Some(seed >> 24),
            ..Rooms::default()
        }),
        ..Layout::default()
    });
    let text = prop::collection::vec(prop::collection::vec(any::<bool>(), 6), 3..8).prop_map(|rows| {
        let row = |walls: &Vec<bool>| walls.iter().map(|is_wall| if *is_wall { '#' } else { '.' }).collect();
        let mut lines: Vec<String> = rows.iter().map(row).collect();
        lines.push("A.....".to_owned());
        Layout {
            text: Some(lines),
            ..Layout::default()
        }
    });
    prop_oneof![maze, rooms, text]
}

/// A world with red walls.
fn world(layout: Layout) -> World {
    let mut world = WorldDraft::default();
    world.environment_params.layout = Some(layout);
    world.environment_params.bounding_wall_color = Color([1.0, 0.0, 0.0]);
    world.environment_params.ground_color = Color([0.0, 1.0, 0.0]);
    world.agent_params.coordinates = world.plan().expect("the world has a layout").cells[0].center;
    world.check().expect("the world is valid")
}

/// The pixel at a position on a square map.
fn pixel(world: &World, image: &Image, place: [f64; 2]) -> [u8; 3] {
    let span = world
        .environment_params
        .arena_size()
        .iter()
        .fold(1.0, |most: f64, side| most.max(*side))
        * 1.06;
    let side = f64::from(image.width);
    let [column, row] = [place[0], -place[1]].map(|metres| (side / 2.0 + metres * side / span) as usize);
    let start = 3 * (row * image.width as usize + column);
    [0, 1, 2].map(|channel| image.rgb[start + channel])
}

fn middle(polygon: &[[f64; 2]]) -> [f64; 2] {
    [0, 1].map(|axis| polygon.iter().map(|corner| corner[axis]).sum::<f64>() / polygon.len() as f64)
}

proptest! {
    #![proptest_config(ProptestConfig::with_cases(crate::tier::quick_or_full(24, 32)))]

    /// The centre of each wall is red, and that of each free cell is not.
    #[test]
    fn walls_are_filled_and_cells_are_free(layout in layouts()) {
        let world = world(layout);
        let image = top_down(&Scene::from_world(&world), SIZE, SIZE, None);
        let plan = world.plan().expect("the world has a layout");
        for wall in &plan.walls {
            let [red, green, _] = pixel(&world, &image, middle(&wall.polygon));
            prop_assert!(red > 60 && green == 0, "{red} {green} in {:?}", wall.polygon);
        }
        for cell in &plan.cells {
            let [red, green, _] = pixel(&world, &image, cell.center);
            prop_assert!(red == 0 && green > 60, "{red} {green} at {:?}", cell.center);
        }
    }

    /// Wall tops do not change views from below.
    #[test]
    fn tops_are_not_seen_from_below(layout in layouts(), cell in any::<prop::sample::Index>(), heading in 0.0..360.0_f32) {
        let world = world(layout);
        let cells = &world.plan().expect("the world has a layout").cells;
        let place = cells[cell.index(cells.len())].center.map(|metres| metres as f32);
        let camera = Camera::first_person(place, heading, 1.0, 60.0);
        let draw = |scene: &Scene| {
            let mut frame = Frame::new(48, 48);
            CpuRenderer::new().render(scene, &camera, &mut frame);
            (frame.rgb, frame.depth)
        };
        let scene = Scene::from_world(&world);
        prop_assert_eq!(draw(&scene), draw(&scene.clone().with_wall_tops()));
    }
}

#[test]
fn door_is_a_bar_along_its_leaf() {
    let look = |open: bool| {
        let mut door = Object::new("door", [0.0, 0.0]);
        (door.scale, door.color) = (3.0, Some(Color([0.0, 0.0, 1.0])));
        door.door = Some(Door {
            open,
            ..Door::default()
        });
        let mut world = WorldDraft::with_objects(vec![door]);
        world.environment_params.map_size = [12.0, 12.0];
        world.agent_params.coordinates = [-4.0, -4.0];
        let environment = Environment::new(world.check().expect("the world is valid"));
        let image = top_down(environment.scene(), SIZE, SIZE, None);
        [[0.7, 0.0], [-1.5, -0.7]].map(|place| pixel(environment.world(), &image, place)[2] > 200)
    };
    assert_eq!(look(false), [true, false]);
    assert_eq!(look(true), [false, true], "it swings around its left end");
}

#[test]
fn path_is_a_line_through_its_positions() {
    let mut world = WorldDraft::default();
    world.environment_params.map_size = [12.0, 12.0];
    let world = world.check().expect("the world is valid");
    let scene = Scene::from_world(&world);
    let way = [[-4.0, -4.0], [-4.0, 3.0], [5.0, 3.0]];
    let with = top_down_with_way(&scene, SIZE, SIZE, None, &way);
    for place in [[-4.0, 0.0], [0.0, 3.0], [4.5, 3.0]] {
        assert_eq!(pixel(&world, &with, place), [255; 3], "{place:?}");
    }
    assert_ne!(pixel(&world, &with, [0.0, 0.0]), [255; 3]);
    assert_eq!(
        top_down_with_way(&scene, SIZE, SIZE, None, &[]),
        top_down(&scene, SIZE, SIZE, None)
    );
}
