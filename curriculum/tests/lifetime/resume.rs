//! Logs of stopped runs: what they contain, and which runs may continue them.

use super::*;

#[test]
fn stopped_run_leaves_a_readable_log() {
    let folder = scratch();
    let log = folder.path().join("log");
    let summary =
        run_scenario(&scenario(&["blue"]), &mut RandomAgent::new(0), &log, 4).unwrap_or_else(|error| panic!("{error}"));
    assert_eq!((summary.experiences, summary.finished), (4, false));
    assert_eq!(read_log(&log).unwrap_or_else(|error| panic!("{error}")).rows.len(), 4);
}

#[test]
fn log_cut_at_any_byte_is_completed_identically() {
    let folder = scratch();
    let whole = folder.path().join("whole");
    let scenario = varied();
    let summary =
        run_scenario(&scenario, &mut RandomAgent::new(0), &whole, u64::MAX).unwrap_or_else(|error| panic!("{error}"));
    // Files in the order in which they are written.
    let mut files: Vec<String> = vec!["scenario_info.json".into(), "logger_info.json".into()];
    for (block, kind) in ["train", "test", "train", "test"].iter().enumerate() {
        files.push(format!("worker-default/{block}-{kind}/data-log.tsv"));
    }
    let bytes: Vec<Vec<u8>> = files
        .iter()
        .map(|file| std::fs::read(whole.join(file)).expect("the log has these files"))
        .collect();
    let total: usize = bytes.iter().map(Vec::len).sum();
    for cut in (0..=total).step_by(if std::env::var_os("DRIFTWORLD_FULL").is_some() {
        173
    } else {
        691
    }) {
        let log = folder.path().join(format!("cut-{cut}"));
        std::fs::create_dir(&log).expect("the folder is writable");
        let mut left = cut;
        for (file, bytes) in files.iter().zip(&bytes) {
            if left == 0 {
                break;
            }
            let (torn, part) = (left < bytes.len(), &bytes[..left.min(bytes.len())]);
            // The two info files have a temporary name until they are complete.
            let name = if torn && !file.contains('/') {
                format!(".{file}.tmp")
            } else {
                file.clone()
            };
            let path = log.join(name);
            std::fs::create_dir_all(path.parent().expect("a file in a folder")).expect("the folder is writable");
            std::fs::write(path, part).expect("the folder is writable");
            left -= part.len();
        }
        let settings = RunSettings {
            resume: true,
            jobs: 2,
            ..RunSettings::default()
        };
        let resumed = run_with(&scenario, &mut RandomAgent::new(0), &log, &settings);
        assert_eq!(resumed.unwrap_or_else(|error| panic!("cut at {cut}: {error}")), summary);
        assert_eq!(log_text(&log), log_text(&whole), "cut at {cut}");
    }
}

#[test]
fn log_is_resumed_only_by_the_same_run() {
    let folder = scratch();
    let log = folder.path().join("log");
    let scenario = varied();
    run_scenario(&scenario, &mut RandomAgent::new(0), &log, 13).unwrap_or_else(|error| panic!("{error}"));
    let before = log_text(&log);
    let check = |scenario: &Scenario, agent: &str, expected: &str| {
        let error = Journal::resume(&log, &plan(scenario).unwrap_or_else(|error| panic!("{error}")), agent);
        let error = error.expect_err("another run").to_string();
        assert!(error.contains(expected), "{error}");
        assert_eq!(log_text(&log), before);
    };
    check(
        &scenario,
        "other",
        "/agent: found \"test\", expected \"other\" as in this run; continue with what",
    );
    let mut longer = scenario.clone();
    longer.blocks[3].regimes[0].count = 9;
    check(
        &longer,
        "test",
        "/scenario/blocks/3/regimes/0/count: found 2, expected 9 as in this run",
    );
    // A row is missing.
    let path = log.join("worker-default/0-train/data-log.tsv");
    let text = std::fs::read_to_string(&path).expect("the log has this file");
    let lines: Vec<&str> = text.lines().take(2).collect();
    std::fs::write(&path, lines.join("\n") + "\n").expect("the folder is writable");
    let error = Journal::resume(&log, &plan(&scenario).unwrap_or_else(|error| panic!("{error}")), "test");
    let error = error.expect_err("a row is missing");
    assert_eq!(error.code(), "curriculum/other-row");
    assert!(
        error.to_string().contains("row 1: found experience 9 in block 1-test"),
        "{error}"
    );
}
