//! Worlds in natural looks, drawn at random: what the graphics card makes of them beside what the processor does.

use driftworld_env::{Camera, CpuRenderer, Frame, Picture, Scene, Target};
use driftworld_spec::{Color, Covering, Layout, Looks, Maze, Object, Rooms, Style, Surface, Wall, WorldDraft, Zone};
use rand::{RngExt as _, SeedableRng as _};
use rand_chacha::ChaCha8Rng;

use crate::likeness::{Likeness, gpu, likeness, write_difference};

const SURFACES: [Surface; 7] = [
    Surface::Plain,
    Surface::Noise,
    Surface::Brick,
    Surface::Plank,
    Surface::Tile,
    Surface::Stripes,
    Surface::Checker,
];

/// What kind of world is drawn.
#[derive(Clone, Copy, Debug, PartialEq)]
enum Kind {
    /// Things, zones and walls under a high sun.
    Park,
    /// The same under a low sun, in fog.
    Dusk,
    /// Rooms with a ceiling.
    Rooms,
    /// A maze under the sky.
    Maze,
    /// A map drawn with letters, with a ceiling.
    Letters,
}

fn covering(rng: &mut ChaCha8Rng) -> Covering {
    let mut covering = Covering::of(SURFACES[rng.random_range(0..SURFACES.len())]);
    covering.scale = rng.random_range(0.5..2.0);
    covering
}

fn world(kind: Kind, rng: &mut ChaCha8Rng) -> WorldDraft {
    let mut world = WorldDraft::default();
    let environment = &mut world.environment_params;
    environment.map_size = [30.0, 30.0];
    environment.looks = Looks::of(Style::Natural);
    environment.looks.ground = Some(covering(rng));
    environment.looks.walls = Some(covering(rng));
    let turn: f64 = rng.random_range(0.0..6.0);
    environment.sun_direction = [turn.sin(), turn.cos(), rng.random_range(0.7..2.0)];
    // Never so dim that nothing is seen.
    environment.light_intensity = rng.random_range(0.4..1.3);
    if rng.random_bool(0.3) {
        environment.fog_distance = Some(rng.random_range(10.0..60.0));
    }
    match kind {
        Kind::Park => {}
        Kind::Dusk => {
            environment.sun_direction[2] = rng.random_range(0.05..0.25);
            environment.fog_distance = Some(rng.random_range(10.0..60.0));
            environment.looks.fog_in_depth = rng.random();
        }
        Kind::Rooms => {
            environment.layout = Some(Layout {
                rooms: Some(Rooms {
                    seed: Some(rng.random_range(0..100)),
                    ..Rooms::default()
                }),
                ..Layout::default()
            });
        }
        Kind::Letters => {
            let letters = [
                "#########",
                "#.......#",
                "#.##.##.#",
                "#...A...#",
                "#.#...#.#",
                "#########",
            ];
            environment.layout = Some(Layout {
                text: Some(letters.map(str::to_owned).to_vec()),
                ..Layout::default()
            });
        }
        Kind::Maze => {
            environment.looks.ceiling = Some(false);
            environment.layout = Some(Layout {
                maze: Some(Maze {
                    seed: Some(rng.random_range(0..100)),
                    ..Maze::default()
                }),
                ..Layout::default()
            });
        }
    }
    if environment.layout.is_none() {
        environment.zones = vec![
            Zone::disc([rng.random_range(-5.0..5.0), 6.0], 2.5),
            Zone::disc([rng.random_range(-5.0..5.0), -4.0], 1.5),
        ];
        let [x, y] = [rng.random_range(-9.0..3.0), rng.random_range(8.0..11.0)];
        environment.walls = vec![Wall {
            polygon: vec![[x, y], [x + 6.0, y + 1.0], [x + 6.0, y + 2.0], [x, y + 1.0]],
            height: Some(1.5),
            color: Some(Color([0.7, 0.3, 0.2])),
        }];
    }
    let classes = [
        "tree", "cube", "barrel", "rock", "bench", "cube", "cylinder", "sign", "car",
    ];
    for k in 0..14 {
        let class = classes[rng.random_range(0..classes.len())];
        let angle = f64::from(k) * 0.9;
        let away = 2.5 + f64::from(k) * 0.8;
        let mut object = Object::new(class, [away * angle.sin(), away * angle.cos()]);
        object.heading = rng.random_range(0.0..360.0);
        if class == "sign" {
            object.text = Some("EXIT".to_owned());
        }
        // More covered ones than there are numbers for.
        object.surface = SURFACES[rng.random_range(0..SURFACES.len())];
        world.objects.push(object);
    }
    // One so near that the near plane cuts it.
    let mut near = Object::new("cube", [0.5, 0.6]);
    near.surface = Surface::Plank;
    world.objects.push(near);
    world
}

/// From the middle all around, from above askew, and of the whole arena.
fn cameras(scene: &Scene, rng: &mut ChaCha8Rng) -> Vec<Camera> {
    let mut eye = || {
        let place = [rng.random_range(-0.3..0.3), rng.random_range(-0.3..0.3)];
        Camera::first_person(place, rng.random_range(0.0..360.0), 1.0, 70.0)
    };
    let askew = Camera {
        pitch_deg: -20.0,
        ..eye()
    };
    vec![eye(), eye(), askew, Camera::overview(scene)]
}

fn check(like: &Likeness) -> bool {
    like.colors >= 0.995
        && like.classes >= 0.995
        && like.instances >= 0.995
        && like.categories >= 0.995
        && like.depths >= 0.999
}

fn check_kind(kind: Kind) {
    let Some(mut gpu) = gpu() else { return };
    let mut cpu = CpuRenderer::new();
    let mut failures = Vec::new();
    let sizes = [[84, 84], [160, 120], [64, 200], [33, 20]];
    for (seed, [width, height]) in (0..8).zip(sizes.into_iter().cycle()) {
        let mut rng = ChaCha8Rng::seed_from_u64(seed);
        let scene = Scene::from_world(&world(kind, &mut rng).check().expect("the world is sound"));
        let cameras = cameras(&scene, &mut rng);
        let mut found: Vec<_> = cameras.iter().map(|_| Frame::new(width, height)).collect();
        let mut pictures: Vec<_> = cameras
            .iter()
            .zip(&mut found)
            .map(|(camera, frame)| Picture {
                scene: &scene,
                camera: *camera,
                target: frame.target(),
            })
            .collect();
        gpu.draw_batch(&mut pictures).expect("the adapter draws");
        for (c, (camera, found)) in cameras.iter().zip(&found).enumerate() {
            let mut expected = Frame::new(width, height);
            cpu.render(&scene, camera, &mut expected);
            let like = likeness(found, &expected);
            let name = format!("natural-{kind:?}-{seed}-{c}");
            if !check(&like) {
                let path = write_difference(&name, found, &expected);
                failures.push(format!("{name}: {like:?}; see {}", path.display()));
            }
        }
    }
    assert!(failures.is_empty(), "{}", failures.join("\n"));
}

/// A picture with four points in each pixel.
fn sampled<'a>(scene: &'a Scene, camera: Camera, frame: &'a mut Frame) -> Picture<'a> {
    let target = Target {
        supersampling: 2,
        ..frame.target()
    };
    Picture { scene, camera, target }
}

/// Several points a pixel, fog that depth sees, plain worlds between natural ones: all of one batch.
#[test]
fn plain_and_natural_pictures_of_a_batch_are_alike() {
    let Some(mut gpu) = gpu() else { return };
    let mut rng = ChaCha8Rng::seed_from_u64(9);
    let kinds = [Kind::Dusk, Kind::Park, Kind::Rooms, Kind::Maze, Kind::Dusk, Kind::Park];
    let scenes: Vec<_> = (0..)
        .zip(kinds)
        .map(|(k, kind)| {
            let mut world = world(kind, &mut rng);
            if k % 3 == 1 {
                world.environment_params.looks = Looks::of(Style::Plain);
            }
            world.environment_params.looks.fog_in_depth = kind == Kind::Dusk;
            Scene::from_world(&world.check().expect("the world is sound"))
        })
        .collect();
    let mut found: Vec<_> = scenes.iter().map(|_| Frame::new(48, 48)).collect();
    let mut expected = found.clone();
    let camera = Camera::first_person([0.1, -0.2], 20.0, 1.0, 70.0);
    let mut pictures: Vec<_> = scenes
        .iter()
        .zip(&mut found)
        .map(|(scene, frame)| sampled(scene, camera, frame))
        .collect();
    gpu.draw_batch(&mut pictures).expect("the adapter draws");
    let mut cpu = CpuRenderer::new();
    for (k, (scene, (found, expected))) in scenes.iter().zip(found.iter().zip(&mut expected)).enumerate() {
        let mut wanted = sampled(scene, camera, expected);
        cpu.draw(scene, &camera, &mut wanted.target).expect("it draws");
        let like = likeness(found, expected);
        if !check(&like) {
            let path = write_difference(&format!("natural-batch-{k}"), found, expected);
            panic!("picture {k}: {like:?}; see {}", path.display());
        }
    }
}

#[test]
fn parks_are_alike() {
    check_kind(Kind::Park);
}

#[test]
fn dusk_and_fog_are_alike() {
    check_kind(Kind::Dusk);
}

#[test]
fn rooms_are_alike() {
    check_kind(Kind::Rooms);
}

#[test]
fn maps_of_letters_are_alike() {
    check_kind(Kind::Letters);
}

#[test]
fn mazes_are_alike() {
    check_kind(Kind::Maze);
}
