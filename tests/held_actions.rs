//! Tests that the number of time steps per action changes only the transitions: equal motion over equal time gets the same reward
//! for time, and ends at the same second.

use driftworld::env::{Action, Environment};
use driftworld::generator::Sampler;
use driftworld::similarity::{Weights, world_distance};
use driftworld::spec::{ActionModel, Element, StateFeature, Variant, WorldDraft};
use driftworld::tasks;

/// The result of an episode: the agent's final pose, the duration in seconds, the reward, and whether a limit truncated it.
#[derive(Debug)]
struct Course {
    end: ([f32; 2], f32),
    seconds: f64,
    paid: f64,
    truncated: bool,
}

/// Runs a whole episode with one motion.
fn run_episode(world: &WorldDraft, motion: [f64; 3]) -> Course {
    let mut environment = Environment::new(world.clone().check().expect("the world is valid"));
    let mut truncated = false;
    while !environment.ended() {
        let step = environment.step(Action::Continuous(motion));
        truncated = step.unwrap_or_else(|error| panic!("{error}")).truncated;
    }
    let agent = environment.agent();
    Course {
        end: (agent.position, agent.heading_deg),
        seconds: environment.seconds(),
        paid: environment.episode_return(),
        truncated,
    }
}

fn draw(variant: &Variant) -> WorldDraft {
    let world = Sampler::new(variant, 5).world(1);
    let mut world = world.unwrap_or_else(|error| panic!("{error}")).into_draft();
    world.agent_params.action_model = ActionModel::ByVelocity;
    world
}

#[test]
fn held_action_gets_reward_and_limit_by_the_second() {
    let mut cut_off = 0;
    for task in tasks::built_in_names() {
        let variants = tasks::variants(task).expect("built-in tasks are valid");
        for (number, variant) in variants.iter().enumerate().step_by(3) {
            let mut world = draw(variant);
            for motion in [[0.0; 3], [1.0 + number as f64 / 4.0, 9.0, 0.0], [5.0, -40.0, 0.0]] {
                world.agent_params.frame_skip = 1;
                let free = run_episode(&world, motion);
                for hold in [2, 3, 7, 10] {
                    world.agent_params.frame_skip = hold;
                    let held = run_episode(&world, motion);
                    let name = format!("{} held {hold} in {motion:?}: {free:?}, {held:?}", variant.id());
                    assert_eq!((free.end, free.truncated), (held.end, held.truncated), "{name}");
                    assert!((free.seconds - held.seconds).abs() < 1e-9, "{name}");
                    assert!((free.paid - held.paid).abs() < 1e-6, "{name}");
                    cut_off += usize::from(held.truncated);
                }
            }
        }
    }
    assert!(cut_off > 100, "too few episodes were truncated: {cut_off}");
}

#[test]
fn time_step_of_any_length_gets_reward_and_limit_by_the_second() {
    for task in tasks::built_in_names() {
        let variants = tasks::variants(task).expect("built-in tasks are valid");
        let mut world = draw(&variants[0]);
        world.objects.clear();
        let limit = world.max_seconds;
        assert!(limit > 0.0 && world.max_steps == 0, "{task} has a limit of seconds");
        for time_step in [0.02, 0.05, 0.1, 0.25] {
            world.agent_params.time_step = time_step;
            let course = run_episode(&world, [0.0; 3]);
            let pay = world.rules.reward_per_second * limit;
            assert!(
                (course.seconds - limit).abs() < 1e-6 && course.truncated,
                "{task}: {course:?}"
            );
            assert!((course.paid - pay).abs() < 1e-6, "{task}: {course:?}, expected {pay}");
        }
    }
}

#[test]
fn held_variants_change_only_the_transitions() {
    let mut compared = 0;
    for task in tasks::built_in_names() {
        let variants = tasks::variants(task).expect("built-in tasks are valid");
        let first = draw(&variants[0]).check().expect("the world is valid");
        for held in variants.iter().filter(|variant| variant.name().ends_with("held")) {
            let world = draw(held).check().expect("the world is valid");
            assert!(world.agent_params.frame_skip > 1, "{}", held.id());
            let distance = world_distance(&first, &world, &Weights::default());
            assert_eq!(distance.differs_in(), [Element::T], "{}", held.id());
            let world = world.edit(|world| world.agent_params.frame_skip = 1);
            assert_eq!(world.as_ref(), Ok(&first), "{}", held.id());
            compared += 1;
        }
    }
    assert_eq!(compared, 7);
}

#[test]
fn remaining_steps_follow_from_a_limit_of_seconds() {
    let mut world = WorldDraft {
        max_seconds: 1.0,
        ..WorldDraft::default()
    };
    world.agent_params.frame_skip = 4;
    world.agent_params.state_features = vec![StateFeature::StepsLeft];
    let mut environment = Environment::new(world.check().expect("the world is valid"));
    let mut left = vec![environment.state_vector()[0]];
    while !environment.ended() {
        environment
            .step(Action::Continuous([0.0; 3]))
            .unwrap_or_else(|error| panic!("{error}"));
        left.push(environment.state_vector()[0]);
    }
    assert_eq!(left, [1.0, 2.0 / 3.0, 1.0 / 3.0, 0.0]);
    assert!((environment.seconds() - 1.0).abs() < 1e-12);
}
