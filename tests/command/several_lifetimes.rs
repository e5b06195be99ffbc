//! Tests `driftworld metrics` with several lifetimes: null bands, results of tasks, notes on two agents, constant metrics.

use std::path::Path;

use driftworld::metrics::BlockType;

use super::null_bands::{parsed, write};
use super::terminal::{Says, fail_in, scratch, succeed_in};

const SCALES: &str =
    r#"{"scales": {"find_red": {"floor": 0, "ceiling": 100}, "find_held": {"floor": 0, "ceiling": 100}}}"#;

/// Two tasks are evaluated in the same worlds before and after one of them is learned, and again at the end, with the reward
/// `kept`.
fn live(folder: &Path, kept: f64) {
    let mut rows = Vec::new();
    for (block, level) in [(0, 0.0), (2, 80.0), (4, kept)] {
        for world in 0..8 {
            let luck = f64::from(world * (block as u32 + 1) % 5);
            rows.push((block, BlockType::Test, "find_red", world, level + luck));
            rows.push((block, BlockType::Test, "find_held", world, 10.0 + luck));
        }
        let task = if block == 0 { "find_red" } else { "find_blue" };
        if block < 4 {
            rows.extend((0..8).map(|world| (block + 1, BlockType::Train, task, world, 40.0 + f64::from(world))));
        }
    }
    // The rows of one task in a block are consecutive.
    rows.sort_by_key(|row| (row.0, row.2 != "find_red"));
    write(folder, &rows);
}

#[test]
fn good_needs_several_lifetimes_outside_the_null_band() {
    let folder = scratch();
    for (number, kept) in [30.0, 35.0, 25.0].into_iter().enumerate() {
        live(&folder.path().join(format!("forgets/{number}")), kept);
    }
    for (number, kept) in [80.0, 81.0, 79.0].into_iter().enumerate() {
        live(&folder.path().join(format!("keeps/{number}")), kept);
    }
    let reading = |runs: &str| {
        let shown = succeed_in(folder.path(), &["metrics", "-R", runs, "-m", "both"]);
        let row = shown
            .lines()
            .find(|line| line.starts_with("perf_maintenance_mrlep"))
            .map(str::to_owned);
        (row.expect("there is such a row"), shown)
    };
    let (row, shown) = reading("forgets");
    assert!(row.contains("  forgets  "), "{shown}");
    shown.says("Null band: the central 95% of means over lifetimes");
    let (row, shown) = reading("keeps");
    assert!(row.contains("no clear effect"), "{shown}");
    let learned = shown
        .lines()
        .find(|line| line.starts_with("avg_train_perf"))
        .expect("there is such a row");
    assert!(learned.contains("no null"), "{shown}");
    let json = parsed(&succeed_in(folder.path(), &["metrics", "-R", "forgets", "--json"]));
    let rows = json["repeats"].as_array().expect("it is a list");
    let row = rows
        .iter()
        .find(|row| row["name"] == "perf_maintenance_mrlep")
        .expect("the metric is listed");
    let (null, number) = (&row["null"], |value: &serde_json::Value| {
        value.as_f64().expect("it is a number")
    });
    assert!(
        number(&null["value"]) < number(&null["low"]) && number(&null["p"]) < 0.05,
        "{row}"
    );
    assert!(
        (number(&null["value"]) - number(&row["mean"]["value"])).abs() < 1e-9,
        "{row}"
    );
}

#[test]
fn never_learned_tasks_are_listed_and_experts_share_their_unit() {
    let folder = scratch();
    for number in 0..2 {
        live(&folder.path().join(format!("runs/{number}")), 50.0);
    }
    std::fs::write(folder.path().join("scales.json"), SCALES).expect("the folder is writable");
    for more in [&["-R", "runs"][..], &["runs/0"]] {
        let shown = succeed_in(
            folder.path(),
            &[&["metrics"][..], more, &["--scales", "scales.json"]].concat(),
        );
        let row = |task: &str| shown.lines().find(|line| line.starts_with(task)).map(str::to_owned);
        assert!(row("find_held").is_some_and(|row| row.contains("10%")), "{shown}");
        let red = row("find_red").expect("there is such a row");
        assert!(
            red.contains("82%") && !red.contains("100%"),
            "the row has a share of the ceiling and no separate ceiling: {shown}"
        );
    }
}

#[test]
fn notes_of_two_agents_are_labelled() {
    let folder = scratch();
    for number in 0..2 {
        live(&folder.path().join(format!("mine/{number}")), 50.0);
        live(&folder.path().join(format!("theirs/{number}")), -50.0);
    }
    let compare = ["metrics", "-R", "mine", "--against", "theirs", "-n", "none"];
    let shown = succeed_in(folder.path(), &compare);
    shown.says("\nnote on the other agent: some performances are negative");
    assert!(!shown.contains("\nnote: some performances are negative"), "{shown}");
}

#[test]
fn sides_of_a_comparison_are_one_agent_each_and_share_no_log() {
    let folder = scratch();
    for (number, agent) in ["ewc", "clear"].into_iter().enumerate() {
        let mine = folder.path().join(format!("mine/{number}"));
        live(&mine, 50.0);
        std::fs::write(mine.join("scenario_info.json"), format!(r#"{{"agent": "{agent}"}}"#)).expect("it is writable");
        live(&folder.path().join(format!("theirs/{number}")), 30.0);
    }
    let shown = fail_in(folder.path(), 0, &["metrics", "-R", "mine", "--against", "theirs"]);
    shown.says("warning: the first agent's logs: found several agents, clear, ewc; they are scored as one");
    let shown = fail_in(folder.path(), 0, &["metrics", "-R", "theirs", "--against", "mine"]);
    shown.says("warning: the second agent's logs: found several agents, clear, ewc; they are scored as one");
    let shown = fail_in(folder.path(), 2, &["metrics", "-R", "theirs", "--against", "theirs/0"]);
    shown.says("error: --against: found a log of the first agent, expected logs of another agent");
}

#[test]
fn one_lifetime_of_each_agent_gets_no_verdict() {
    let folder = scratch();
    live(&folder.path().join("mine"), 50.0);
    live(&folder.path().join("theirs"), -50.0);
    let shown = succeed_in(folder.path(), &["metrics", "mine", "--against", "theirs", "-n", "none"]);
    let row = shown.lines().rfind(|line| line.starts_with("avg_eval_perf"));
    assert!(row.is_some_and(|row| row.contains("too few lifetimes")), "{shown}");
    assert!(!shown.contains("P(better)"), "{shown}");
    succeed_in(
        folder.path(),
        &["report", "mine", "--against", "theirs", "-o", "page.html"],
    );
    let page = std::fs::read_to_string(folder.path().join("page.html")).expect("it was written");
    assert!(page.contains("too few lifetimes") && page.contains("Reached by theirs"));
    assert!(!page.contains("resamples of"), "nothing was resampled");
}

#[test]
fn constant_metric_is_listed_with_power() {
    let folder = scratch();
    for number in 0..3 {
        live(&folder.path().join(format!("runs/{number}")), 50.0);
    }
    let shown = succeed_in(folder.path(), &["metrics", "-R", "runs", "--power", "5"]);
    let power = shown.split("power for 5").nth(1).expect("there is such a table");
    let row = power
        .lines()
        .find(|line| line.starts_with("avg_eval_perf"))
        .expect("there is such a row");
    assert!(row.contains("0.000") && row.contains("does not vary"), "{shown}");
}
