//! Tests of experts in their own worlds and in others.

use driftworld_spec::{Color, EndCondition, Object, Respawn, Stimulus, World, WorldDraft};
use proptest::prelude::*;

use super::*;
use crate::agents::{Agent, OnRailsAgent};
use crate::sim::{Environment, Step};

const RED: Color = Color([1.0, 0.0, 0.0]);
const BLUE: Color = Color([0.0, 0.0, 1.0]);

fn cube(place: [f64; 2], color: Color, reward: f64, tag: &str) -> Object {
    let mut cube = Object::new("geometric", place);
    (cube.color, cube.reward, cube.tag) = (Some(color), reward, Some(tag.to_owned()));
    cube.reward_stimulus = vec![Stimulus::AgentCollide];
    cube.destroy_stimulus = vec![Stimulus::AgentCollide];
    cube
}

/// Cubes of two colours: `paying` cubes have a reward of 10, `other` ones of -5.
fn world(paying: Color, other: Color) -> WorldDraft {
    let mut world = WorldDraft::default();
    world.environment_params.map_size = [30.0, 30.0];
    world.rules.success = vec![EndCondition::AllCollected];
    world.max_steps = 300;
    for (index, place) in [[0.0, 9.0], [8.0, 0.0], [-9.0, 3.0], [4.0, -9.0]]
        .into_iter()
        .enumerate()
    {
        let pays = index % 2 == 0;
        let (color, reward) = if pays { (paying, 10.0) } else { (other, -5.0) };
        world
            .objects
            .push(cube(place, color, reward, if pays { "good" } else { "bad" }));
    }
    world
}

fn checked(draft: WorldDraft) -> World {
    draft.check().expect("the world is valid")
}

#[test]
fn expert_goes_for_the_colour_that_pays_at_home() {
    let (red, blue) = (checked(world(RED, BLUE)), checked(world(BLUE, RED)));
    let expertise = Expertise::default();
    let own = expertise.at_home(&blue).expect("the expert runs");
    assert_eq!((own.earned, own.success), (20.0, true));
    let other = expertise.abroad(&red, &blue).expect("the expert runs");
    assert!(other.earned <= -10.0 && !other.success, "{other:?}");
    // The order of the objects in the home world makes no difference.
    let mut reversed = world(RED, BLUE);
    reversed.objects.reverse();
    assert_eq!(
        expertise.abroad(&checked(reversed), &blue).expect("the expert runs"),
        other
    );
}

#[test]
fn objects_believed_to_be_used_up_are_left_alone_after_one_try() {
    let home = checked(world(RED, BLUE));
    let mut unrewarding = world(RED, BLUE);
    unrewarding.rules.success.clear();
    for object in &mut unrewarding.objects {
        (object.reward, object.destroy_stimulus) = (-1.0, Vec::new());
    }
    let found = Expertise::default()
        .abroad(&home, &checked(unrewarding))
        .expect("the expert runs");
    assert_eq!(found.earned, -2.0, "each red cube once");
}

#[test]
fn objects_of_classes_unknown_at_home_are_ignored() {
    let mut barrels = world(RED, BLUE);
    for object in &mut barrels.objects {
        object.class = "barrel".to_owned();
    }
    let (home, barrels) = (checked(world(RED, BLUE)), checked(barrels));
    let found = Expertise::default().abroad(&home, &barrels).expect("the expert runs");
    assert_eq!((found.earned, found.success, found.steps), (0.0, false, 300));
}

#[test]
fn coming_near_does_not_count_as_a_touch() {
    for range in [0.0, 1.5, 2.0, 4.0] {
        let pays = |reward: f64| {
            let mut draft = WorldDraft::default();
            let mut object = cube([0.0, 8.0], RED, reward, "any");
            object.range_stimulus_distance = range;
            draft.objects.push(object);
            checked(draft)
        };
        let (home, abroad) = (pays(50.0), pays(49.0));
        let expertise = Expertise::default();
        let run = |found: Result<ExpertRun, EnvError>| found.expect("the expert runs");
        let visitor = run(expertise.abroad(&home, &abroad));
        assert_eq!(
            (visitor.earned, visitor),
            (49.0, run(expertise.at_home(&abroad))),
            "range {range}"
        );
    }
}

proptest! {
    #![proptest_config(ProptestConfig::with_cases(24))]

    #[test]
    fn running_abroad_in_the_home_world_equals_running_at_home(
        places in prop::collection::vec((-13_i8..=13, -13_i8..=13), 1..8),
        rewards in prop::collection::vec((-2_i8..=3, 0_u8..4), 8),
        frame_skip in 1_u32..3,
    ) {
        let mut draft = WorldDraft::default();
        draft.environment_params.map_size = [30.0, 30.0];
        (draft.max_steps, draft.seed, draft.agent_params.frame_skip) = (120, Some(7), frame_skip);
        for ((x, y), (reward, kind)) in places.into_iter().zip(rewards) {
            let mut object = cube([f64::from(x), f64::from(y)], RED, f64::from(reward), "any");
            match kind {
                0 => object.reward_probability = 0.5,
                1 => object.destroy_stimulus.clear(),
                2 => object.respawn = Some(Respawn { delay: 2.0, radius: 0.0 }),
                _ => (),
            }
            draft.objects.push(object);
        }
        let world = checked(draft);
        let expertise = Expertise::default();
        prop_assert_eq!(expertise.abroad(&world, &world), expertise.at_home(&world));
    }
}

proptest! {
    #![proptest_config(ProptestConfig::with_cases(24))]

    #[test]
    fn finding_out_between_two_homes_earns_between_wrong_and_right_belief(
        // Far enough apart to walk between, because detours around a crowd could cost one expert more than another.
        places in Just([-12_i8, -6, 0, 6, 12]).prop_flat_map(|x| {
            let positions: Vec<_> = x.iter().flat_map(|x| [(*x, 4_i8), (*x, 11)]).collect();
            prop::sample::subsequence(positions, 4).prop_shuffle()
        }),
        is_first in any::<bool>(),
    ) {
        let draft = |paying: Color, other: Color| {
            let mut draft = world(paying, other);
            for (object, (x, y)) in draft.objects.iter_mut().zip(&places) {
                object.coordinates = [f64::from(*x), f64::from(*y)];
            }
            draft
        };
        let (red, mut blue) = (draft(RED, BLUE), draft(BLUE, RED));
        // The same objects in the same places, with rewards of opposite sign.
        for (own, other) in blue.objects.iter_mut().zip(&red.objects) {
            (own.color, own.reward) = (other.color, -other.reward / 2.0 - 1.0);
        }
        let (red, blue) = (checked(red), checked(blue));
        let expertise = Expertise::default();
        // At home the expert acts as the planner, step by step.
        let mut truth = Environment::with_catalogue(blue.clone(), Catalogue::default());
        let (mut planner, mut step, mut planned) = (OnRailsAgent::new(), Step::default(), ExpertRun::default());
        while !truth.ended() && planned.steps < expertise.steps {
            let action = planner.act(&truth);
            truth.step_into(action, &mut step).expect("the expert runs");
            planned.earned += step.reward;
            planned.success |= step.success;
            planned.steps += 1;
        }
        prop_assert_eq!(expertise.at_home(&blue).expect("the expert runs"), planned);
        let homes = if is_first { [&red, &blue] } else { [&blue, &red] };
        let own = expertise.at_home(homes[1]).expect("the expert runs");
        let found = expertise.finding_out(&homes, homes[1]).expect("the expert runs");
        let fixed = expertise.abroad(homes[0], homes[1]).expect("the expert runs");
        // The true home is never dropped, so finding out costs at most the first wrong object.
        prop_assert!(found.earned >= fixed.earned, "{found:?} {fixed:?}");
        prop_assert!(found.earned <= own.earned, "{found:?} {own:?}");
        let known = expertise.finding_out(&[homes[1], homes[0]], homes[1]).expect("the expert runs");
        prop_assert_eq!(known, own);
    }
}
