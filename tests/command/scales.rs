//! `driftworld scales`, and `driftworld metrics` with its results and with `--power`.

use std::path::Path;

use super::null_bands::{parsed, write};
use super::terminal::{Says, driftworld_in, output, scratch, succeed_in};
use driftworld::metrics::BlockType;

/// Evaluates two variants before and after each is learned; the final reward in worlds of the first is `level`.
fn live(folder: &Path, level: f64) {
    let tasks = ["findobjects_red", "findobjects_penalty"];
    let mut rows = Vec::new();
    for block in 0..5 {
        if block % 2 == 1 {
            let task = tasks[block as usize / 2];
            rows.extend((0..6).map(|world| (block, BlockType::Train, task, world, 10.0)));
            continue;
        }
        for task in tasks {
            let earned = if task == tasks[0] && block > 0 { level } else { -30.0 };
            rows.extend((0..6).map(|world| (block, BlockType::Test, task, world, earned + f64::from(world))));
        }
    }
    write(folder, &rows);
}

#[test]
fn metrics_use_the_measured_scales() {
    let folder = scratch();
    let tasks = ["find_objects#red", "find_objects#penalty"];
    let shown = succeed_in(
        folder.path(),
        &[
            "scales",
            tasks[0],
            tasks[1],
            "--worlds",
            "2",
            "--seed",
            "3",
            "-o",
            "scales.json",
        ],
    );
    let penalty = shown.lines().find(|line| line.contains("penalty")).expect("a row");
    assert!(penalty.ends_with("nothing to learn"), "{shown}");
    let file = std::fs::read_to_string(folder.path().join("scales.json")).expect("the file exists");
    let red = &parsed(&file)["scales"]["findobjects_red"];
    let (floor, ceiling) = (
        red["floor"].as_f64().expect("it is a number"),
        red["ceiling"].as_f64().expect("it is a number"),
    );

    // Halfway from floor to ceiling on average, as the worlds add 0 to 5.
    live(&folder.path().join("life"), f64::midpoint(floor, ceiling) - 2.5);
    let shown = succeed_in(folder.path(), &["metrics", "life", "--scales", "scales.json"]);
    let red = shown
        .lines()
        .find(|line| line.starts_with("findobjects_red"))
        .expect("there is such a row");
    assert!(red.contains("50% ± "), "{shown}");
    shown.says("from its floor to its ceiling, to 1..101: findobjects_red.");
    shown.says("scaled by this lifetime's own range: findobjects_penalty.");
    let json = parsed(&succeed_in(
        folder.path(),
        &["metrics", "life", "--scales", "scales.json", "--json"],
    ));
    let reached = &json["reached"]["findobjects_red"];
    assert_eq!(reached["scaled_by"], "anchors", "{json}");
    let score = reached["evaluations"][1]["score"].as_f64().expect("it is a number");
    assert!((score - 0.5).abs() < 1e-9, "{json}");
    assert_eq!(json["reached"]["findobjects_penalty"]["scaled_by"], "own", "{json}");
    let curve = &json["curves"]["findobjects_red"];
    assert!(curve["is_scaled"] == true && curve["forgetting"] == 0.0, "{json}");
    // Metrics count in hundredths of the distance from floor to ceiling.
    let range = &json["normalization_data_range"]["findobjects_red"];
    assert_eq!(
        (range["min"].as_f64(), range["max"].as_f64()),
        (Some(floor), Some(ceiling)),
        "{json}"
    );
}

#[test]
fn power_reports_the_detectable_effect_and_the_lifetimes_needed() {
    let folder = scratch();
    for (number, level) in [20.0, 60.0, 35.0, 50.0].into_iter().enumerate() {
        live(&folder.path().join(format!("runs/{number}")), level);
    }
    let shown = succeed_in(folder.path(), &["metrics", "-R", "runs", "-n", "none", "--power", "10"]);
    shown.says("lifetimes for 10");
    shown.says("smallest effect");
    assert!(shown.lines().any(|line| line.starts_with("findobjects_red")), "{shown}");
    let json = parsed(&succeed_in(
        folder.path(),
        &["metrics", "-R", "runs", "-n", "none", "--power", "10", "--json"],
    ));
    let rows = json["power"].as_array().expect("it is a list");
    let row = rows
        .iter()
        .find(|row| row["name"] == "avg_eval_perf")
        .expect("the metric varies and is listed");
    // Of the evaluations of red, two in three vary; of all tasks' means, half of that.
    let deviation = row["deviations"][0].as_f64().expect("it is a number");
    assert!((deviation - 17.5 / 3.0).abs() < 0.5, "{row}");
    assert_eq!(row["lifetimes"], serde_json::json!([4, 4]), "{row}");
    let power = row["power"].as_f64().expect("it is a number");
    assert!(0.05 < power && power < 0.8, "{row}");
    assert!(row["lifetimes_needed"].as_u64().expect("it is a number") > 4, "{row}");
    assert!(row["smallest_effect"].as_f64().expect("it is a number") > 10.0, "{row}");
}

#[test]
fn lookalike_tasks_have_a_separate_ceiling() {
    let folder = scratch();
    let mut measure = vec!["scales", "select_object#green", "select_object#red", "--worlds", "3"];
    measure.extend(["--unlabelled", "-o", "scales.json"]);
    let shown = succeed_in(folder.path(), &measure);
    shown.says("look alike");
    shown.says("does the same in all");
    let tasks = ["selectobject_green", "selectobject_red"];
    let live = |name: &str, tasks: &[&'static str]| {
        let mut rows = Vec::new();
        for block in 0..3 {
            let kind = if block == 1 { BlockType::Train } else { BlockType::Test };
            let own = if block == 1 { &tasks[..1] } else { tasks };
            rows.extend(
                own.iter()
                    .flat_map(|task| (0..4).map(move |world| (block, kind, *task, world, f64::from(world)))),
            );
        }
        write(&folder.path().join(name), &rows);
    };
    live("life", &tasks);
    let shown = succeed_in(folder.path(), &["metrics", "life", "--scales", "scales.json"]);
    let line = "selectobject_green, selectobject_red look alike. Without a label, the best known agent gets ";
    assert!(shown.contains(line), "{shown}");
    let shown = succeed_in(folder.path(), &["metrics", "-R", "life", "--scales", "scales.json"]);
    assert_eq!(shown.matches(line).count(), 1, "{shown}");
    let json = parsed(&succeed_in(
        folder.path(),
        &["metrics", "life", "--scales", "scales.json", "--json"],
    ));
    let file = parsed(&std::fs::read_to_string(folder.path().join("scales.json")).expect("the file exists"));
    let set = &file["unlabelled"][0];
    for task in tasks {
        let shown = &json["reached"][task]["unlabelled"];
        assert_eq!(shown["fixed"], set["fixed"]["levels"][task]["mean"], "{json}");
        assert_eq!(shown["finds_out"], set["finds_out"]["levels"][task]["mean"], "{json}");
        assert_eq!(shown["among"], serde_json::json!(tasks), "{json}");
    }
    // A task that is alone in its lifetime has no lookalike there.
    live("alone", &tasks[..1]);
    let json = parsed(&succeed_in(
        folder.path(),
        &["metrics", "alone", "--scales", "scales.json", "--json"],
    ));
    assert!(json["reached"][tasks[0]]["unlabelled"].is_null(), "{json}");
}

#[test]
fn scales_that_fit_no_task_are_reported() {
    let folder = scratch();
    live(&folder.path().join("life"), 20.0);
    let file = folder.path().join("scales.json");
    let warned = |text: &str| {
        std::fs::write(&file, text).expect("the folder is writable");
        let run = output(&mut driftworld_in(
            folder.path(),
            &["metrics", "life", "--scales", "scales.json"],
        ));
        assert!(run.status.success());
        String::from_utf8(run.stderr).expect("it is text")
    };
    let stderr = warned(r#"{"scales": {"findobject_red": {"floor": 0, "ceiling": 10}}}"#);
    assert!(
        stderr.contains(
            "found no floor and ceiling for any task of this log, expected findobjects_red, findobjects_penalty"
        ) && stderr.contains("did you mean \"findobject_red\"?"),
        "{stderr}"
    );
    let stderr = warned(
        r#"{"scales": {"findobjects_red": {"floor": 0, "ceiling": 10}, "findobjects_penalt": {"floor": 0, "ceiling": 1}}}"#,
    );
    stderr.says("of findobjects_penalty; did you mean \"findobjects_penalt\"?");
    let stderr = warned(r#"{"scales": {"findobjects_red": {"floor": 0, "ceiling": 10}}}"#);
    assert!(!stderr.contains("scales:"), "{stderr}");
}

#[test]
fn only_names_that_the_log_lacks_are_suggested() {
    let folder = scratch();
    let rows_of = |task| (0..4).map(move |world| (0, BlockType::Test, task, world, f64::from(world)));
    let rows: Vec<_> = ["orchard_dim", "orchard_dip"].into_iter().flat_map(rows_of).collect();
    write(&folder.path().join("life"), &rows);
    for (other, is_suggested) in [("meadow", false), ("orchard_dit", true)] {
        let anchors = r#"{"floor": 0, "ceiling": 10}"#;
        let scales = format!(r#"{{"scales": {{"orchard_dip": {anchors}, "{other}": {anchors}}}}}"#);
        std::fs::write(folder.path().join("scales.json"), scales).expect("the folder is writable");
        let run = output(&mut driftworld_in(
            folder.path(),
            &["metrics", "life", "--scales", "scales.json"],
        ));
        let stderr = String::from_utf8_lossy(&run.stderr);
        assert_eq!(
            stderr.contains("did you mean \"orchard_dit\"?"),
            is_suggested,
            "{stderr}"
        );
        assert_eq!(
            stderr.matches("did you mean").count(),
            usize::from(is_suggested),
            "{stderr}"
        );
    }
}
