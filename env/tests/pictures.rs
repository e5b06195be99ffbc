//! Images show the right objects at the right depth and match the golden image; odd sizes do not panic.

use driftworld_env::{
    CATEGORY_BUILDING, CATEGORY_MAP, CATEGORY_NEGATIVE, CATEGORY_NEUTRAL, CATEGORY_POSITIVE, CATEGORY_SKY, Camera,
    CpuRenderer, FAR_DEPTH, Frame, Scene, Target, asset, category_color, classes, depth_to_gray, top_down,
};
use driftworld_spec::{Color, Model, Object, World, WorldDraft};

use crate::fixtures::wall_of;

fn draw(world: &WorldDraft, camera: &Camera, width: u32, height: u32) -> Frame {
    let mut frame = Frame::new(width, height);
    CpuRenderer::new().render(
        &Scene::from_world(&world.clone().check().expect("the world is valid")),
        camera,
        &mut frame,
    );
    frame
}

fn ahead(world: &WorldDraft) -> Frame {
    draw(world, &Camera::first_person([0.0, 0.0], 0.0, 1.0, 60.0), 64, 64)
}

fn centre<T: Copy>(values: &[T]) -> T {
    values[32 * 64 + 32]
}

#[test]
fn box_has_its_actual_depth() {
    let mut object = Object::new("cube", [0.0, 10.0]);
    object.scale = 4.0;
    let frame = ahead(&WorldDraft::with_objects(vec![object]));
    // Its front face is half of 4 × 0.9 m in front of its centre.
    assert!((centre(&frame.depth) - 8.2).abs() < 1e-3, "{}", centre(&frame.depth));
    assert_eq!((centre(&frame.instance), centre(&frame.class)), (1, 9));
}

#[test]
fn categories_follow_rewards() {
    for (class, reward, category) in [
        ("cube", 1.0, CATEGORY_POSITIVE),
        ("cube", 0.0, CATEGORY_NEUTRAL),
        ("cube", -1.0, CATEGORY_NEGATIVE),
        ("building", 1.0, CATEGORY_BUILDING),
    ] {
        let mut object = Object::new(class, [0.0, 30.0]);
        object.scale = 8.0;
        object.reward = reward;
        let frame = ahead(&WorldDraft::with_objects(vec![object]));
        assert_eq!(centre(&frame.category), category, "{class} worth {reward}");
    }
    assert_eq!(category_color(CATEGORY_POSITIVE), [0, 255, 255]);
}

#[test]
fn sky_is_above_walls_and_ground_below() {
    let frame = ahead(&WorldDraft::default());
    assert_eq!((frame.category[32], frame.depth[32]), (CATEGORY_SKY, FAR_DEPTH));
    assert_eq!(frame.category[63 * 64 + 32], CATEGORY_MAP);
    let below = frame.depth[63 * 64 + 32];
    assert!(
        (1.5..2.0).contains(&below),
        "the ground at the lower edge of a 60° view from 1 m: {below}"
    );
    assert!((centre(&frame.depth) - 50.0).abs() < 0.1, "the wall of a 100 m arena");
    assert_eq!(depth_to_gray(&[0.0, 50.0, 100.0, FAR_DEPTH]), [0, 128, 255, 255]);
}

#[test]
fn wall_hides_objects_behind_it() {
    let mut world = WorldDraft::with_objects(vec![Object::new("cube", [0.0, 20.0])]);
    assert!(ahead(&world).instance.contains(&1));
    let polygon = vec![[-5.0, 10.0], [5.0, 10.0], [5.0, 11.0], [-5.0, 11.0]];
    world.environment_params.walls = vec![wall_of(polygon)];
    assert!(!ahead(&world).instance.contains(&1));
}

#[test]
fn dusk_is_darker_than_day() {
    let light = |intensity| {
        let mut world = WorldDraft::default();
        world.environment_params.light_intensity = intensity;
        ahead(&world).rgb.iter().map(|byte| u64::from(*byte)).sum::<u64>()
    };
    assert!(light(0.2) * 2 < light(2.3));
    assert!(light(2.3) < light(3.5));
    assert!(light(0.0) < light(0.2));
}

#[test]
fn odd_sizes_and_places_never_panic() {
    let mut world = WorldDraft::with_objects(vec![Object::new("building", [0.0, 0.0]); 3]);
    world.objects[1].scale = 100.0;
    world.objects[2].scale = 0.01;
    for (width, height) in [(1, 1), (4096, 1), (1, 300), (7, 5)] {
        draw(
            &world,
            &Camera::first_person([0.0, 0.0], 17.0, 1.0, 60.0),
            width,
            height,
        );
    }
    for pitch_deg in [-90.0, 0.0, 90.0] {
        for field_of_view_deg in [1.0, 170.0] {
            let camera = Camera {
                position: [50.0, 50.0, 0.0],
                heading_deg: 45.0,
                pitch_deg,
                field_of_view_deg,
            };
            let frame = draw(&world, &camera, 16, 16);
            assert!(frame.depth.iter().all(|depth| depth.is_finite() && *depth >= 0.0));
        }
    }
    let flat = WorldDraft {
        environment_params: driftworld_spec::EnvironmentParams {
            wall_height: 0.0,
            ..Default::default()
        },
        ..WorldDraft::default()
    };
    top_down(
        &Scene::from_world(&flat.check().expect("the world is valid")),
        33,
        20,
        Some(([0.0, 0.0], 10.0)),
    );
}

#[test]
fn every_asset_is_valid() {
    for (class, models) in classes() {
        for number in 1..=models {
            let asset = asset(class, &Model(number.to_string()));
            assert!(asset.known, "{class} {number}");
            assert!(
                asset.height > 0.05 && asset.height < 15.0,
                "{class} {number}: {} m",
                asset.height
            );
            assert!(asset.collider.radius() > 0.05, "{class} {number}");
            for part in &asset.parts {
                assert_eq!(part.mesh.triangles.len(), part.normals.len());
                for corner in &part.mesh.corners {
                    assert!(corner.iter().all(|metres| metres.is_finite()), "{class} {number}");
                    assert!(corner[2] > -0.35, "{class} {number} stands on the ground: {corner:?}");
                }
                for triangle in &part.mesh.triangles {
                    assert!(
                        triangle
                            .iter()
                            .all(|corner| (*corner as usize) < part.mesh.corners.len())
                    );
                }
            }
        }
    }
    let unknown = asset("dragon", &Model("1".into()));
    assert!(!unknown.known && !unknown.parts.is_empty());
    assert!(!asset("tree", &Model("50".into())).known && !asset("tree", &Model("oak".into())).known);
}

#[test]
fn models_of_a_class_look_different() {
    let picture = |class: &str, number: u32| {
        let mut object = Object::new(class, [0.0, 8.0]);
        object.scale = if class == "fence" { 2.5 } else { 1.0 };
        object.model = Model(number.to_string());
        ahead(&WorldDraft::with_objects(vec![object])).rgb
    };
    for (class, models) in [
        ("tree", 49),
        ("rock", 44),
        ("fence", 31),
        ("shrub", 11),
        ("castleruin", 7),
        ("chair", 4),
        ("tent", 3),
    ] {
        let pictures: std::collections::BTreeSet<Vec<u8>> = (1..=models).map(|number| picture(class, number)).collect();
        assert_eq!(pictures.len(), models as usize, "{class}");
    }
}

/// One world with many objects, 84 × 84, every modality. `DRIFTWORLD_UPDATE_GOLDEN=1` rewrites the file.
#[test]
fn golden_image_is_unchanged() {
    let places = [
        ("tree", 1, 2.0, 9.0),
        ("barrel", 1, -1.5, 4.0),
        ("geometric", 2, 0.6, 3.5),
        ("tent", 2, -5.0, 11.0),
        ("building", 1, 8.0, 18.0),
    ];
    let object = |(class, model, x, y): (&str, u32, f64, f64)| {
        let mut object = Object::new(class, [x, y]);
        object.model = Model(model.to_string());
        object
    };
    let mut world = WorldDraft::with_objects(places.map(object).to_vec());
    world.objects[2].color = Color::from_name("blue");
    world.objects[2].reward = 1.0;
    let frame = draw(&world, &Camera::first_person([0.0, 0.0], 5.0, 1.0, 60.0), 84, 84);
    let path = std::path::Path::new(env!("CARGO_MANIFEST_DIR")).join("tests/golden/picture.png");
    if std::env::var_os("DRIFTWORLD_UPDATE_GOLDEN").is_some() {
        write_png(&path, &frame);
    }
    let (size, golden) = read_png(&path);
    assert_eq!(size, (84, 84), "the golden image has the size of the rendered one");
    let different = golden
        .chunks(3)
        .zip(frame.rgb.chunks(3))
        .filter(|(a, b)| a != b)
        .count();
    if different > 0 {
        let found = std::env::temp_dir().join("driftworld-picture-found.png");
        write_png(&found, &frame);
        panic!(
            "{different} pixels differ from {}; the rendered image is in {}",
            path.display(),
            found.display()
        );
    }
    let counts = [1, 2, 3, 4, 5].map(|instance| frame.instance.iter().filter(|other| **other == instance).count());
    let depth: f64 = frame.depth.iter().map(|metres| f64::from(*metres)).sum();
    assert_eq!(
        (counts, depth.to_bits()),
        golden_numbers(),
        "pixels of each object, and the sum of depths: {counts:?} {depth}"
    );
}

/// Number of pixels of each object in the golden image, and the bits of the sum of all depths.
fn golden_numbers() -> ([usize; 5], u64) {
    ([443, 283, 338, 67, 524], 4_702_721_634_808_774_144)
}

fn write_png(path: &std::path::Path, frame: &Frame) {
    let file = std::fs::File::create(path).expect("the picture can be written");
    let mut encoder = png::Encoder::new(file, frame.width, frame.height);
    encoder.set_color(png::ColorType::Rgb);
    let mut writer = encoder.write_header().expect("the picture can be written");
    writer.write_image_data(&frame.rgb).expect("the picture can be written");
}

fn read_png(path: &std::path::Path) -> ((u32, u32), Vec<u8>) {
    let file = std::fs::File::open(path).expect("the golden picture is committed");
    let mut reader = png::Decoder::new(std::io::BufReader::new(file))
        .read_info()
        .expect("the golden picture is a PNG");
    let mut rgb = vec![0; reader.output_buffer_size().expect("a small picture fits in memory")];
    let info = reader.next_frame(&mut rgb).expect("the golden picture is whole");
    ((info.width, info.height), rgb)
}

/// A scene with every special case of rendering: regions, a house cut by the near plane, fog and thin objects.
fn crowded() -> Scene {
    let classes: Vec<_> = classes().collect();
    let place = |k: usize| [(k * 37 % 60) as f64 - 30.0, (k * 53 % 60) as f64 - 30.0];
    let objects = (0..69).map(|k| {
        let (class, models) = classes[k % classes.len()];
        let mut object = Object::new(class, place(k));
        object.model = Model((k as u32 % models + 1).to_string());
        object.heading = (k * 71 % 360) as f64;
        object.color = (k % 2 == 0).then(|| Color([0.9, 0.2, k as f64 / 69.0]));
        object
    });
    let mut world = WorldDraft::with_objects(objects.collect());
    world.environment_params.predefined_map = 2;
    Scene::from_world(&world.check().expect("the world is valid"))
}

#[test]
fn instruction_sets_render_the_same_pixels() {
    let mut scene = crowded();
    let cameras = (0..24).map(|k| Camera {
        position: [k as f32 * 3.1 - 35.0, 20.0 - k as f32 * 2.3, [1.0, 0.3, 9.0][k % 3]],
        heading_deg: k as f32 * 47.0,
        pitch_deg: [0.0, -20.0, 15.0, -90.0][k % 4],
        field_of_view_deg: 60.0 + k as f32,
    });
    for (k, camera) in cameras.enumerate() {
        scene.light.fog_distance = (k % 5 == 4).then_some(30.0);
        let (width, height) = [(84, 84), (160, 120), (33, 17), (5, 7)][k % 4];
        let pictures = CpuRenderer::each_instruction_set()
            .into_iter()
            .map(|(name, mut renderer)| {
                let mut frame = Frame::new(width, height);
                renderer.render(&scene, &camera, &mut frame);
                // Agents' usual requests take a different path through the renderer.
                let (mut rgb, mut category) = (vec![0; frame.rgb.len()], vec![0; frame.category.len()]);
                let mut target = Target {
                    width,
                    height,
                    rgb: Some(&mut rgb),
                    category: Some(&mut category),
                    ..Target::default()
                };
                renderer
                    .draw(&scene, &camera, &mut target)
                    .expect("the sizes are valid");
                assert_eq!((&rgb, &category), (&frame.rgb, &frame.category), "{name}, picture {k}");
                (name, frame)
            });
        let pictures: Vec<_> = pictures.collect();
        for (name, frame) in &pictures[1..] {
            let (_, first) = &pictures[0];
            assert!(frame.rgb == first.rgb, "{name}: colour of picture {k}");
            let off = frame
                .depth
                .iter()
                .zip(&first.depth)
                .enumerate()
                .find(|(_, (a, b))| a != b);
            assert_eq!(off, None, "{name}: depth of picture {k}");
            assert!(frame.instance == first.instance, "{name}: instances of picture {k}");
            assert!(frame.class == first.class, "{name}: classes of picture {k}");
        }
    }
}

#[test]
fn target_of_the_wrong_size_is_an_error() {
    let mut rgb = vec![0; 10];
    let mut target = Target::of_colors([4, 4], &mut rgb);
    let camera = Camera::first_person([0.0, 0.0], 0.0, 1.0, 60.0);
    let drawn = CpuRenderer::new().draw(&Scene::from_world(&World::default()), &camera, &mut target);
    assert!(drawn.is_err());
}

#[test]
fn fog_gives_distant_objects_the_horizons_colour() {
    let mut scene = Scene::from_world(&World::default());
    let camera = Camera::first_person([0.0, 0.0], 0.0, 1.0, 60.0);
    let wall = |scene: &Scene| {
        let mut frame = Frame::new(64, 64);
        CpuRenderer::new().render(scene, &camera, &mut frame);
        i32::from(frame.rgb[(31 * 64 + 32) * 3 + 2])
    };
    let clear = wall(&scene);
    scene.light.fog_distance = Some(50.0);
    let half = wall(&scene);
    scene.light.fog_distance = Some(1.0);
    let thick = wall(&scene);
    assert!(
        (half - i32::midpoint(clear, thick)).abs() < 4,
        "{clear}, {half}, {thick}: the wall is 50 m away"
    );
}

#[test]
fn supersampling_averages_colours_and_nothing_else() {
    let scene = crowded();
    let camera = Camera::first_person([3.0, -20.0], 30.0, 1.0, 60.0);
    let draw = |width: u32, height: u32, supersampling: u32| {
        let mut frame = Frame::new(width, height);
        let mut target = Target {
            supersampling,
            ..frame.target()
        };
        CpuRenderer::new()
            .draw(&scene, &camera, &mut target)
            .expect("the sizes are valid");
        frame
    };
    let (plain, smooth, large) = (draw(60, 40, 1), draw(60, 40, 2), draw(120, 80, 1));
    assert!(plain.depth == smooth.depth && plain.class == smooth.class && plain.rgb != smooth.rgb);
    let mean = |x: usize, y: usize, channel: usize| {
        let at = |dx: usize, dy: usize| u32::from(large.rgb[((2 * y + dy) * 120 + 2 * x + dx) * 3 + channel]);
        ((at(0, 0) + at(1, 0) + at(0, 1) + at(1, 1) + 2) / 4) as u8
    };
    for (x, y) in [(0, 0), (59, 39), (31, 22), (12, 25)] {
        assert_eq!(smooth.rgb[(y * 60 + x) * 3 + 1], mean(x, y, 1), "pixel {x}, {y}");
    }
}
