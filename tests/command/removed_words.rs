//! Tests that words which earlier releases accepted are refused with the name of a replacement.

use driftworld_text::{WordKind, removed_words};

use super::terminal::{fail, scratch, text};

#[test]
fn every_removed_word_has_a_replacement() {
    let folder = scratch();
    let refused = |arguments: &str| fail(2, &arguments.split(' ').collect::<Vec<_>>());
    let invalid = |task: &str| {
        let path = folder.path().join("task.json");
        std::fs::write(&path, task).expect("the scratch folder can be written");
        fail(1, &["validate", text(&path)])
    };
    for (kind, word, instead) in removed_words() {
        let errors = match kind {
            WordKind::Command | WordKind::Option => vec![refused(word)],
            WordKind::Format if word == "npy" => vec![refused("order find_objects --matrix matrix.npy")],
            WordKind::Format => vec![refused(&format!("sample find_objects#red -o worlds.{word}"))],
            WordKind::Order => vec![refused(&format!("order find_objects --order {word}"))],
            WordKind::By => vec![
                refused(&format!("distance find_objects#blue find_objects#red --by {word}")),
                invalid(&format!(
                    r#"{{ "name": "drawn", "compare_by": "{word}", "parameters": {{}} }}"#
                )),
            ],
            WordKind::Measure => vec![invalid(&format!(
                r#"{{ "name": "drawn", "parameters": {{ "noise": {{ "role": "randomized", "type": "number", "affects": ["T"],
                     "distribution": {{ "normal": {{ "mean": 0, "std": 1 }} }}, "compare": {{ "measure": "{word}" }} }} }} }}"#
            ))],
        };
        for error in errors {
            let error = error.split_whitespace().collect::<Vec<_>>().join(" ");
            assert!(
                error.contains(&format!("removed in 0.3; use {instead}")),
                "{word}: {error}"
            );
        }
    }
}
