//! Tests drifts that switch whole variants. Every world belongs to the first or the second variant and equals that variant's own
//! world. The share of the second variant equals the drift's progress.

use std::sync::Arc;

use driftworld_generator::{Drift, GeneratorError, Sampler};
use driftworld_spec::{DriftSchedule, DriftSwitch, RegimeDrift, TaskSpec, Variant};
use proptest::prelude::*;

const TASKS: [&str; 3] = ["find_objects", "get_to_goal", "moving_object"];

/// Number of worlds for estimating shares.
const WORLDS: u64 = 400;

fn variants() -> Vec<Variant> {
    let load = |name: &str| {
        let path = format!("{}/../examples/tasks/{name}.json", env!("CARGO_MANIFEST_DIR"));
        let text = std::fs::read_to_string(path).expect("the example tasks ship with the project");
        TaskSpec::from_json(name, &text).unwrap_or_else(|error| panic!("{error}"))
    };
    TASKS
        .iter()
        .flat_map(|name| Arc::clone(&load(name)).all_variants())
        .collect()
}

fn hash(variant: &Variant, seed: u64, index: u64) -> String {
    let world = Sampler::new(variant, seed).world(index);
    world.unwrap_or_else(|error| panic!("{}: {error}", variant.id())).hash()
}

proptest! {
    #![proptest_config(ProptestConfig::with_cases(24))]

    #[test]
    fn every_world_belongs_to_one_variant_and_the_share_equals_the_progress(
        a in any::<prop::sample::Index>(),
        b in any::<prop::sample::Index>(),
        seed in 0..1_u64 << 53,
        progress in 0.0..=1.0,
    ) {
        let all = variants();
        let (from, to) = (a.get(&all).clone(), b.get(&all).clone());
        let declared = RegimeDrift { switch: DriftSwitch::Task, ..RegimeDrift::to(to.name()) };
        let drift = Drift::declared(&declared, from.clone(), to.clone(), seed).expect("any two variants can be mixed");
        let mut num_second = 0;
        for index in 0..WORLDS {
            let drawn = drift.at(progress, index).expect("one of the two");
            prop_assert!([from.id(), to.id()].contains(&drawn.id()), "{}", drawn.id());
            num_second += u64::from(drawn.id() == to.id());
            if index < 4 {
                let found = hash(&drawn, seed, index);
                prop_assert!(found == hash(&from, seed, index) || found == hash(&to, seed, index));
            }
        }
        if from.id() != to.id() {
            let share = num_second as f64 / WORLDS as f64;
            let error = (progress * (1.0 - progress) / WORLDS as f64).sqrt();
            prop_assert!((share - progress).abs() <= 5.0 * error + 0.01, "{share} at {progress}");
        }
        for (progress, only) in [(0.0, &from), (1.0, &to)] {
            prop_assert_eq!(drift.at(progress, seed).expect("one of the two").id(), only.id());
        }
    }
}

#[test]
fn world_that_has_switched_stays_switched() {
    let all = variants();
    let drift = Drift::mixing(all[0].clone(), all[1].clone(), 5).with_schedule(DriftSchedule::Linear);
    let is_second = |progress: f64, index: u64| {
        let drawn = drift.at(progress, index).expect("one of the two");
        drawn.id() == all[1].id()
    };
    for index in 0..50 {
        let num_second = (0..=20)
            .filter(|step| is_second(f64::from(*step) / 20.0, index))
            .count();
        let first_step = (0..=20).position(|step| is_second(f64::from(step) / 20.0, index));
        assert_eq!(
            num_second,
            21 - first_step.expect("the drift ends with the second"),
            "world {index}"
        );
    }
}

#[test]
fn drift_between_two_tasks_without_whole_switch_is_refused() {
    let all = variants();
    let other = all.iter().find(|variant| variant.task().name() != all[0].task().name());
    let other = other.expect("the variants come from several tasks").clone();
    let drift = Drift::mixing(all[0].clone(), other, 5).with_switch(driftworld_generator::Switch::AtPoint);
    assert!(matches!(drift.at(0.5, 0), Err(GeneratorError::DifferentTasks { .. })));
    assert!(drift.at(0.0, 0).is_ok() && drift.at(1.0, 0).is_ok());
}
