//! Tests floors, ceilings, files of scales, and standard errors.

use super::*;

fn request(worlds: u64) -> ScalesRequest {
    ScalesRequest {
        tasks: vec!["find_objects#red".to_owned(), "find_objects#penalty".to_owned()],
        worlds,
        seed: 7,
        libraries: Vec::new(),
        unlabelled: Vec::new(),
    }
}

#[test]
fn floor_and_ceiling_come_from_the_named_agents() {
    let found = scales(&request(3), &|| ()).unwrap();
    assert_eq!(
        found.scales.keys().collect::<Vec<_>>(),
        ["findobjects_penalty", "findobjects_red"]
    );
    for scale in found.scales.values() {
        let level = |agent: &str| scale.agents[agent].mean;
        assert_eq!(scale.floor, level("random").max(level("still")));
        assert_eq!(scale.ceiling, level("onrails"));
    }
    let red = &found.scales["findobjects_red"];
    assert!(red.ceiling > red.floor + 100.0, "{red:?}");
    assert_eq!(red.agents["onrails"].success, 1.0);
    // Standing still is optimal in that variant.
    let penalty = &found.scales["findobjects_penalty"];
    assert_eq!(penalty.floor, penalty.ceiling);
    // Measuring again gives the same result.
    assert_eq!(scales(&request(3), &|| ()).unwrap(), found);
}

#[test]
fn scales_file_round_trips() {
    let found = scales(&request(2), &|| ()).unwrap();
    let folder = tempfile::tempdir().unwrap();
    let path = folder.path().join("scales.json");
    std::fs::write(&path, serde_json::to_string(&found).unwrap()).unwrap();
    let read = ScalesFile::read(&path).unwrap();
    assert_eq!(read, found);
    let anchors = read.anchors();
    assert_eq!(
        anchors["findobjects_red"].ceiling,
        found.scales["findobjects_red"].ceiling
    );
    std::fs::write(&path, r#"{"scales": {"a": {"floor": 0}}}"#).unwrap();
    let error = ScalesFile::read(&path).unwrap_err().to_string();
    assert!(
        error.contains("missing field `ceiling`") && error.contains("expected scales"),
        "{error}"
    );
}

#[test]
fn standard_error_is_of_the_mean_over_worlds() {
    let level = AgentLevel::of(&[(1.0, true), (5.0, false), (3.0, false), (3.0, true)]);
    assert_eq!((level.mean, level.success), (3.0, 0.5));
    assert!((level.standard_error - (8.0_f64 / 3.0 / 4.0).sqrt()).abs() < 1e-6);
}

#[test]
fn one_world_is_refused() {
    let error = scales(&request(1), &|| ()).unwrap_err().to_string();
    assert_eq!(error, "worlds: found 1, expected 2 to 10000");
}

fn unlabelled(tasks: &[&str], sets: &[&[&str]], worlds: u64) -> Result<ScalesFile, Failure> {
    let names = |set: &&[&str]| set.iter().map(|name| (*name).to_owned()).collect();
    scales(
        &ScalesRequest {
            tasks: names(&tasks),
            unlabelled: sets.iter().map(names).collect(),
            ..request(worlds)
        },
        &|| (),
    )
}

#[test]
fn agent_that_cannot_know_the_variant_earns_less_than_the_expert() {
    let tasks = ["select_object#green", "select_object#red", "select_object#dusk"];
    let found = unlabelled(&tasks, &[&[]], 4).unwrap();
    // The world looks different at dusk, so that variant is not in the set.
    let [set] = found.unlabelled.as_slice() else {
        panic!("{found:?}")
    };
    assert_eq!(set.among, ["selectobject_green", "selectobject_red"]);
    // Mistakes cost, and episodes last until 50 points are won or lost.
    let expert = set.among.iter().map(|name| found.scales[name].ceiling).sum::<f64>() / 2.0;
    let floor = set.among.iter().map(|name| found.scales[name].floor).sum::<f64>() / 2.0;
    assert!(
        set.fixed.mean() <= expert - 40.0 && set.fixed.mean() >= floor,
        "{set:?}"
    );
    assert!(
        set.finds_out.mean() > expert - 10.0 && set.finds_out.mean() <= expert,
        "{set:?}"
    );
    // The anchors contain the set under log names, and none if no set was requested.
    let anchors = found.anchors();
    let of_red = &anchors["selectobject_red"].unlabelled;
    assert_eq!(
        (of_red.len(), of_red[0].fixed),
        (1, set.fixed.levels["selectobject_red"].mean)
    );
    assert_eq!(anchors["selectobject_dusk"].unlabelled, []);
    assert_eq!(unlabelled(&tasks, &[], 2).unwrap().unlabelled, []);
    // Naming the set gives the same result.
    let same = unlabelled(&tasks, &[&tasks[..2]], 4).unwrap();
    assert_eq!(same.unlabelled, found.unlabelled);
}

#[test]
fn agent_that_can_explore_comes_near_the_expert() {
    let tasks = ["find_objects#blue", "find_objects#turned"];
    let found = unlabelled(&tasks, &[&[]], 3).unwrap();
    let set = &found.unlabelled[0];
    assert!(set.finds_out.agent.ends_with("until a reward shows another"), "{set:?}");
    assert!(set.finds_out.mean() > set.fixed.mean(), "{set:?}");
    for (name, level) in &set.finds_out.levels {
        let scale = &found.scales[name];
        let is_between = level.mean <= scale.ceiling + 1e-9 && level.mean > scale.floor;
        assert!(is_between, "{name} {level:?} {scale:?}");
    }
}

#[test]
fn distinguishable_sets_are_refused() {
    let check = |sets: &[&[&str]], expected: &str| {
        let tasks = ["select_object#green", "select_object#dusk", "select_object#slow"];
        let error = unlabelled(&tasks, sets, 2).unwrap_err().to_string();
        assert_eq!(error, expected);
    };
    let advice = "expected variants that look alike at the start; the ceiling of those that can be told apart is the \
                  planner's";
    check(
        &[&["select_object#green", "select_object#dusk"]],
        &format!(
            "unlabelled: found select_object#green and select_object#dusk, which differ in more than their rewards, {advice}"
        ),
    );
    check(
        &[&["select_object#green"]],
        "unlabelled: found select_object#green alone, expected two variants or more",
    );
    check(
        &[&["select_object#green", "select_object#red"]],
        "unlabelled: found select_object#red, expected variants that are measured: name it as a TASK, too",
    );
}
