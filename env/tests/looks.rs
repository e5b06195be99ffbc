//! Images in the natural style: objects are at the same positions as in the plain style, pixels are the same with every
//! instruction set, and distant surfaces have their plain colour.

use driftworld_env::{Camera, CpuRenderer, FAR_DEPTH, Frame, Scene, Target};
use driftworld_spec::{Covering, Layout, Looks, Maze, Object, Rooms, Style, Surface, Wall, World, WorldDraft, Zone};
use proptest::prelude::*;

fn natural() -> Looks {
    Looks::of(Style::Natural)
}

fn checked(world: &WorldDraft) -> World {
    world.clone().check().expect("the world is valid")
}

fn draw_with(renderer: &mut CpuRenderer, world: &WorldDraft, camera: &Camera, [width, height]: [u32; 2]) -> Frame {
    let mut frame = Frame::new(width, height);
    renderer.render(&Scene::from_world(&checked(world)), camera, &mut frame);
    frame
}

fn draw(world: &WorldDraft, camera: &Camera, size: [u32; 2]) -> Frame {
    draw_with(&mut CpuRenderer::new(), world, camera, size)
}

fn eyes(heading_deg: f32) -> Camera {
    Camera::first_person([0.3, -0.2], heading_deg, 1.0, 60.0)
}

/// Objects of several shapes, some covered, and zones.
fn park() -> WorldDraft {
    let mut world = WorldDraft::default();
    let environment = &mut world.environment_params;
    environment.looks = natural();
    environment.map_size = [40.0, 40.0];
    environment.zones = vec![Zone::disc([0.0, 6.0], 2.0)];
    let classes = ["tree", "cube", "barrel", "geometric", "bench", "cube"];
    let (x, y) = ([2.0, -3.0, 0.5, 5.0, -8.0, 0.6], [6.0, 7.0, 9.0, 12.0, 3.0, 0.4]);
    for (k, class) in classes.into_iter().enumerate() {
        let place = [x[k], y[k]];
        let mut object = Object::new(class, place);
        object.heading = 30.0;
        if class == "cube" && place[0] < 2.0 {
            object.surface = Surface::Brick;
        }
        world.objects.push(object);
    }
    world
}

/// One world of each kind: outdoors, at dusk in fog, in rooms, in a maze.
fn worlds() -> [WorldDraft; 4] {
    let mut dusk = park();
    dusk.environment_params.sun_direction = [0.9, 0.3, 0.2];
    dusk.environment_params.fog_distance = Some(20.0);
    let mut rooms = park();
    rooms.environment_params.layout = Some(Layout {
        rooms: Some(Rooms::default()),
        ..Layout::default()
    });
    let mut maze = park();
    maze.environment_params.looks.ceiling = Some(false);
    maze.environment_params.layout = Some(Layout {
        maze: Some(Maze {
            seed: Some(3),
            ..Maze::default()
        }),
        ..Layout::default()
    });
    [park(), dusk, rooms, maze]
}

/// Every instruction set renders the same pixels. Without instance images, labels may store classes, which gives the same
/// result as with instances.
#[test]
fn instruction_sets_render_the_same_natural_pixels() {
    let mut uncovered = worlds();
    let objects = uncovered.iter_mut().flat_map(|world| &mut world.objects);
    objects.for_each(|object| object.surface = Surface::Plain);
    for (number, world) in worlds().iter().chain(&uncovered).enumerate() {
        let scene = Scene::from_world(&checked(world));
        let mut of_things = 0;
        let views = [
            (0.0, [84, 84]),
            (200.0, [84, 84]),
            (290.0, [84, 84]),
            (200.0, [33, 20]),
            (75.0, [5, 3]),
        ];
        for (heading, [width, height]) in views {
            let mut first: Option<Frame> = None;
            for (name, mut renderer) in CpuRenderer::each_instruction_set() {
                let mut frame = Frame::new(width, height);
                renderer.render(&scene, &eyes(heading), &mut frame);
                let place = format!("world {number}, {name}, heading {heading}");
                for has_classes in [false, true] {
                    let mut other = Frame::new(width, height);
                    let mut target = Target {
                        width,
                        height,
                        rgb: Some(&mut other.rgb),
                        depth: has_classes.then_some(&mut other.depth[..]),
                        category: has_classes.then_some(&mut other.category[..]),
                        class: has_classes.then_some(&mut other.class[..]),
                        ..Target::default()
                    };
                    renderer
                        .draw(&scene, &eyes(heading), &mut target)
                        .expect("the image renders");
                    assert_eq!(other.rgb, frame.rgb, "{place}: without instances");
                    if has_classes {
                        assert_eq!(
                            (&other.category, &other.class),
                            (&frame.category, &frame.class),
                            "{place}"
                        );
                        assert!(other.depth == frame.depth, "{place}");
                    }
                }
                of_things += frame.class.iter().filter(|class| **class > 0).count();
                let expected = first.get_or_insert_with(|| frame.clone());
                assert_eq!(frame.rgb, expected.rgb, "{place}");
                let bits = |frame: &Frame| frame.depth.iter().map(|metres| metres.to_bits()).collect::<Vec<_>>();
                assert_eq!(bits(&frame), bits(expected), "{place}");
                assert_eq!(
                    (&frame.category, &frame.class, &frame.instance),
                    (&expected.category, &expected.class, &expected.instance),
                    "{place}"
                );
            }
        }
        assert!(of_things > 100, "objects are visible in world {number}: {of_things}");
    }
}

/// Without a ceiling, depth, categories and objects are those of the plain style, except for pixels on edges.
#[test]
fn only_colours_differ_from_the_plain_style() {
    let [park, dusk, _, maze] = worlds();
    for mut world in [park, dusk, maze] {
        // Other classes have different models in the two styles.
        world
            .objects
            .retain(|object| ["cube", "geometric"].contains(&object.class.as_str()));
        let world = &world;
        let mut plain = world.clone();
        plain.environment_params.looks = Looks::default();
        for heading in [0.0, 130.0] {
            let [a, b] = [world, &plain].map(|world| draw(world, &eyes(heading), [84, 84]));
            let differing = (0..a.depth.len()).filter(|pixel| {
                let near = (a.depth[*pixel] - b.depth[*pixel]).abs() <= 1e-3 * b.depth[*pixel];
                !near || a.category[*pixel] != b.category[*pixel] || a.instance[*pixel] != b.instance[*pixel]
            });
            let differing = differing.count();
            assert!(differing * 400 <= a.depth.len(), "{differing} pixels");
            assert!(a.rgb != b.rgb);
        }
    }
}

/// Mean colour of these rows' pixels.
fn mean(frame: &Frame, rows: std::ops::Range<usize>) -> [f64; 3] {
    let width = frame.width as usize;
    let pixels = &frame.rgb[3 * width * rows.start..3 * width * rows.end];
    let of = |channel: usize| pixels.iter().skip(channel).step_by(3).map(|byte| f64::from(*byte));
    [0, 1, 2].map(|channel| of(channel).sum::<f64>() / (pixels.len() / 3) as f64)
}

fn ground(surface: Surface) -> WorldDraft {
    let mut world = WorldDraft::default();
    world.environment_params.map_size = [300.0, 300.0];
    world.environment_params.wall_height = 0.0;
    world.environment_params.looks = Looks {
        ground: Some(Covering::of(surface)),
        ..natural()
    };
    world
}

fn surfaces() -> [Surface; 9] {
    let names = r#"["stone", "plaster", "cobbles", "noise", "brick", "plank", "tile", "stripes", "checker"]"#;
    serde_json::from_str(names).expect("the names are surfaces")
}

#[test]
fn surface_has_its_plain_colour_from_a_distance() {
    let flat = draw(&ground(Surface::Plain), &eyes(20.0), [84, 84]);
    for surface in surfaces() {
        let covered = draw(&ground(surface), &eyes(20.0), [84, 84]);
        // The first rows show the ground beyond 7 m, the second beyond 36 m.
        for (rows, bound) in [(43..53, 4.0), (43..45, 1.0)] {
            let (a, b) = (mean(&flat, rows.clone()), mean(&covered, rows));
            for channel in 0..3 {
                let off = (a[channel] - b[channel]).abs();
                assert!(off < bound, "{surface:?}: {a:?} and {b:?}");
            }
        }
        assert!(covered.rgb != flat.rgb, "{surface:?} is visible nearby");
    }
}

/// Turning by a tenth of a pixel hardly changes distant ground: surfaces do not shimmer.
#[test]
fn surfaces_do_not_shimmer() {
    for surface in surfaces() {
        let world = ground(surface);
        let [a, b] = [20.0, 20.0 + 0.07].map(|heading| draw(&world, &eyes(heading), [84, 84]));
        let changes: Vec<u8> = (3 * 84 * 43..3 * 84 * 50)
            .map(|k| a.rgb[k].abs_diff(b.rgb[k]))
            .collect();
        let mean = changes.iter().map(|by| f64::from(*by)).sum::<f64>() / changes.len() as f64;
        let most = changes.into_iter().max();
        assert!(
            mean < 1.5 && most < Some(40),
            "{surface:?}: {mean} on average, {most:?} at most"
        );
    }
}

proptest! {
    #![proptest_config(ProptestConfig::with_cases(crate::tier::quick_or_full(24, 96)))]

    /// A wall or an object and the ground are darker where they meet than a metre away. Tested in flat colours, without
    /// shadows.
    #[test]
    fn ground_contacts_have_a_dark_line(away in 2.6..3.6_f64, eye in 0.9..1.6_f32, is_wall in any::<bool>(), ceiling in any::<bool>()) {
        let mut world = ground(Surface::Plain);
        let environment = &mut world.environment_params;
        environment.looks.walls = Some(Covering::of(Surface::Plain));
        (environment.looks.shadows, environment.looks.ceiling) = (Some(false), Some(ceiling));
        environment.wall_height = 3.0;
        if is_wall {
            let polygon = vec![[-9.0, away], [9.0, away], [9.0, away + 1.0], [-9.0, away + 1.0]];
            environment.walls = vec![Wall { polygon, height: Some(3.0), color: None }];
        } else {
            let mut thing = Object::new("geometric", [0.0, away + 1.0]);
            (thing.model, thing.scale) = (driftworld_spec::Model("3".to_owned()), 2.2);
            world.objects.push(thing);
        }
        let frame = draw(&world, &Camera::first_person([0.0; 2], 0.0, eye, 90.0), [84, 336]);
        let middle = |row: usize| row * 84 + 42;
        let green = |row: usize| f64::from(frame.rgb[3 * middle(row) + 1]);
        let foot = (168..336).find(|row| frame.depth[middle(*row)] < 0.999 * frame.depth[middle(row - 1)]);
        let foot = foot.expect("the ground comes nearer row by row");
        prop_assert!(green(foot - 1) < 0.8 * green(168), "{} at the foot, {} above", green(foot - 1), green(168));
        prop_assert!(green(foot) < 0.8 * green(335), "{} at the foot, {} before it", green(foot), green(335));
    }
}

/// Seen from above, the edge of a wall overlaps ground that the wall does not touch: that ground stays as bright as without the
/// wall.
#[test]
fn ground_below_a_walls_leaning_edge_stays_bright() {
    let mut world = ground(Surface::Plain);
    world.environment_params.looks.shadows = Some(false);
    let camera = Camera {
        pitch_deg: -50.0,
        ..Camera::first_person([0.0; 2], 0.0, 5.0, 90.0)
    };
    let empty = draw(&world, &camera, [672; 2]);
    let polygon = vec![[-9.0, 4.0], [4.0, 4.0], [4.0, 6.0], [-9.0, 6.0]];
    world.environment_params.walls = vec![Wall {
        polygon,
        height: Some(3.0),
        color: None,
    }];
    let walled = draw(&world, &camera, [672; 2]);
    let darker =
        |pixel: &usize| walled.depth[*pixel] == empty.depth[*pixel] && walled.rgb[3 * pixel] < empty.rgb[3 * pixel];
    let count = |columns: std::ops::Range<usize>| {
        (0..672 * 672)
            .filter(|k| columns.contains(&(k % 672)))
            .filter(darker)
            .count()
    };
    // The wall's corner is in column 546.
    assert_eq!(count(550..672), 0);
    assert!(count(500..540) > 400);
}

/// Doors, keys, cubes and switches show a pattern, regardless of their number; depth, categories and objects are those of the
/// plain style.
#[test]
fn doors_keys_cubes_and_switches_have_a_finish() {
    for class in ["door", "key", "cube", "switch"] {
        let mut world = ground(Surface::Plain);
        for k in 0..10 {
            let mut object = Object::new(class, [f64::from(k) - 4.5, 4.0]);
            (object.scale, object.color) = (0.9, driftworld_spec::Color::from_name("red"));
            world.objects.push(object);
        }
        let camera = Camera::first_person([0.0; 2], 0.0, 0.3, 60.0);
        let natural = draw(&world, &camera, [504, 168]);
        world.environment_params.looks = Looks::default();
        let plain = draw(&world, &camera, [504, 168]);
        assert!(
            natural.depth == plain.depth && natural.instance == plain.instance,
            "{class}"
        );
        for number in 1..=10 {
            let colors = |frame: &Frame| {
                let of = |place: usize| [0, 1, 2].map(|channel| frame.rgb[3 * place + channel]);
                // Above eye height, and well above the ground.
                let own = (0..504 * 84).filter(|place| frame.instance[*place] == number).map(of);
                own.collect::<std::collections::BTreeSet<_>>().len()
            };
            assert!(
                colors(&natural) > 3 * colors(&plain),
                "{class} {number}: {}",
                colors(&natural)
            );
        }
    }
}

/// A wall below eye height has a top in the natural style: no ground is visible within its outline.
#[test]
fn low_walls_have_tops() {
    let mut world = ground(Surface::Plain);
    let polygon = vec![[-2.0, 3.0], [2.0, 3.0], [2.0, 6.0], [-2.0, 6.0]];
    world.environment_params.walls = vec![Wall {
        polygon,
        height: Some(0.5),
        color: None,
    }];
    world.agent_params.agent_height = 1.5;
    let camera = Camera::first_person([0.0; 2], 0.0, 1.5, 60.0);
    let frame = draw(&world, &camera, [85, 85]);
    for row in 43..85 {
        let metres = frame.depth[row * 85 + 42];
        let below = metres * (row as f32 - 42.0) * 2.0 * libm::tanf(30_f32.to_radians()) / 85.0;
        if (3.1..5.9).contains(&metres) {
            assert!((below - 1.0).abs() < 1e-2, "row {row}: {below} m below the eye");
        }
    }
}

#[test]
fn shadows_darken_only_the_ground() {
    let mut with = park();
    with.environment_params.sun_direction = [0.9, 0.1, 0.5];
    let mut without = with.clone();
    without.environment_params.looks.shadows = Some(false);
    let [a, b] = [&with, &without].map(|world| draw(world, &eyes(0.0), [84, 84]));
    assert_eq!(a.instance, b.instance);
    assert!(a.depth == b.depth && a.category == b.category);
    let mut darker = 0;
    for pixel in 0..84 * 84 {
        let [of, than] = [&a, &b].map(|frame| &frame.rgb[3 * pixel..3 * pixel + 3]);
        if of != than {
            darker += 1;
            assert!(of.iter().zip(than).all(|(of, than)| of <= than));
            assert_eq!(a.instance[pixel], 0, "only the ground is shaded");
        }
    }
    assert!(darker > 20, "{darker} pixels");
}

/// Whether the segment from a to b enters a convex polygon, by clipping it at each edge.
fn enters([a, b]: [[f32; 2]; 2], polygon: &[[f32; 2]]) -> bool {
    let (mut first, mut last) = (0.0_f32, 1.0_f32);
    for (k, from) in polygon.iter().enumerate() {
        let to = polygon[(k + 1) % polygon.len()];
        let left_of = |at: [f32; 2]| (to[0] - from[0]) * (at[1] - from[1]) - (to[1] - from[1]) * (at[0] - from[0]);
        let (start, end) = (left_of(a), left_of(b));
        if start < 0.0 && end < 0.0 {
            return false;
        }
        let there = start / (start - end);
        if start < 0.0 {
            first = first.max(there);
        } else if end < 0.0 {
            last = last.min(there);
        }
    }
    first <= last
}

proptest! {
    #![proptest_config(ProptestConfig::with_cases(crate::tier::quick_or_full(24, 96)))]

    /// Ground is in a wall's shadow if the line towards the sun, up to the wall's height, enters the wall.
    #[test]
    fn shadows_of_walls_are_where_walls_block_the_sun(
        ((x, y), (long, thick)) in ((-4.0..4.0_f64, 5.0..9.0_f64), (0.3..6.0_f64, 0.2..4.0_f64)),
        (turn, height) in (0.0..360.0_f64, 0.3..3.0_f64),
        (azimuth, rise) in (0.0..360.0_f64, 0.5..2.0_f64),
    ) {
        const SIDE: usize = 84;
        const EYE: f32 = 3.5;
        let (sine, cosine) = libm::sincos(turn.to_radians());
        let corners = [[-1.0, -1.0], [1.0, -1.0], [1.0, 1.0], [-1.0, 1.0]].map(|[along, across]: [f64; 2]| {
            let (along, across) = (along * long / 2.0, across * thick / 2.0);
            [x + cosine * along - sine * across, y + sine * along + cosine * across]
        });
        let mut world = WorldDraft::default();
        let environment = &mut world.environment_params;
        environment.looks = Looks { ground: Some(Covering::of(Surface::Plain)), ..natural() };
        environment.map_size = [80.0, 80.0];
        environment.walls = vec![Wall { polygon: corners.to_vec(), height: Some(height), color: None }];
        let (east, north) = libm::sincos(azimuth.to_radians());
        environment.sun_direction = [east, north, rise];
        let mut without = world.clone();
        without.environment_params.looks.shadows = Some(false);
        let camera = Camera::first_person([0.0, -2.0], 0.0, EYE, 60.0);
        let [with, without] = [&world, &without].map(|world| draw(world, &camera, [SIDE as u32; 2]));
        let polygon = corners.map(|corner| corner.map(|metres| metres as f32));
        let reach = [east, north].map(|part| (part / rise * height) as f32);
        let step = 2.0 * libm::tanf(30_f32.to_radians()) / SIDE as f32;
        // Content of each pixel: no bare ground, ground in shadow, or ground in the sun.
        let expected: Vec<Option<bool>> = (0..SIDE * SIDE)
            .map(|pixel| {
                let offset = |place: usize| (place as f32 + 0.5 - SIDE as f32 / 2.0) * step;
                let (right, down) = (offset(pixel % SIDE), offset(pixel / SIDE));
                let depth = without.depth[pixel];
                let at = [right * depth, depth - 2.0];
                let is_ground = (EYE - down * depth).abs() < 1e-2 && !enters([at, at], &polygon);
                is_ground.then(|| enters([at, [at[0] + reach[0], at[1] + reach[1]]], &polygon))
            })
            .collect();
        for pixel in (1..SIDE - 1).flat_map(|row| (1..SIDE - 1).map(move |column| row * SIDE + column)) {
            let around = [0, 1, 2].map(|row| [0, 1, 2].map(|column| expected[pixel + row * SIDE + column - SIDE - 1]));
            let (Some(is_dark), true) = (expected[pixel], around.as_flattened().iter().all(|one| *one == expected[pixel])) else {
                continue;
            };
            let bytes = 3 * pixel..3 * pixel + 3;
            prop_assert_eq!(with.rgb[bytes.clone()] != without.rgb[bytes], is_dark, "column {}, row {}", pixel % SIDE, pixel / SIDE);
        }
    }
}

#[test]
fn depth_includes_fog_only_if_enabled() {
    let mut clear = park();
    let mut foggy = park();
    foggy.environment_params.fog_distance = Some(15.0);
    let mut shortened = foggy.clone();
    shortened.environment_params.looks.fog_in_depth = true;
    for style in [Style::Natural, Style::Plain] {
        for world in [&mut clear, &mut foggy, &mut shortened] {
            world.environment_params.looks.style = style;
        }
        let [clear, foggy, shortened] = [&clear, &foggy, &shortened].map(|world| draw(world, &eyes(0.0), [40, 40]));
        assert_eq!(clear.depth, foggy.depth);
        for (metres, seen) in foggy.depth.iter().zip(&shortened.depth) {
            let expected = metres * 15.0 / (metres * metres + 225.0).sqrt();
            assert!((seen - expected).abs() < 1e-4 && *seen < 15.0, "{metres}: {seen}");
        }
        assert!(foggy.depth.contains(&FAR_DEPTH));
    }
}
