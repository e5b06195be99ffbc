//! A batch gives the same numbers and pixels as separate environments, whatever the number of threads and the autoreset mode.

use std::sync::Arc;

use driftworld_env::{
    Action, Autoreset, Batch, BatchOptions, CpuRenderer, EnvError, Environment, Episode, Frame, WorldSource,
};
use driftworld_spec::{Modality, MotionModel, Object, Stimulus, World, WorldDraft};

const NUM_ENVS: usize = 5;

/// A small world that depends on the episode: obstacles, a predator, and an end by step limit or touch.
fn draft(episode: Episode) -> WorldDraft {
    let shift = (episode.env * 3 + episode.index as usize * 7) as f64;
    let mut target = Object::new("cube", [0.0, 2.0 + shift % 5.0]);
    target.reward = 1.0 + shift;
    target.reward_stimulus = vec![Stimulus::AgentCollide];
    target.destroy_stimulus = vec![Stimulus::AgentCollide];
    let mut hunter = Object::new("barrel", [6.0, shift % 4.0 - 2.0]);
    hunter.motion_model = MotionModel::Predator;
    hunter.speed = 2.0;
    let mut world = WorldDraft {
        max_steps: 9 + episode.env as u32,
        objects: vec![target, hunter, Object::new("tree", [-4.0, 9.0])],
        ..WorldDraft::default()
    };
    world.environment_params.map_size = [30.0, 30.0];
    world.agent_params.observation_size = 24;
    world.agent_params.modalities = vec![
        Modality::Rgb,
        Modality::Depth,
        Modality::Segmentation,
        Modality::Instance,
    ];
    world.rules.success = vec![driftworld_spec::EndCondition::AllCollected];
    world
}

fn world(episode: Episode) -> World {
    draft(episode).check().expect("the world is valid")
}

fn source() -> WorldSource {
    Arc::new(|episode| Ok(world(episode)))
}

fn action(step: usize, env: usize) -> Action {
    let turn = ((step * 31 + env * 17) % 60) as f64 - 30.0;
    Action::Continuous([8.0, turn, 0.0])
}

fn batch(autoreset: Autoreset, num_threads: usize) -> Batch {
    Batch::new(
        NUM_ENVS,
        source(),
        BatchOptions {
            autoreset,
            num_threads,
            ..BatchOptions::default()
        },
    )
    .expect("the worlds are valid")
}

/// An environment's view, rendered separately.
fn picture(environment: &Environment) -> Frame {
    let mut frame = Frame::new(24, 24);
    CpuRenderer::new().render(environment.scene(), &environment.camera(), &mut frame);
    frame
}

/// Compares one environment's images and state in `outputs` with those of a separate environment.
fn assert_matches(outputs: &driftworld_env::Outputs, env: usize, alone: &Environment) {
    let frame = picture(alone);
    let pixels = 24 * 24;
    let images = &outputs.images;
    assert!(
        images.rgb[env * 3 * pixels..][..3 * pixels] == frame.rgb,
        "colour of {env}"
    );
    assert!(images.depth[env * pixels..][..pixels] == frame.depth, "depth of {env}");
    assert!(
        images.category[env * pixels..][..pixels] == frame.category,
        "categories of {env}"
    );
    assert!(
        images.instance[env * pixels..][..pixels] == frame.instance,
        "instances of {env}"
    );
    assert!(images.class.is_empty(), "no classes were requested");
    assert_eq!(
        outputs.states[env * outputs.state_len..][..outputs.state_len],
        alone.state_vector()[..]
    );
}

#[test]
fn batch_equals_separate_environments() {
    for autoreset in [Autoreset::NextStep, Autoreset::SameStep] {
        for num_threads in [1, 2, 3] {
            let mut batch = batch(autoreset, num_threads);
            let mut alone: Vec<Environment> = (0..NUM_ENVS)
                .map(|env| Environment::new(world(Episode { env, index: 0 })))
                .collect();
            let mut episodes = [0; NUM_ENVS];
            for step in 0..60 {
                let actions: Vec<Action> = (0..NUM_ENVS).map(|env| action(step, env)).collect();
                batch.step(&actions).expect("the actions are valid");
                for env in 0..NUM_ENVS {
                    let next = |episodes: &mut [u64; NUM_ENVS]| {
                        episodes[env] += 1;
                        Environment::new(world(Episode {
                            env,
                            index: episodes[env],
                        }))
                    };
                    let outputs = batch.outputs();
                    if alone[env].ended() {
                        // Next-step autoreset: this step only begins the next episode.
                        alone[env] = next(&mut episodes);
                        assert_eq!((outputs.rewards[env], outputs.terminated[env]), (0.0, false));
                        assert!(!outputs.truncated[env]);
                    } else {
                        let found = alone[env].step(actions[env]).expect("the action is valid");
                        assert_eq!(outputs.rewards[env], found.reward, "step {step} of {env}");
                        assert_eq!(outputs.terminated[env], found.terminated);
                        assert_eq!(outputs.truncated[env], found.truncated);
                        assert_eq!(outputs.success[env], found.success);
                        if found.ended() && autoreset == Autoreset::SameStep {
                            let last = batch.final_outputs().expect("same-step autoreset keeps them");
                            assert_matches(last, env, &alone[env]);
                            assert_eq!(last.rewards[env], found.reward);
                            alone[env] = next(&mut episodes);
                        }
                    }
                    assert_matches(outputs, env, &alone[env]);
                    assert_eq!(batch.episode(env).map(|episode| episode.index), Some(episodes[env]));
                }
            }
            assert!(
                episodes.iter().all(|episodes| *episodes > 2),
                "episodes ended: {episodes:?}"
            );
        }
    }
}

#[test]
fn ended_episode_without_autoreset_waits_for_its_reset() {
    let mut batch = batch(Autoreset::Disabled, 1);
    let still = [Action::Continuous([0.0; 3]); NUM_ENVS];
    for _ in 0..9 {
        batch.step(&still).expect("no episode has ended");
    }
    assert_eq!(batch.outputs().truncated, [true, false, false, false, false]);
    let before = batch.outputs().clone();
    let error = batch.step(&still).expect_err("environment 0 has ended");
    assert!(matches!(error, EnvError::BatchAction { env: 0, .. }), "{error}");
    assert_eq!(batch.outputs().states, before.states, "nothing was changed");
    assert_eq!(batch.environment(1).map(Environment::num_steps), Some(9));

    batch
        .reset_where_while(&[true, false, false, false, false], &|| true)
        .expect("the source has a next world");
    assert_eq!(batch.episode(0), Some(Episode { env: 0, index: 1 }));
    assert_eq!(
        batch.environment(1).map(Environment::num_steps),
        Some(9),
        "the others continue"
    );
    batch.step(&still).expect("environment 0 has restarted");
    assert!(
        batch.reset_where_while(&[true], &|| true).is_err(),
        "one action for five environments"
    );
    batch.reset().expect("the source has worlds");
    assert!((0..NUM_ENVS).all(|env| batch.environment(env).map(Environment::num_steps) == Some(0)));
}

#[test]
fn one_bad_action_changes_no_environment() {
    let mut batch = batch(Autoreset::NextStep, 2);
    let mut actions = [Action::Continuous([5.0, 0.0, 0.0]); NUM_ENVS];
    actions[3] = Action::Continuous([f64::NAN, 0.0, 0.0]);
    let error = batch.step(&actions).expect_err("not a number");
    assert!(
        error
            .to_string()
            .starts_with("environment 3 of the batch: action: found"),
        "{error}"
    );
    assert!((0..NUM_ENVS).all(|env| batch.environment(env).map(Environment::num_steps) == Some(0)));
    let error = batch.step(&actions[..2]).expect_err("two actions for five");
    assert!(matches!(error, EnvError::BatchLength { found: 2, num_envs: 5 }));
}

#[test]
fn missing_world_stops_only_its_environment() {
    let source: WorldSource = Arc::new(|episode| match episode {
        Episode { env: 1 | 60, index: 1 } => Err("the well is dry".to_owned()),
        _ => Ok(world(episode)
            .edit(|world| world.max_steps = 1)
            .expect("one step is valid")),
    });
    for num_threads in [1, 3] {
        let options = BatchOptions {
            num_threads,
            ..options(Autoreset::NextStep)
        };
        let mut batch = Batch::new(64, Arc::clone(&source), options).expect("the first episodes have worlds");
        let still = [Action::Continuous([0.0; 3]); 64];
        batch.step(&still).expect("every environment steps");
        for _ in 0..2 {
            let error = batch
                .step(&still)
                .expect_err("environments 1 and 60 have no second world");
            assert_eq!(
                error.to_string(),
                "environment 1 of the batch: no world for episode 1: the well is dry"
            );
        }
        assert_eq!(batch.episode(0), Some(Episode { env: 0, index: 1 }));
    }
}

/// A batch that does not fit into the CPU cache is stepped differently from a small one.
#[test]
fn large_batch_equals_separate_environments() {
    const MANY: usize = 150;
    for num_threads in [1, 3] {
        let options = BatchOptions {
            num_threads,
            ..options(Autoreset::NextStep)
        };
        let mut batch = Batch::new(MANY, source(), options).expect("the worlds are valid");
        let mut alone: Vec<Environment> = (0..MANY)
            .map(|env| Environment::new(world(Episode { env, index: 0 })))
            .collect();
        for step in 0..4 {
            let actions: Vec<Action> = (0..MANY).map(|env| action(step, env)).collect();
            batch.step(&actions).expect("the actions are valid");
            for (env, alone) in alone.iter_mut().enumerate() {
                // Targets are reached at different times; later episodes are tested with smaller batches.
                if !alone.ended() {
                    let found = alone.step(actions[env]).expect("the action is valid");
                    assert_eq!(batch.outputs().rewards[env], found.reward, "step {step} of {env}");
                    assert_matches(batch.outputs(), env, alone);
                }
            }
        }
        assert!(alone.iter().filter(|alone| !alone.ended()).count() > MANY / 4);
    }
}

#[test]
fn worlds_with_different_images_are_refused() {
    let source: WorldSource = Arc::new(|episode| {
        let mut world = draft(episode);
        world.agent_params.observation_size = 24 + episode.env as u32;
        Ok(world.check().expect("the world is valid"))
    });
    let Err(error) = Batch::new(2, source, BatchOptions::default()) else {
        panic!("the images differ");
    };
    assert!(error.to_string().contains("25 × 25"), "{error}");
    let source: WorldSource = Arc::new(|episode| {
        let mut world = draft(episode);
        world.agent_params.instruction = vec![1.0; episode.env];
        Ok(world.check().expect("the world is valid"))
    });
    let Err(error) = Batch::new(2, source, BatchOptions::default()) else {
        panic!("the instructions differ");
    };
    assert!(error.to_string().contains("instructions of length 1"), "{error}");
    assert!(Batch::new(0, self::source(), BatchOptions::default()).is_err());
}

fn options(autoreset: Autoreset) -> BatchOptions {
    BatchOptions {
        autoreset,
        ..BatchOptions::default()
    }
}

#[test]
fn too_large_outputs_are_refused_before_allocating() {
    let large = |episode: Episode| {
        let mut world = draft(episode);
        world.agent_params.observation_size = 4096;
        world.check().expect("the world is valid")
    };
    // Colour, metres, categories and objects: 12 bytes per pixel, 201 MB per environment; 85 of them take 17.1 GB, and 16 GiB
    // are 17.18 GB.
    let made = |num_envs, autoreset| {
        let source: WorldSource = Arc::new(move |episode| {
            assert_eq!(episode.env, 0, "the first world determines the size of all");
            Ok(large(episode))
        });
        Batch::new(num_envs, source, options(autoreset)).err()
    };
    for (num_envs, autoreset) in [
        (86, Autoreset::NextStep),
        (65_536, Autoreset::Disabled),
        (43, Autoreset::SameStep),
    ] {
        let refused = made(num_envs, autoreset);
        let Some(EnvError::BatchMemory { found, most }) = refused else {
            panic!("found {refused:?}");
        };
        let copies = 1 + u64::from(autoreset == Autoreset::SameStep);
        assert_eq!(most, driftworld_env::MAX_BATCH_BYTES);
        assert!(
            found >= copies * num_envs as u64 * 4096 * 4096 * 12 && found > most,
            "{found}"
        );
    }
}

#[test]
fn stopped_reset_leaves_the_rest_to_the_next_reset() {
    let mut batch = batch(Autoreset::Disabled, 1);
    let left = std::sync::atomic::AtomicU32::new(2);
    let go_on = || {
        let take = |left: u32| left.checked_sub(1);
        let order = std::sync::atomic::Ordering::Relaxed;
        left.fetch_update(order, order, take).is_ok()
    };
    assert_eq!(
        batch.reset_where_while(&[true; NUM_ENVS], &go_on),
        Err(EnvError::Stopped)
    );
    let episodes = |batch: &Batch| -> Vec<u64> {
        let episode = |env| batch.episode(env).map_or(0, |episode| episode.index);
        (0..NUM_ENVS).map(episode).collect()
    };
    assert_eq!(episodes(&batch), [1, 1, 0, 0, 0]);
    let actions: Vec<Action> = (0..NUM_ENVS).map(|env| action(0, env)).collect();
    assert!(matches!(
        batch.step(&actions),
        Err(EnvError::BatchAction { env: 2, .. })
    ));
    batch
        .reset_where_while(&[false, false, true, true, true], &|| true)
        .expect("the worlds are valid");
    assert_eq!(episodes(&batch), [1; NUM_ENVS]);
    batch.step(&actions).expect("all episodes have started");
    let made = Batch::with_catalogue_while(
        NUM_ENVS,
        source(),
        BatchOptions::default(),
        &driftworld_env::Catalogue::default(),
        &|| false,
    );
    assert_eq!(made.err(), Some(EnvError::Stopped));
}
