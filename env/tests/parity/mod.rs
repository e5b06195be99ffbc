//! The GPU renders what the CPU renders: colours, depths and labels of the same scenes, pixel by pixel.
//!
//! Pixels at edges may differ, because the GPU snaps corners to a subpixel grid and the CPU does not. Without an adapter, the
//! tests print that they are skipped; with `DRIFTWORLD_REQUIRE_GPU=1` they fail.

#![cfg(feature = "gpu")]
#![expect(clippy::disallowed_methods, reason = "compared within a tolerance")]

mod likeness;

use std::path::Path;
use std::sync::Arc;

use driftworld_env::{
    Action, Autoreset, Batch, BatchOptions, Camera, CpuRenderer, EnvError, Environment, Episode, Frame, Images,
    Picture, RendererKind, RendererReport, Scene, Target,
};
use driftworld_spec::{Color, Looks, Modality, Object, Portable, Style, Wall, World, WorldDraft, Zone, ZoneEnd};
use likeness::{gpu, likeness, share, write_difference};

fn world(file: &str) -> World {
    let path = Path::new(env!("CARGO_MANIFEST_DIR")).join("..").join(file);
    let text = std::fs::read_to_string(&path).expect("the file is part of the repository");
    World::from_json(file, &text).expect("the file contains a world")
}

/// Worlds of all kinds: many objects, additional walls, fog, dusk, more classes than fit into a label.
fn worlds() -> Vec<(String, World)> {
    let files = [
        "src/throughput/arena_8.json",
        "src/throughput/arena_20.json",
        "generator/tests/golden/find_objects-huddle-7-1.json",
        "generator/tests/golden/find_objects-red-7-0.json",
        "generator/tests/golden/get_to_goal-hazards-7-2.json",
    ];
    let mut worlds: Vec<_> = files.map(|file| (file.to_owned(), world(file))).into();
    let mut foggy = world(files[1]).into_draft();
    foggy.environment_params.fog_distance = Some(50.0);
    foggy.environment_params.light_intensity = 0.6;
    let mut lava = Zone::disc([4.0, 6.0], 3.5);
    lava.ends = Some(ZoneEnd::Failure);
    let bent = vec![[-8.0, -6.0], [9.0, -8.0], [0.0, -4.0], [7.0, 3.0]];
    foggy.environment_params.zones = vec![Zone::polygon(bent), lava];
    foggy.environment_params.walls = [-12.0, 3.0, 14.0]
        .map(|x| Wall {
            polygon: vec![[x, -4.0], [x + 6.0, 2.0], [x + 5.0, 3.0], [x - 1.0, -3.0]],
            height: Some(1.5),
            color: Some(Color([0.7, 0.3, 0.2])),
        })
        .to_vec();
    worlds.push((
        "fog, dusk, walls".to_owned(),
        foggy.check().expect("the world is valid"),
    ));
    let mut zoo = WorldDraft::default();
    let classes: Vec<_> = driftworld_env::classes().map(|(class, _)| class.to_owned()).collect();
    let made_up = (0..40).map(|number| format!("thing{number}"));
    for (k, class) in classes.into_iter().chain(made_up).enumerate() {
        let angle = k as f64 * 0.7;
        let away = 4.0 + k as f64 * 0.3;
        let mut object = Object::new(&class, [away * angle.sin(), away * angle.cos()]);
        object.heading = (37.0 * k as f64) % 360.0;
        object.scale = 2.0;
        zoo.objects.push(object);
    }
    worlds.push(("every class".to_owned(), zoo.check().expect("the world is valid")));
    worlds
}

/// Agents' views from several places, a tilted view, and the arena from outside.
fn cameras(world: &World, scene: &Scene) -> Vec<Camera> {
    let agent = &world.agent_params;
    let start = agent.coordinates.map(|metres| metres as f32);
    let eye = |position, heading| {
        let height = agent.agent_height as f32;
        Camera::first_person(position, heading, height, agent.field_of_view as f32)
    };
    let mut cameras: Vec<_> = [0.0, 90.0, 180.0, 270.0]
        .map(|turn| eye(start, agent.heading as f32 + turn))
        .into();
    let [x, y] = scene.arena_size().map(|side| side / 2.0 - 1.0);
    cameras.push(eye([x, y], 225.0));
    cameras.push(eye([-x, y * 0.3], 80.0));
    cameras.push(Camera {
        pitch_deg: -25.0,
        field_of_view_deg: 100.0,
        ..eye([start[0], start[1] - 3.0], 33.0)
    });
    cameras.push(Camera::overview(scene));
    cameras
}

fn check_likeness(size: u32) {
    let Some(mut gpu) = gpu() else { return };
    let mut cpu = CpuRenderer::new();
    let mut failures = Vec::new();
    for (k, (name, world)) in worlds().iter().enumerate() {
        let scene = Scene::from_world(world);
        for (c, camera) in cameras(world, &scene).iter().enumerate() {
            let (mut found, mut expected) = (Frame::new(size, size), Frame::new(size, size));
            gpu.render(&scene, camera, &mut found).expect("the adapter renders");
            cpu.render(&scene, camera, &mut expected);
            let like = likeness(&found, &expected);
            let is_good = like.colors >= 0.99
                && like.classes >= 0.995
                && like.instances >= 0.995
                && like.categories >= 0.995
                && like.depths >= 0.999;
            if !is_good {
                let path = write_difference(&format!("parity-{size}-{k}-{c}"), &found, &expected);
                failures.push(format!("{name}, camera {c}: {like:?}; see {}", path.display()));
            }
        }
    }
    assert!(
        failures.is_empty(),
        "at {size} pixels on {}:\n{}",
        gpu.adapter_name(),
        failures.join("\n")
    );
}

#[test]
fn images_of_84_pixels_are_similar() {
    check_likeness(84);
}

#[test]
fn images_of_256_pixels_are_similar() {
    check_likeness(256);
}

/// A batch on this renderer after several steps.
fn stepped(autoreset: Autoreset, num_threads: usize, renderer: RendererKind) -> Batch {
    let world = world("generator/tests/golden/find_objects-huddle-7-1.json");
    let source = Arc::new(move |episode: Episode| {
        let mut world = world.clone().into_draft();
        world.max_steps = 3 + episode.env as u32;
        world.agent_params.heading = (60.0 * (episode.env as f64 + episode.index as f64)) % 360.0;
        world.agent_params.observation_size = 48;
        world.agent_params.supersampling = 2;
        world.agent_params.modalities = vec![
            Modality::Rgb,
            Modality::Depth,
            Modality::Segmentation,
            Modality::Class,
            Modality::Instance,
        ];
        Ok(world.check().expect("the world is valid"))
    });
    let options = BatchOptions {
        autoreset,
        num_threads,
        renderer,
        ..BatchOptions::default()
    };
    let mut batch = Batch::new(6, source, options).expect("the worlds are valid");
    for _ in 0..5 {
        let actions = [Action::Continuous([3.0, 9.0, 0.0]); 6];
        batch.step(&actions).expect("the actions are valid");
    }
    batch
}

/// Share of values that are similar.
fn matching_share<T: Copy>(found: &[T], expected: &[T], near: impl Fn(T, T) -> bool) -> f64 {
    assert_eq!(found.len(), expected.len());
    share(
        found.iter().zip(expected).filter(|(a, b)| near(**a, **b)).count(),
        found.len(),
    )
}

fn check_images(found: &Images, expected: &Images) {
    let all = [
        matching_share(&found.rgb, &expected.rgb, |a, b| a.abs_diff(b) <= 3),
        matching_share(&found.depth, &expected.depth, |a, b| (a - b).abs() <= 0.01 * b),
        matching_share(&found.category, &expected.category, |a, b| a == b),
        matching_share(&found.class, &expected.class, |a, b| a == b),
        matching_share(&found.instance, &expected.instance, |a, b| a == b),
    ];
    assert!(all.iter().all(|share| *share >= 0.995), "{all:?}");
}

#[test]
fn gpu_batch_matches_a_cpu_batch() {
    let Some(_) = gpu() else { return };
    for autoreset in [Autoreset::NextStep, Autoreset::SameStep] {
        for num_threads in [1, 2] {
            let found = stepped(autoreset, num_threads, RendererKind::Gpu);
            let expected = stepped(autoreset, num_threads, RendererKind::Cpu);
            assert_eq!(
                (found.renderer(), expected.renderer()),
                (RendererKind::Gpu, RendererKind::Cpu)
            );
            let (out, wanted) = (found.outputs(), expected.outputs());
            assert_eq!((&out.rewards, &out.states), (&wanted.rewards, &wanted.states));
            assert_eq!(
                (&out.terminated, &out.truncated),
                (&wanted.terminated, &wanted.truncated)
            );
            check_images(&out.images, &wanted.images);
            if let (Some(out), Some(wanted)) = (found.final_outputs(), expected.final_outputs()) {
                // Episodes that ended in step 5: by a limit of 5 steps, or in a second episode.
                assert_eq!((&out.truncated, &out.states), (&wanted.truncated, &wanted.states));
                check_images(&out.images, &wanted.images);
            }
        }
    }
}

#[test]
fn images_rendered_together_match_those_rendered_separately() {
    let Some(mut gpu) = gpu() else { return };
    let world = world("src/throughput/arena_20.json");
    let scene = Scene::from_world(&world);
    let cameras = cameras(&world, &scene);
    // Two sizes, so that two passes are needed.
    let size = |k: usize| if k.is_multiple_of(3) { 60 } else { 84 };
    let mut together: Vec<Frame> = (0..cameras.len()).map(|k| Frame::new(size(k), size(k))).collect();
    let pictures = together.iter_mut().zip(&cameras);
    let mut pictures: Vec<_> = pictures
        .map(|(frame, camera)| Picture {
            scene: &scene,
            camera: *camera,
            target: frame.target(),
        })
        .collect();
    gpu.draw_batch(&mut pictures).expect("the adapter renders");
    for (k, (frame, camera)) in together.iter().zip(&cameras).enumerate() {
        let mut alone = Frame::new(size(k), size(k));
        gpu.render(&scene, camera, &mut alone).expect("the adapter renders");
        // A corner on the edge of a pixel may fall on either side, depending on the image's position in the target.
        let like = likeness(frame, &alone);
        assert!(like.colors >= 0.999 && like.instances >= 0.999, "picture {k}: {like:?}");
    }
}

#[test]
fn impossible_images_are_errors() {
    let Some(mut gpu) = gpu() else { return };
    let scene = Scene::from_world(&World::default());
    let camera = Camera::overview(&scene);
    let mut short = vec![0; 5];
    let mut target = Target::of_colors([4, 4], &mut short);
    let error = gpu.draw(&scene, &camera, &mut target).expect_err("too short");
    assert_eq!(error, EnvError::PictureSize { width: 4, height: 4 });
    // Rendering still works afterwards.
    gpu.render(&scene, &camera, &mut Frame::new(1, 300))
        .expect("odd sizes are allowed");
    gpu.render(&scene, &camera, &mut Frame::new(0, 0))
        .expect("there is nothing to render");
    gpu.draw_batch(&mut []).expect("there is nothing to render");
}

#[test]
fn environment_renders_on_the_requested_gpu() {
    let Some(gpu) = gpu() else { return };
    let world = world("src/throughput/arena_8.json");
    let mut environment = Environment::with_renderer(world, RendererKind::Gpu).expect("there is an adapter");
    assert!(environment.renderer().device().starts_with(gpu.adapter_name()));
    let found = environment.observe().clone();
    let mut expected = Frame::new(found.width, found.height);
    CpuRenderer::new().render(environment.scene(), &environment.camera(), &mut expected);
    assert!(likeness(&found, &expected).colors >= 0.99);
    let report = RendererReport::make();
    let here = report
        .adapters
        .iter()
        .find(|adapter| adapter.name == gpu.adapter_name());
    let here = here.expect("the report names it");
    assert_eq!((&here.problem, here.is_software), (&None, gpu.is_software()));
    let takes_it = report
        .adapters
        .iter()
        .any(|adapter| !adapter.is_software && adapter.problem.is_none());
    assert_eq!(
        report.auto == RendererKind::Gpu,
        takes_it,
        "auto selects graphics cards, never software"
    );
}

/// A world in which the first interaction picks up a red object; carried objects are shown or not.
fn carrying(shown: bool) -> World {
    let mut thing = Object::new("cube", [0.0, 1.0]);
    (thing.scale, thing.color) = (0.3, Some(Color([0.9, 0.1, 0.1])));
    thing.portable = Some(Portable::default());
    let mut world = WorldDraft::with_objects(vec![thing, Object::new("tree", [1.0, 7.0])]);
    (world.agent_params.carry_limit, world.agent_params.show_carried) = (1, shown);
    world.agent_params.modalities = vec![Modality::Rgb, Modality::Depth, Modality::Instance];
    world.check().expect("the world is valid")
}

#[test]
fn carried_things_look_the_same_alone_and_in_a_batch() {
    if gpu().is_none() {
        return;
    }
    let used = Action::Continuous([0.0, 0.0, 1.0]);
    let drawn = |kind: RendererKind, shown: bool| {
        let mut environment = Environment::with_renderer(carrying(shown), kind).expect("there is an adapter");
        environment.step(used).expect("the episode continues");
        environment.observe().clone()
    };
    let [bare, shows] = [false, true].map(|shown| drawn(RendererKind::Cpu, shown));
    let on_card = drawn(RendererKind::Gpu, true);
    let options = BatchOptions {
        renderer: RendererKind::Gpu,
        autoreset: Autoreset::Disabled,
        ..BatchOptions::default()
    };
    let mut batch = Batch::new(2, Arc::new(|_| Ok(carrying(true))), options).expect("there is an adapter");
    batch.reset().expect("there are worlds");
    batch
        .step(&[used, Action::Continuous([0.0; 3])])
        .expect("the batch continues");
    let images = &batch.outputs().images;
    let pixels = |rgb: &[u8]| rgb.chunks(3).map(<[u8]>::to_vec).collect::<Vec<_>>();
    let [bare_pixels, shown_pixels, card_pixels] = [&bare, &shows, &on_card].map(|frame| pixels(&frame.rgb));
    let batch_pixels = pixels(&images.rgb);
    let unlike = (0..shown_pixels.len()).filter(|pixel| bare_pixels[*pixel] != shown_pixels[*pixel]);
    let places: Vec<usize> = unlike.collect();
    assert!(places.len() > 20, "the carried object is visible: {places:?}");
    for pixel in places {
        assert_eq!(card_pixels[pixel], shown_pixels[pixel], "pixel {pixel} alone");
        assert_eq!(batch_pixels[pixel], shown_pixels[pixel], "pixel {pixel} in a batch");
        assert_ne!(
            batch_pixels[shown_pixels.len() + pixel],
            shown_pixels[pixel],
            "the other agent carries nothing"
        );
    }
    let like = likeness(&shows, &on_card);
    assert!(like.colors >= 0.99 && like.instances >= 0.99, "{like:?}");
}

/// Plain and natural worlds in one batch: the natural ones are rendered on the CPU, bit for bit.
#[test]
fn natural_images_of_a_batch_are_rendered_on_the_cpu() {
    let Some(mut gpu) = gpu() else { return };
    let styles = [Style::Natural, Style::Plain, Style::Natural];
    let scenes = styles.map(|style| {
        let mut world = world("src/throughput/arena_20.json").into_draft();
        world.environment_params.looks = Looks::of(style);
        world.environment_params.looks.fog_in_depth = true;
        world.environment_params.fog_distance = Some(40.0);
        Scene::from_world(&world.check().expect("the world is valid"))
    });
    let camera = Camera::first_person([0.1, -0.2], 20.0, 1.0, 70.0);
    let mut found = styles.map(|_| Frame::new(48, 40));
    let pictures = scenes.iter().zip(&mut found);
    let mut pictures: Vec<_> = pictures
        .map(|(scene, frame)| Picture {
            scene,
            camera,
            target: frame.target(),
        })
        .collect();
    gpu.draw_batch(&mut pictures).expect("the adapter renders");
    for ((style, scene), found) in styles.iter().zip(&scenes).zip(&found) {
        let mut expected = Frame::new(48, 40);
        let drawn = CpuRenderer::new().draw(scene, &camera, &mut expected.target());
        drawn.expect("the image renders");
        let like = likeness(found, &expected);
        let least = if *style == Style::Natural { 1.0 } else { 0.99 };
        assert!(like.colors >= least && like.depths >= least, "{style:?}: {like:?}");
    }
}
