//! Distances of pairs and lists of variants and worlds, by each measure.

use super::*;
use crate::tasks;

fn matrix(names: &[&str]) -> DistanceMatrix {
    let variants: Vec<(String, Variant)> = names
        .iter()
        .map(|name| ((*name).to_owned(), tasks::variant(name).expect("it is built in")))
        .collect();
    let by = By::fitting(variants.iter().map(|(_, variant)| variant));
    variant_matrix(&variants, Some(by), Ok).expect("all can be drawn")
}

#[test]
fn variants_of_one_task_are_compared_by_what_it_declares() {
    let found = matrix(&["find_objects#blue", "find_objects#red", "find_objects#penalty"]);
    assert!(found.properties().is_metric());
    assert!(found.get(0, 1) > 0.0 && found.get(0, 2) > found.get(0, 1));
}

#[test]
fn measuring_is_given_up_when_it_is_no_longer_wanted() {
    for names in [
        ["find_objects#blue", "find_objects#red"],
        ["find_objects#blue", "get_to_goal#plain"],
    ] {
        let variants = names.map(|name| (name.to_owned(), tasks::variant(name).expect("it is built in")));
        let by = By::fitting(variants.iter().map(|(_, variant)| variant));
        let found = variant_matrix_while(&variants, Some(by), Ok, || false);
        assert!(matches!(found, Err(DistancesError::Interrupted)), "{names:?}");
    }
}

#[test]
fn a_variant_is_compared_with_a_world_by_worlds() {
    let variant = tasks::variant("find_objects#blue").expect("it is built in");
    let world = Side::World(Box::new(Sampler::new(&variant, 0).world(0).expect("it can be drawn")));
    let (variant, sample) = (Side::Variant(variant), Sample::default());
    let (distance, comparison) = between(&variant, &world, &sample, Ok).expect("both can be measured");
    assert!(
        distance.total > 0.0 && comparison.starts_with("mean of 16 worlds"),
        "{comparison}"
    );
    assert_eq!(
        between(&world, &world, &sample, Ok)
            .expect("both can be measured")
            .0
            .total,
        0.0
    );
    let last = Sample {
        index: u64::MAX,
        ..sample
    };
    assert!(matches!(
        between(&variant, &world, &last, Ok),
        Err(DistancesError::TooFar { .. })
    ));
}

#[test]
fn the_distance_of_a_pair_hangs_on_the_pair_alone() {
    let (pair, more) = (
        ["find_objects#blue", "find_objects#penalty"],
        [
            "find_objects#blue",
            "find_objects#penalty",
            "find_objects#wide",
            "get_to_goal#plain",
        ],
    );
    let named = |names: &[&str]| -> Vec<(String, Variant)> {
        let named = |name: &&str| ((*name).to_owned(), tasks::variant(name).expect("it is built in"));
        names.iter().map(named).collect()
    };
    for by in [By::Worlds, By::Rewards] {
        let of = |names: &[&str]| {
            variant_matrix(&named(names), Some(by), Ok)
                .expect("all can be drawn")
                .get(0, 1)
        };
        assert_eq!(of(&pair), of(&more), "{by:?}");
    }
    let refused = variant_matrix(&named(&more), None, Ok).expect_err("the tasks are several");
    assert!(refused.to_string().contains("worlds or rewards"), "{refused}");
    assert!(matches!(refused, DistancesError::By { .. }));
}

#[test]
fn shaping_is_no_other_reward_and_the_reverse_is_one() {
    let side = |name: &str| Side::Variant(tasks::variant(name).expect("it is built in"));
    let rewards = Sample {
        by: Some(By::Rewards),
        ..Sample::default()
    };
    let apart = |a: &str, b: &str| {
        between(&side(a), &side(b), &rewards, Ok)
            .expect("both are drawn")
            .0
            .total
    };
    assert_eq!(apart("get_to_goal#plain", "get_to_goal#soft"), 0.0);
    assert!(apart("find_objects#red", "find_objects#penalty") > 0.99);
    assert!(apart("get_to_goal#plain", "get_to_goal#deadly") > 0.1);
}

#[test]
fn variants_of_several_tasks_are_compared_by_their_worlds() {
    let found = matrix(&["find_objects#blue", "find_objects#red", "get_to_goal#plain"]);
    assert!(!found.properties().is_metric());
    assert!(found.get(0, 1) < found.get(0, 2));
    assert_eq!(matrix(&[]).len(), 0);
}
