//! Tests distances of pairs and lists of variants and worlds, by each measure.

use driftworld_similarity::DistanceMatrix;
use driftworld_spec::TaskSpec;

use super::*;
use crate::tasks;
use crate::tier::quick_or_full;

fn matrix(names: &[&str]) -> DistanceMatrix {
    let variants: Vec<(String, Variant)> = names
        .iter()
        .map(|name| ((*name).to_owned(), tasks::variant(name).expect("it is built in")))
        .collect();
    let by = fitting(variants.iter().map(|(_, variant)| variant));
    variant_matrix(&variants, &Sample::by(by), Ok).expect("all can be drawn")
}

#[test]
fn variants_of_one_task_use_the_measure_it_declares() {
    let found = matrix(&["find_objects#blue", "find_objects#red", "find_objects#penalty"]);
    assert!(found.properties().is_metric());
    assert!(found.get(0, 1) > 0.0 && found.get(0, 2) > found.get(0, 1));
}

#[test]
fn measuring_stops_when_cancelled() {
    for names in [
        ["find_objects#blue", "find_objects#red"],
        ["find_objects#blue", "get_to_goal#plain"],
    ] {
        let variants = names.map(|name| (name.to_owned(), tasks::variant(name).expect("it is built in")));
        let by = fitting(variants.iter().map(|(_, variant)| variant));
        let found = variant_matrix_while(&variants, &Sample::by(by), Ok, || false);
        assert!(matches!(found, Err(DistancesError::Interrupted)), "{names:?}");
    }
}

#[test]
fn variant_and_world_are_compared_by_worlds() {
    let variant = tasks::variant("find_objects#blue").expect("it is built in");
    let world = Side::World(Box::new(Sampler::new(&variant, 0).world(0).expect("it can be drawn")));
    let (variant, sample) = (Side::Variant(variant), Sample::default());
    let found = between(&variant, &world, &sample, Ok).expect("both can be measured");
    assert!(found.distance.total > 0.0);
    assert_eq!(
        found.description,
        "by worlds, mean of 16 worlds of each drawn under seed 0"
    );
    assert_eq!(
        between(&world, &world, &sample, Ok)
            .expect("both can be measured")
            .distance
            .total,
        0.0
    );
    let last = Sample {
        index: u64::MAX,
        ..Sample::default()
    };
    assert!(matches!(
        between(&variant, &world, &last, Ok),
        Err(DistancesError::TooFar { .. })
    ));
}

#[test]
fn distance_depends_on_the_pair_alone() {
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
            variant_matrix(&named(names), &Sample::by(by), Ok)
                .expect("all can be drawn")
                .get(0, 1)
        };
        assert_eq!(of(&pair), of(&more), "{by:?}");
    }
    let refused = variant_matrix(&named(&more), &Sample::default(), Ok).expect_err("several tasks");
    assert!(
        refused.to_string().contains("rewards, dynamics or behavior"),
        "{refused}"
    );
    assert!(matches!(refused, DistancesError::By { .. }));
}

/// A sample of two worlds per variant, so that slow measures take little time.
fn small_sample(by: By) -> Sample {
    Sample {
        worlds: Some(2),
        ..Sample::by(by)
    }
}

/// A field of a few metres with a cube in it.
fn small_task() -> std::sync::Arc<TaskSpec> {
    let number = |affects: &str, range: &str, default: &str| {
        format!(
            r#"{{ "role": "variant", "type": "number", "affects": ["{affects}"], "range": {range}, "default": {default} }}"#
        )
    };
    let text = format!(
        r#"{{ "name": "small", "parameters": {{
            "pay": {}, "side": {}, "speed": {} }},
          "world": {{
            "environment_params": {{ "map_size": [12, {{ "param": "side" }}] }},
            "agent_params": {{ "max_linear_speed": {{ "param": "speed" }} }},
            "objects": [ {{ "class": "geometric", "coordinates": [2, 3], "reward": {{ "param": "pay" }},
                            "reward_once_stimulus": ["AgentCollide"] }} ] }},
          "variants": {{ "a": {{}}, "paid": {{ "pay": -10 }}, "small": {{ "side": 10 }}, "fast": {{ "speed": 8 }} }} }}"#,
        number("R", "[-100, 100]", "10"),
        number("S", "[8, 20]", "12"),
        number("T", "[1, 10]", "5")
    );
    TaskSpec::from_json("small", &text).expect("a valid task")
}

fn all_names() -> impl Iterator<Item = By> {
    By::names()
        .iter()
        .map(|name| By::from_name(name).expect("it is a name"))
}

#[test]
fn each_measure_is_a_symmetric_number_per_pair() {
    let names = ["find_objects#red", "find_objects#penalty", "get_to_goal#plain"];
    let built_in: Vec<(String, Variant)> = names
        .iter()
        .map(|name| ((*name).to_owned(), tasks::variant(name).expect("it is built in")))
        .collect();
    let small: Vec<(String, Variant)> = ["a", "paid", "small"]
        .iter()
        .map(|name| ((*name).to_owned(), small_task().variant(name).expect("it is declared")))
        .collect();
    for by in all_names()
        .filter(|by| *by != By::Parameters)
        .step_by(quick_or_full(2, 1))
    {
        // Tabulating a whole meadow takes seconds.
        let variants = if by.subject() == "dynamics" { &small } else { &built_in };
        let side = |k: usize| Side::Variant(variants[k].1.clone());
        let distance = |a: usize, b: usize| {
            let found = between(&side(a), &side(b), &small_sample(by), Ok).expect("both can be compared");
            assert_eq!(found.by, by);
            assert!(
                found.description.starts_with(&format!("by {}, ", by.name())),
                "{}",
                found.description
            );
            assert!(found.description.contains("2 worlds of each"), "{}", found.description);
            found.distance
        };
        let matrix = variant_matrix(variants, &small_sample(by), Ok).expect("all can be compared");
        for (a, b) in [(0, 2), (0, 1)].into_iter().take(quick_or_full(1, 2)) {
            let found = distance(a, b);
            let (total, name) = (found.total, by.name());
            assert!(total.is_finite() && total >= 0.0, "{name} {total}");
            assert!(
                (total - distance(b, a).total).abs() < 1e-12,
                "{name}: {a} and {b}, symmetric"
            );
            assert!(
                (total - matrix.get(a, b)).abs() < 1e-12,
                "{name}: {a} and {b}, alone and in a matrix"
            );
            let parts: f64 = found.parts.iter().map(|part| part.normalised * part.weight).sum();
            assert!(
                found.parts.is_empty() || (parts - total).abs() < 1e-9,
                "{name}: parts add up"
            );
        }
        assert!(distance(0, 0).total.abs() < 1e-12, "{}: itself", by.name());
    }
}

#[test]
fn task_declares_the_measure_of_its_variants() {
    let text = |by: &str| {
        format!(
            r#"{{ "name": "lit", {by} "parameters": {{
                "light": {{ "role": "variant", "type": "number", "affects": ["O"], "range": [0, 4], "default": 2 }} }},
              "world": {{ "environment_params": {{ "light_intensity": {{ "param": "light" }} }} }},
              "variants": {{ "day": {{}}, "dusk": {{ "light": 1 }} }} }}"#
        )
    };
    let compared = |by: &str, sample: &Sample| {
        let task = TaskSpec::from_json("lit", &text(by)).expect("a valid task");
        let [day, dusk] = ["day", "dusk"].map(|name| task.variant(name).expect("it is declared"));
        let named = [("day".to_owned(), day.clone()), ("dusk".to_owned(), dusk.clone())];
        let found = between(&Side::Variant(day), &Side::Variant(dusk), sample, Ok).expect("both are valid");
        let matrix = variant_matrix(&named, sample, Ok).expect("both are valid");
        assert!((matrix.get(0, 1) - found.distance.total).abs() < 1e-12);
        found.by
    };
    let default = Sample::default();
    assert_eq!(compared("", &default), By::Parameters);
    assert_eq!(
        compared(r#""compare_by": "pictures:whole","#, &default),
        By::PicturesWhole
    );
    assert_eq!(
        compared(r#""compare_by": "rewards","#, &Sample::by(By::Worlds)),
        By::Worlds
    );
    let error = TaskSpec::from_json("lit", &text(r#""compare_by": "looks","#)).expect_err("there is no such measure");
    assert!(error.to_string().contains("/compare_by"), "{error}");
}

#[test]
fn too_many_worlds_are_refused_before_drawing() {
    let side = |name: &str| Side::Variant(tasks::variant(name).expect("it is built in"));
    let (a, b) = (side("find_objects#red"), side("find_objects#blue"));
    for by in [By::Behavior, By::Dynamics, By::PicturesWhole] {
        let sample = Sample {
            worlds: Some(MAX_BEHAVIOR_WORLDS + 1),
            ..Sample::by(by)
        };
        let refused = between(&a, &b, &sample, Ok).expect_err("they are too many");
        assert!(refused.to_string().contains("found 1001 worlds by"), "{refused}");
    }
}

#[test]
fn parts_show_what_a_measure_responds_to() {
    let side = |name: &str| Side::Variant(tasks::variant(name).expect("it is built in"));
    let parts = |a: &str, b: &str, by: By| {
        let found = between(&side(a), &side(b), &small_sample(by), Ok)
            .expect("both can be compared")
            .distance;
        let parts = found.parts.iter().map(|part| (part.name.clone(), part.normalised));
        (found.elements, parts.collect::<Vec<_>>())
    };
    let (elements, looks) = parts("find_objects#red", "find_objects#blue", By::Pictures);
    assert!(
        looks[0].1 > looks[1].1,
        "a changed object colour is visible where the objects are: {looks:?}"
    );
    assert!(elements[4].is_some() && elements[..4].iter().all(Option::is_none));
    let (_, outcomes) = parts("find_objects#red", "find_objects#penalty", By::Dynamics);
    assert!(
        outcomes[0].1 > 0.0 && outcomes[1].1 == 0.0,
        "only the rewards of actions differ, not where they lead: {outcomes:?}"
    );
    assert_eq!(
        parts("find_objects#red", "find_objects#penalty", By::Behavior),
        ([None; 5], vec![])
    );
}

#[test]
fn shaping_gives_distance_0_and_reversed_rewards_1() {
    let side = |name: &str| Side::Variant(tasks::variant(name).expect("it is built in"));
    let rewards = Sample::by(By::Rewards);
    let distance = |a: &str, b: &str| {
        between(&side(a), &side(b), &rewards, Ok)
            .expect("both are drawn")
            .distance
            .total
    };
    assert_eq!(distance("get_to_goal#plain", "get_to_goal#soft"), 0.0);
    assert!(distance("find_objects#red", "find_objects#penalty") > 0.99);
    assert!(distance("get_to_goal#plain", "get_to_goal#deadly") > 0.1);
}

#[test]
fn variants_of_several_tasks_are_compared_by_worlds() {
    let found = matrix(&["find_objects#blue", "find_objects#red", "get_to_goal#plain"]);
    assert!(!found.properties().is_metric());
    assert!(found.get(0, 1) < found.get(0, 2));
    assert_eq!(matrix(&[]).len(), 0);
}
