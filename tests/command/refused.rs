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

const REFUSED: [&str; 129] = [
    "sampel",
    "sample",
    "sample find_objects --count 0",
    "sample find_objects --count 3",
    "sample find_objects --count 3 --shard 4/3",
    "sample find_objects --shard 1/3",
    "sample find_objects --seed -1",
    "sample park.json#blue --drift-to red --count 3 --schedule wave",
    "schema",
    "completions csh",
    "render park.json --renderer crayon",
    "render park.json --turn nan",
    "photograph park.json --modalities smell",
    "sheet park.json --scenario scenario.json",
    "film park.json -o film.jpg",
    "film park.json -o new.gif --record ./new.gif",
    "render park.json --view episode --frames 60 --size 4096",
    "vary park.json#red --element rewrd --distance 1",
    "vary park.json#red --element O --distance -1",
    "vary park.json#red --element R --distance 0.5 --name red",
    "vary park.json#red --element R --distance 0.5 --name default",
    "vary park.json#red --element R --distance 0.5 --name a/b",
    "vary park.json#red --element R --distance 0.5 --name ..",
    "vary park.json#red --element R --distance 0.5 --name con",
    "vary park.json#red --element R --distance 0.5 --name \u{202e}",
    "elements park.json red",
    "elements park.json --worlds 0",
    "elements park.json --modalities sound",
    "distance park.json#red penalty --explain --weight rewrd=2",
    "distance park.json#red penalty --by looks",
    "order",
    "order park.json --matrix matrix.txt",
    "order park.json --order target-step",
    "order park.json --target-step 0.3",
    "order park.json --order shortest",
    "curriculum park.json --name a/b",
    "curriculum park.json --by rewards --probe reward",
    "curriculum park.json --worlds=0 --probe rewrd",
    "curriculum park.json --form permuted --controls controls",
    "curriculum park.json --form permuted --order gradual",
    "curriculum park.json --form permuted --start park.json#red",
    "curriculum park.json --form permuted --end park.json#red",
    "curriculum park.json --form permuted --lifetimes 0",
    "curriculum park.json --form expert",
    "curriculum park.json --form expert --lifetimes 2",
    "curriculum find_objects --lifetimes 10000 --worlds 0 -o many",
    "curriculum park.json --form expert --experts 2",
    "curriculum park.json --steps 3",
    "curriculum park.json --order given --order exact",
    "curriculum park.json --lifetimes 2 -o x.json",
    "curriculum park.json --experts - -o one.json",
    "curriculum park.json --controls - -o one.json",
    "curriculum park.json -o c.png --plot c.png",
    "curriculum park.json -o scenario.json",
    "run scenario.json --jobs 0",
    "run scenario.json --agent onrail",
    "metrics",
    "metrics log -P -T pie",
    "metrics --ste expert log",
    "report log -T pie",
    "report log -u hours",
    "metrics log -u hours",
    "sample park.json#rde",
    "sample park.json#blue --drift-to find_objects#red --count 3 --jsonl",
    "sample crowd.json",
    "sample park.json -o park.json/world.json",
    "tasks show find_object",
    "tasks show park.json#dsk",
    "validate comma.json",
    "validate nowhere.json",
    "sheet find_objects get_to_goal select_object moving_object",
    "vary park.json --element T --distance 0.5",
    "elements park.json red blu",
    "elements find_objects red penalty --modalities segmentation --worlds 2",
    "distance park.json#red dusk --scale share --by rewards",
    "order park.json find_objects#red",
    "order park.json --end pink",
    "order --from-matrix broken.csv",
    "curriculum park.json --probe transition",
    "curriculum park.json --probe reward --start park.json#bleu",
    "curriculum park.json --probe observation --end park.json#bleu",
    "curriculum park.json --probe reward --variants 1",
    "curriculum park.json --probe reward --variants 201",
    "curriculum park.json find_objects --probe reward",
    "curriculum park.json --form alternating",
    "curriculum park.json --hold-out park.json",
    "curriculum park.json --hold-out nothing",
    "curriculum park.json --blocks 0",
    "curriculum park.json --step-distance 2",
    "curriculum park.json --evaluate-after 9",
    "curriculum park.json#blue find_objects#red --drift linear",
    "export select_objects",
    "new No_Name",
    "run park.json",
    "run park.json#red",
    "run scenario.json -o log",
    "run scenario.json -o crowd.json/log",
    "run scenario.json -o crowd.json/log --resume",
    "run scenario.json --agent random -o log --resume",
    "vary find_objects#red --parameters spread,lightt --distance 0.1",
    "logs validate empty",
    "logs aggregate empty -o table.csv",
    "logs validate .",
    "logs aggregate log -o table.xlsx",
    "logs aggregate log -o table.csv --format tsv",
    "logs aggregate log -o log/worker-default/0-train/data-log.tsv",
    "logs aggregate log -o log/logger_info.json --format tsv",
    "logs aggregate log -o log/./worker-default/data-log.tsv",
    "report log -o log/logger_info.json",
    "sample park.json -o log/scenario_info.json",
    "sample park.json -o park.json",
    "sample park.json#red --count 3 --jsonl -o park.json",
    "curriculum park.json -o park.json",
    "convert park.json#red -o park.json",
    "order park.json --matrix park.json",
    "run scenario.json -o crowd.json --resume",
    "play park.json",
    "replay nowhere",
    "replay log",
    "replay log --episode 0 --worker nobody",
    "logs validate nowhere",
    "metrics .",
    "metrics nowhere",
    "metrics log -p rewrd",
    "metrics log -c bad.json",
    "metrics log -c twice.json",
    "metrics log -d range.json",
    "metrics log other --confidence 1.5",
    "report nowhere",
];

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
    std::fs::create_dir(path.join("empty")).expect("the folder is ours");
    let before = files_below(path);
    let mut said = String::new();
    for line in REFUSED {
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
        .expect("texts grow");
    }
    insta::assert_snapshot!(said);
    assert!(files_below(path) == before, "what is refused writes nothing");
}
