//! Carried objects are shown at the bottom of the agent's colour image, if the world enables it, and nowhere else.

use std::sync::Arc;

use driftworld_env::{
    Action, Agent, Batch, BatchOptions, Camera, CpuRenderer, Environment, Frame, RandomAgent, Target,
};
use driftworld_spec::{Color, Modality, Object, World, WorldDraft};
use proptest::prelude::*;

use crate::fixtures::{key, thing};

const USE: Action = Action::Continuous([0.0, 0.0, 1.0]);

/// Carriable objects of several classes within reach, with this carry limit.
fn draft(size: [u32; 2], limit: u32, colors: &[[f64; 3]]) -> WorldDraft {
    let mut world = WorldDraft::default();
    let place = |number: usize| [0.25 * number as f64 - 0.4, 1.1 + 0.1 * number as f64];
    let carried = |(number, color): (usize, &[f64; 3])| -> Object {
        let mut own = key("thing", place(number));
        own.class = String::from(["key", "geometric", "mushroom"][number % 3]);
        (own.scale, own.color) = (0.3, Some(Color(*color)));
        own
    };
    world.objects = colors.iter().enumerate().map(carried).collect();
    world.objects.push(thing("tree", "tree", [0.0, 6.0]));
    world.environment_params.map_size = [20.0, 20.0];
    let agent = &mut world.agent_params;
    agent.carry_limit = limit;
    (agent.observation_size, agent.observation_width) = (size[1], Some(size[0]));
    agent.modalities = vec![
        Modality::Rgb,
        Modality::Depth,
        Modality::Segmentation,
        Modality::Class,
        Modality::Instance,
    ];
    world.seed = Some(3);
    world
}

fn pair(world: &WorldDraft) -> [Environment; 2] {
    [false, true].map(|shown| {
        let mut world = world.clone();
        world.agent_params.show_carried = shown;
        Environment::new(world.check().expect("the world is valid"))
    })
}

fn num_carried(environment: &Environment) -> usize {
    environment.objects().iter().filter(|own| own.carried).count()
}

/// Rows and columns of the pixels that differ.
fn changed(one: &Frame, other: &Frame) -> Vec<[u32; 2]> {
    let pixels = one.rgb.chunks(3).zip(other.rgb.chunks(3)).enumerate();
    let unlike = pixels.filter(|(_, (own, their))| own != their);
    unlike
        .map(|(pixel, _)| [pixel as u32 / one.width, pixel as u32 % one.width])
        .collect()
}

proptest! {
    #![proptest_config(ProptestConfig::with_cases(crate::tier::quick_or_full(24, 40)))]

    /// Only colours change, only in the lowest fifth (or eight rows), and only while something is carried.
    #[test]
    fn carried_things_change_only_the_bottom_of_the_colour_image(
        size in prop::array::uniform2(8u32..90),
        supersampling in 1u32..3,
        limit in 0u32..5,
        colors in prop::collection::vec(prop::array::uniform3(0.0..1.0f64), 1..5),
        seed in any::<u64>(),
    ) {
        let mut world = draft(size, limit, &colors);
        world.agent_params.supersampling = supersampling;
        let [mut bare, mut shows] = pair(&world);
        let mut agent = RandomAgent::new(seed);
        let side = (size[1] / 5).max(8).min(size[0]).min(size[1]);
        for number in 0..12 {
            let action = if number % 2 == 0 { USE } else { agent.act(&bare) };
            prop_assert_eq!(bare.step(action), shows.step(action));
            let (one, other) = (bare.observe().clone(), shows.observe().clone());
            prop_assert_eq!(one.depth, other.depth.clone());
            prop_assert_eq!(&one.category, &other.category);
            prop_assert_eq!(&one.class, &other.class);
            prop_assert_eq!(&one.instance, &other.instance);
            let one = bare.observe().clone();
            let changed = changed(&one, &other);
            let count = num_carried(&shows).min((size[0] / side) as usize) as u32;
            let left = (size[0] - side * count) / 2;
            prop_assert!(changed.iter().all(|[row, column]| {
                *row >= size[1] - side && (left..left + side * count).contains(column)
            }), "outside of {count} squares of {side}: {changed:?}");
            prop_assert_eq!(changed.is_empty(), count == 0, "{} are carried", count);
            // Other cameras do not show it.
            let camera = Camera::overview(bare.scene());
            let [a, b] = [&mut bare, &mut shows].map(|each| each.render(&camera, 40, 30).expect("the size is valid"));
            prop_assert_eq!(a.rgb, b.rgb);
        }
    }

    /// A batch shows the same pixels as single environments, with any instruction set.
    #[test]
    fn batches_and_renderers_show_carried_things_alike(colors in prop::collection::vec(prop::array::uniform3(0.0..1.0f64), 1..4)) {
        let world = draft([60, 50], 3, &colors);
        let [_, mut environment] = pair(&world);
        for _ in 0..colors.len().min(2) {
            environment.step(USE).expect("the episode continues");
        }
        prop_assert!(num_carried(&environment) > 0);
        let expected = environment.observe().clone();
        prop_assert_eq!(&environment.observe_at(60, 50).expect("the size is valid").rgb, &expected.rgb);
        let (scene, camera) = (environment.scene(), environment.camera());
        for (name, mut renderer) in CpuRenderer::each_instruction_set() {
            let mut frame = Frame::new(60, 50);
            renderer.render(scene, &camera, &mut frame);
            environment.draw_carried(&mut renderer, &mut frame.target());
            prop_assert_eq!(&frame.rgb, &expected.rgb, "{}", name);
        }
        let mut batch = {
            let state = environment.state();
            Batch::new(2, Arc::new(move |_| Ok(state.clone())), BatchOptions::default()).expect("there is memory")
        };
        batch.reset().expect("there are worlds");
        prop_assert_eq!(&batch.outputs().images.rgb[..expected.rgb.len()], &expected.rgb[..]);
        // Without colour images, carried objects are not shown.
        let mut depth = vec![0.0; 60 * 50];
        let mut target = Target { width: 60, height: 50, depth: Some(&mut depth), ..Target::default() };
        environment.draw_carried(&mut CpuRenderer::new(), &mut target);
        prop_assert!(depth.iter().all(|metres| *metres == 0.0));
    }
}

#[test]
fn carried_thing_appears_in_its_colour_and_disappears() {
    let seen = |color: [f64; 3]| {
        let [mut bare, mut shows] = pair(&draft([84, 84], 1, &[color]));
        let mut differences = Vec::new();
        for _ in 0..3 {
            for each in [&mut bare, &mut shows] {
                each.step(USE).expect("the episode continues");
            }
            let (one, other) = (bare.observe().clone(), shows.observe().clone());
            differences.push(changed(&one, &other));
        }
        assert!(!differences[0].is_empty() && differences[1].is_empty() && !differences[2].is_empty());
        let picture = shows.observe();
        let pixels = differences[0]
            .iter()
            .map(|[row, column]| 3 * (row * 84 + column) as usize);
        let sums = pixels.fold([0_u32; 3], |sum, start| {
            [0, 1, 2].map(|channel| sum[channel] + u32::from(picture.rgb[start + channel]))
        });
        (differences[0].len(), sums)
    };
    let (count, [red, green, blue]) = seen([1.0, 0.0, 0.0]);
    assert!((20..200).contains(&count), "{count} pixels of 289");
    assert!(red > 4 * green.max(blue), "{red} {green} {blue}");
    let (_, [red, green, blue]) = seen([0.0, 0.0, 1.0]);
    assert!(blue > 4 * red.max(green), "{red} {green} {blue}");
}

#[test]
fn saved_world_shows_the_same_things() {
    let [_, mut environment] = pair(&draft([50, 50], 2, &[[0.9, 0.1, 0.1], [0.1, 0.9, 0.1]]));
    for _ in 0..2 {
        environment.step(USE).expect("the episode continues");
    }
    assert_eq!(num_carried(&environment), 2);
    let text = environment.state().to_json();
    let mut again = Environment::new(World::from_json("state", &text).expect("a state is a valid world"));
    assert_eq!(again.observe().rgb, environment.observe().rgb);
}
