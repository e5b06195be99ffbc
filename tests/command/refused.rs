//! Messages about refused arguments, as one snapshot.

use std::fmt::Write;

use super::run_files::write;
use super::terminal::{driftworld_in, output, scratch, succeed_in, text};
use crate::files_below::files_below;

/// A task that does not change when the built-in ones do.
pub(super) const PARK: &str = r#"{ "version": 2, "name": "park", "parameters": {
    "color": { "role": "variant", "type": "color", "affects": ["O"], "choices": ["blue", "red", "green"], "default": "blue" },
    "reward": { "role": "variant", "type": "number", "affects": ["R"], "range": [-100, 100], "default": 100 },
    "light": { "role": "variant", "type": "number", "affects": ["O"], "range": [0.2, 4], "default": 2.3 },
    "spread": { "role": "variant", "type": "number", "affects": ["S"], "range": [2, 40], "default": 20 } },
  "variants": { "blue": {}, "red": { "color": "red" }, "green": { "color": "green" }, "dusk": { "extends": "red", "light": 0.6 },
    "huddle": { "spread": 6 }, "penalty": { "extends": "red", "reward": -100 } } }"#;

/// Refused commands with their messages. To add a command, add its line `$ driftworld …` and accept the new snapshot.
const REFUSED: &str =
    include_str!("snapshots/all__command__refused__every_refusal_has_its_exit_code_and_its_words.snap");

#[test]
fn every_refusal_has_its_exit_code_and_its_words() {
    let folder = scratch();
    let path = folder.path();
    let crowd = r#"{ "name": "crowd", "world": { "environment_params": { "map_size": [10, 10] } },
        "groups": [{ "name": "crowd", "count": 100, "object": { "class": "cube" },
                     "placement": { "box": { "low": [-5, -5], "high": [5, 5] } }, "separation": 3 }] }"#;
    let regime = r#"{ "task": "park.json", "variant": "red", "count": 1, "max_steps": 5 }"#;
    let scenario = format!(r#"{{ "name": "s", "blocks": [{{ "type": "learning", "regimes": [{regime}] }}] }}"#);
    for (name, document) in [
        ("park.json", PARK),
        ("crowd.json", crowd),
        ("scenario.json", &scenario),
        ("comma.json", "{\n  \"max_steps\": 3,\n}\n"),
        ("broken.csv", ",a,b\na,0,1\nb,2,0\n"),
        ("bad.json", r#"{"perf_mesure": "reward"}"#),
        ("twice.json", r#"{"perf_measure": "reward", "perf_measure": "success"}"#),
        ("range.json", r#"{"park_red": {"min": 3, "max": 3}}"#),
        ("nowhere.json", &scenario.replace("park.json", "nowhere_else.json")),
    ] {
        write(&path.join(name), document);
    }
    for log in ["log", "other"] {
        succeed_in(path, &format!("run scenario.json --agent still -o {log}"));
    }
    std::fs::create_dir(path.join("empty")).expect("the folder is writable");
    let before = files_below(path);
    let mut said = String::new();
    let lines = REFUSED.lines().filter_map(|line| line.strip_prefix("$ driftworld "));
    assert_eq!(lines.clone().count(), 134, "no line was lost");
    for line in lines {
        let ended = output(&mut driftworld_in(path, line));
        let error = String::from_utf8_lossy(&ended.stderr).replace(text(path), "HERE");
        let code = ended.status.code();
        assert!(
            matches!(code, Some(1 | 2)) && !error.contains("panicked"),
            "{line}: {code:?} {error}"
        );
        write!(
            said,
            "$ driftworld {line}\n{error}exit code {}\n\n",
            code.unwrap_or_default()
        )
        .expect("writing to a String does not fail");
    }
    insta::assert_snapshot!(said);
    assert!(files_below(path) == before, "refused commands write nothing");
}
