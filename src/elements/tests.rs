//! Tests comparisons of tasks' claims with measurements.

use super::*;

fn task(affects: &str) -> Arc<TaskSpec> {
    let text = format!(
        r#"{{ "name": "t", "parameters": {{
            "color": {{ "role": "variant", "type": "color", "affects": {affects}, "choices": ["red", "blue"], "default": "red" }},
            "pay": {{ "role": "variant", "type": "number", "affects": ["R"], "range": [-9, 9], "default": 1 }},
            "reach": {{ "role": "variant", "type": "number", "affects": ["T"], "range": [0, 9], "default": 0 }} }},
           "world": {{ "environment_params": {{ "map_size": [20, 20] }}, "rules": {{ "success": ["all_collected"] }} }},
           "groups": [ {{ "name": "cubes", "count": 3, "placement": {{ "box": {{ "low": [-8, -8], "high": [8, 8] }} }},
             "object": {{ "class": "geometric", "color": {{ "param": "color" }}, "reward": {{ "param": "pay" }},
               "reward_once_stimulus": ["AgentCollide"], "destroy_stimulus": ["AgentCollide"],
               "range_stimulus_distance": {{ "param": "reach" }} }} }} ],
           "variants": {{ "red": {{}}, "blue": {{ "color": "blue" }}, "rich": {{ "color": "blue", "pay": 9, "reach": 3 }} }} }}"#
    );
    TaskSpec::from_json("t.json", &text).expect("the task is valid")
}

fn request() -> ElementsRequest {
    ElementsRequest {
        worlds: 3,
        steps: 60,
        modalities: Some(vec![driftworld_spec::Modality::Rgb]),
        ..ElementsRequest::of("t")
    }
}

#[test]
fn true_claims_are_sound_and_unread_parameters_idle() {
    for affects in [r#"["O"]"#, r#"["phi"]"#, r#"["O", "S"]"#] {
        let found = elements_of(&task(affects), &request()).expect("all can be measured");
        assert!(found.is_sound(), "{found:#?}");
        let [blue, rich] = &found.variants[..] else {
            panic!("expected two variants besides the base")
        };
        assert_eq!((blue.elements(), blue.verdict), (vec![Element::Phi], Verdict::Sound));
        assert_eq!(
            (rich.elements(), rich.verdict),
            (vec![Element::R, Element::Phi], Verdict::Idle)
        );
        assert_eq!(rich.idle, ["reach"]);
        assert_eq!(rich.proof.worlds, 3);
        let warnings: Vec<String> = found.warnings().collect();
        assert!(
            warnings[0].starts_with("t#rich: reach made no difference"),
            "{warnings:?}"
        );
        // The task declares an effect in vain if no variant with a different colour shows it.
        let vain = "t: color declares S, which differed from red in none of the variants that change it (blue, rich): ";
        let vain = if affects.contains('S') { vec![vain] } else { Vec::new() };
        assert_eq!(warnings.len(), 1 + vain.len(), "{warnings:?}");
        assert!(vain.iter().all(|vain| warnings[1].starts_with(vain)), "{warnings:?}");
    }
}

#[test]
fn false_claim_is_reported_with_the_first_case() {
    let found = elements_of(&task(r#"["p"]"#), &request()).expect("all can be measured");
    assert!(!found.is_sound());
    assert_eq!(found.variants[0].verdict, Verdict::Contradicted);
    let messages: Vec<&str> = found.contradictions().collect();
    assert!(
        messages[0].starts_with("t#blue: found that phi (emission) differs from red: in world 0, step 0 ("),
        "{messages:?}"
    );
    assert!(
        messages[0].ends_with("expected no more than color (p) affects; add \"phi\" to its \"affects\""),
        "{messages:?}"
    );
}

#[test]
fn one_variant_is_compared_with_another() {
    let between = |a: &str, b: &str| {
        let request = ElementsRequest {
            a: Some(a.to_owned()),
            b: Some(b.to_owned()),
            ..request()
        };
        elements_of(&task(r#"["phi"]"#), &request)
    };
    let found = between("blue", "t#rich").expect("both can be measured");
    assert_eq!(
        (found.base.as_str(), found.variants[0].elements()),
        ("blue", vec![Element::R])
    );
    assert!(between("blue", "ritch").is_err());
    let alone = ElementsRequest {
        task: "t#rich".to_owned(),
        ..request()
    };
    let alone = elements_of(&task(r#"["phi"]"#), &alone).expect("it can be measured");
    assert_eq!((alone.base.as_str(), alone.variants.len()), ("red", 1));
}

#[test]
fn outcome_round_trips_through_json() {
    let found = elements_of(&task(r#"["S"]"#), &request()).expect("all can be measured");
    let text = serde_json::to_string(&found).expect("it can be written");
    assert!(text.contains(r#""element":"phi""#), "{text}");
    assert_eq!(
        serde_json::from_str::<ElementsOutcome>(&text).expect("it can be read"),
        found
    );
}

#[test]
fn numbers_out_of_range_are_refused() {
    for request in [
        ElementsRequest { worlds: 0, ..request() },
        ElementsRequest { steps: 0, ..request() },
    ] {
        assert!(elements_of(&task(r#"["O"]"#), &request).is_err());
    }
}
