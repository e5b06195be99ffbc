//! Worlds of a batch may request different images: each environment fills the images of its own world and leaves the others 0.

use std::sync::Arc;

use driftworld_env::{
    Action, Autoreset, Batch, BatchOptions, CpuRenderer, DepthForm, EnvError, Frame, Images, WorldSource,
};
use driftworld_spec::{Modality, Object, World, WorldDraft};
use proptest::prelude::*;

const ALL: [Modality; 5] = [
    Modality::Rgb,
    Modality::Depth,
    Modality::Segmentation,
    Modality::Class,
    Modality::Instance,
];
const SIDE: usize = 12;

/// A world with the modalities in this bit mask.
fn world(requested: u8) -> World {
    let mut world = WorldDraft {
        max_steps: 3,
        objects: vec![Object::new("cube", [0.0, 3.0]), Object::new("tree", [2.0, 6.0])],
        ..WorldDraft::default()
    };
    world.environment_params.map_size = [20.0, 20.0];
    world.agent_params.observation_size = SIDE as u32;
    world.agent_params.modalities = (0..5)
        .filter(|bit| requested >> bit & 1 == 1)
        .map(|bit| ALL[bit])
        .collect();
    world.check().expect("the world is valid")
}

/// Every image of an environment as numbers; empty if there is none.
fn numbers(images: &Images, env: usize) -> [Vec<f64>; 5] {
    fn part<T: Copy + Into<f64>>(all: &[T], env: usize, per_pixel: usize) -> Vec<f64> {
        let length = per_pixel * SIDE * SIDE;
        let own = all.get(env * length..(env + 1) * length).unwrap_or_default();
        own.iter().map(|value| (*value).into()).collect()
    }
    let depth = part(&images.depth, env, 1);
    [
        part(&images.rgb, env, 3),
        depth,
        part(&images.category, env, 1),
        part(&images.class, env, 1),
        part(&images.instance, env, 1),
    ]
}

fn rendered_separately(batch: &Batch, env: usize) -> [Vec<f64>; 5] {
    let environment = batch.environment(env).expect("there is such an environment");
    let mut frame = Frame::new(SIDE as u32, SIDE as u32);
    CpuRenderer::new().render(environment.scene(), &environment.camera(), &mut frame);
    [
        frame.rgb.iter().map(|value| f64::from(*value)).collect(),
        frame.depth.iter().map(|value| f64::from(*value)).collect(),
        frame.category.iter().map(|value| f64::from(*value)).collect(),
        frame.class.iter().map(|value| f64::from(*value)).collect(),
        frame.instance.iter().map(|value| f64::from(*value)).collect(),
    ]
}

proptest! {
    #![proptest_config(ProptestConfig::with_cases(crate::tier::quick_or_full(24, 32)))]

    #[test]
    fn each_environment_has_the_images_of_its_world(
        requested in prop::collection::vec(prop::array::uniform4(0_u8..32), 3), there in 0_u8..32, threads in 1_usize..3,
    ) {
        let there = requested.iter().flatten().fold(there, |all, one| all | one);
        let episodes = requested.clone();
        let source: WorldSource = Arc::new(move |episode| Ok(world(episodes[episode.env][episode.index as usize % 4])));
        let options = BatchOptions {
            autoreset: Autoreset::NextStep,
            num_threads: threads,
            modalities: Some((0..5).filter(|bit| there >> bit & 1 == 1).map(|bit| ALL[bit]).collect()),
            depth: DepthForm::Millimetres,
            ..BatchOptions::default()
        };
        let mut batch = Batch::new(3, source, options).expect("every object has a position");
        for step in 0..14 {
            for env in 0..3 {
                let own = requested[env][batch.episode(env).expect("there is such an environment").index as usize % 4];
                let (found, expected) = (numbers(&batch.outputs().images, env), rendered_separately(&batch, env));
                for bit in 0..5 {
                    if there >> bit & 1 == 0 {
                        prop_assert!(found[bit].is_empty());
                    } else if own >> bit & 1 == 0 {
                        prop_assert!(found[bit].iter().all(|number| *number == 0.0), "step {}, {:?} is not blank", step, ALL[bit]);
                        prop_assert_eq!(found[bit].len(), expected[bit].len());
                    } else {
                        prop_assert_eq!(&found[bit], &expected[bit], "step {}, {:?}", step, ALL[bit]);
                    }
                }
                if there >> 1 & 1 == 1 {
                    let millimetres = &batch.outputs().images.depth_millimetres[env * SIDE * SIDE..][..SIDE * SIDE];
                    prop_assert_eq!(millimetres.iter().all(|depth| *depth == 0), own >> 1 & 1 == 0);
                }
            }
            batch.step(&[Action::Continuous([3.0, 20.0, 0.0]); 3]).expect("the episodes continue");
        }
    }
}

#[test]
fn world_with_a_modality_the_batch_lacks_is_refused() {
    let source: WorldSource = Arc::new(|episode| Ok(world(if episode.env == 0 { 1 } else { 3 })));
    let found = Batch::new(2, source, BatchOptions::default()).err();
    assert!(matches!(found, Some(EnvError::BatchImages { env: 1, .. })), "{found:?}");
}
