//! Scales: which agent makes which end, files, and standard errors. Agents are tested where they live.

use super::*;

fn request(worlds: u64) -> ScalesRequest {
    ScalesRequest {
        tasks: vec!["find_objects#red".to_owned(), "find_objects#penalty".to_owned()],
        worlds,
        seed: 7,
        libraries: Vec::new(),
    }
}

#[test]
fn the_floor_is_the_better_of_random_and_still_and_the_ceiling_knows_the_map() {
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
    // Whoever stands still there does as well as can be.
    let penalty = &found.scales["findobjects_penalty"];
    assert_eq!(penalty.floor, penalty.ceiling);
    // Measured again, it is the same.
    assert_eq!(scales(&request(3), &|| ()).unwrap(), found);
}

#[test]
fn a_file_is_read_as_it_was_written() {
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
    let said = ScalesFile::read(&path).unwrap_err().to_string();
    assert!(
        said.contains("missing field `ceiling`") && said.contains("expected scales"),
        "{said}"
    );
}

#[test]
fn a_standard_error_is_of_the_mean_over_worlds() {
    let level = AgentLevel::of(&[(1.0, true), (5.0, false), (3.0, false), (3.0, true)]);
    assert_eq!((level.mean, level.success), (3.0, 0.5));
    assert!((level.standard_error - (8.0_f64 / 3.0 / 4.0).sqrt()).abs() < 1e-6);
}

#[test]
fn one_world_is_refused() {
    let said = scales(&request(1), &|| ()).unwrap_err().to_string();
    assert_eq!(said, "worlds: found 1, expected 2 to 10000");
}
