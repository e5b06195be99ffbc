//! How episodes ended: the counts of `driftworld run`, and the frames of `driftworld render --view episode`.

use std::collections::BTreeMap;

use super::run_files::{files, is_table, write};
use super::terminal::{fail, scratch, succeed, text};

/// A field with a river of lava, which some agents avoid, and a short time limit.
const TASK: &str = r#"{ "name": "river", "world": {
    "max_steps": 60,
    "environment_params": { "map_size": [16, 16], "zones": [{ "polygon": [[-3, 1], [8, 1], [8, 3], [-3, 3]], "ends": "failure" }] },
    "agent_params": { "observation_size": 8, "heading": { "uniform": { "low": 0, "high": 360 } } },
    "rules": { "success": [{ "touch": "goal" }] } },
  "groups": [{ "name": "goal", "count": 1, "placement": { "box": { "low": [-6, -4], "high": [6, 6] } },
    "object": { "class": "barrel", "tag": "goal", "reward": 1, "reward_stimulus": ["AgentCollide"] } }] }"#;

/// How often each word occurs in the column `ended_by` of a log.
fn counted(log: &std::path::Path) -> BTreeMap<String, u64> {
    let mut counts = BTreeMap::new();
    for (_, table) in files(log).into_iter().filter(|(name, _)| is_table(name)) {
        let mut lines = table.lines().map(|line| line.split('\t').collect::<Vec<_>>());
        let header = lines.next().expect("a table has a header");
        let column = header.iter().position(|name| *name == "ended_by").expect("ended_by");
        for row in lines {
            *counts.entry(row[column].to_owned()).or_default() += 1;
        }
    }
    counts
}

#[test]
fn run_counts_what_ended_episodes_even_when_resumed() {
    let folder = scratch();
    write(&folder.path().join("river.json"), TASK);
    let scenario = folder.path().join("scenario.json");
    let regime =
        |count: u32| format!(r#"{{ "task": "river.json", "variant": "default", "count": {count}, "seed": 3 }}"#);
    let block = |kind: &str, count: u32| format!(r#"{{ "type": "{kind}", "regimes": [{}] }}"#, regime(count));
    write(
        &scenario,
        &format!(
            r#"{{ "name": "ends", "blocks": [{}, {}] }}"#,
            block("evaluation", 12),
            block("learning", 30)
        ),
    );
    let mut seen = BTreeMap::new();
    for agent in ["random", "onrails", "still"] {
        let log = folder.path().join(agent);
        let arguments = ["run", text(&scenario), "--agent", agent, "--output", text(&log)];
        let summary = succeed(&[&arguments[..], &["--json"]].concat());
        let summary: serde_json::Value = serde_json::from_str(&summary).expect("--json prints JSON");
        let counts = counted(&log);
        assert_eq!(counts.values().sum::<u64>(), 42);
        assert_eq!(summary["ended_by"], serde_json::json!(counts), "{agent}");
        // The log is complete: nothing is run, and the same counts are printed.
        let resumed = succeed(&[&arguments[..], &["--resume"]].concat());
        let mut listed: Vec<(&String, &u64)> = counts.iter().collect();
        listed.sort_by_key(|(_, count)| std::cmp::Reverse(**count));
        let listed: Vec<String> = listed.iter().map(|(word, count)| format!("{word} {count}")).collect();
        assert!(
            resumed.contains(&format!("\nended by: {}\n", listed.join(", "))),
            "{resumed}"
        );
        seen.extend(counts);
    }
    assert_eq!(seen.keys().collect::<Vec<_>>(), ["steps", "touch", "zone"]);
}

#[test]
fn episode_is_drawn_frame_by_frame() {
    let folder = scratch();
    let path = folder.path().join("solved.png");
    let render = "render examples/worlds/key_corridor.json#closed --size 64 -o";
    let episode = [&render.split(' ').collect::<Vec<_>>()[..], &[text(&path)]].concat();
    let size = |more: &[&str]| {
        let stdout = succeed(&[&episode[..], &["--view", "episode"], more].concat());
        assert!(path.exists(), "{stdout}");
        let size = stdout.trim().trim_end_matches(" pixels)").rsplit(" (").next();
        let size = size.expect("the size is printed");
        let (width, height) = size.split_once(" × ").expect("it has two sides");
        [width, height].map(|side| side.parse::<u32>().expect("it is a number"))
    };
    // Rows of two frames, each of two pictures and a heading; a map has the arena's aspect ratio, 13 to 9.
    let [eight, three, two] = [
        size(&[]),
        size(&["--frames", "3"]),
        size(&["--frames", "2", "--agent", "still"]),
    ];
    assert_eq!([eight[0], three[0], two[0]], [372; 3]);
    assert!(two[1] > 64 && three[1] > 128 && three[1] > two[1] && eight[1] > 256 && eight[1] > three[1]);
    let error = fail(2, &[&episode[..], &["--frames", "3"]].concat());
    assert!(error.contains("expected --view episode"), "{error}");
}

/// The same view in both styles, in three sizes each: small as learners see it, and each picture in its own style.
#[test]
fn both_styles_are_drawn_side_by_side() {
    let folder = scratch();
    let path = folder.path().join("looks.svg");
    succeed(&["render", "find_objects", "--view", "looks", "-o", text(&path)]);
    let drawn = std::fs::read_to_string(&path).expect("the picture was written");
    let [plain, natural] = ["Plain", "Natural"].map(|title| drawn.find(&format!(">{title}<")).expect("it has a row"));
    assert!(plain < natural);
    let images: std::collections::BTreeSet<&str> = drawn
        .split("base64,")
        .skip(1)
        .filter_map(|rest| rest.split('"').next())
        .collect();
    assert_eq!(images.len(), 6, "three sizes of two styles, no two the same");
}
