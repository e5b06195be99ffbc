//! Tests that the same log gives the same metrics everywhere: the table of `driftworld metrics`, its JSON, the page of
//! `driftworld report`, and so Python, which reads the JSON.

use std::path::Path;

use driftworld::metrics::BlockType;
use proptest::prelude::*;
use serde_json::Value;

use super::null_bands::{parsed, write};
use super::terminal::{driftworld_in, output, scratch, succeed_in};

const TASKS: [&str; 3] = ["find_red", "find_blue", "find_green"];

/// A lifetime: the reward of each task after each number of learned tasks; the variation between worlds; the number of worlds.
#[derive(Clone, Debug)]
struct Drawn {
    levels: Vec<f64>,
    noise: f64,
    worlds: u32,
    options: Vec<&'static str>,
}

fn drawn() -> impl Strategy<Value = Drawn> {
    let levels = proptest::collection::vec(-20.0..100.0, 12);
    let noise = prop_oneof![Just(0.0), 1.0..20.0, 50.0..200.0];
    let options = prop_oneof![
        Just(vec![]),
        Just(vec!["-t", "both", "-m", "both"]),
        Just(vec!["-n", "none"]),
        Just(vec!["-G"]),
    ];
    (levels, noise, 2..9_u32, options).prop_map(|(levels, noise, worlds, options)| Drawn {
        levels,
        noise,
        worlds,
        options,
    })
}

/// Every task is evaluated before and after each is learned, and the first is learned twice.
fn live(folder: &Path, drawn: &Drawn, luck: u32) {
    let mut rows = Vec::new();
    let mut chance = luck;
    let mut reward = |level: f64| {
        chance = chance.wrapping_mul(1_664_525).wrapping_add(1_013_904_223);
        level + drawn.noise * (f64::from(chance >> 8) / f64::from(1 << 24) - 0.5)
    };
    for learned in 0..4_u64 {
        for (number, task) in TASKS.into_iter().enumerate() {
            let level = drawn.levels[learned as usize * 3 + number];
            rows.extend((0..drawn.worlds).map(|world| (2 * learned, BlockType::Test, task, world, reward(level))));
        }
        let task = TASKS[learned as usize % 3];
        let level = drawn.levels[learned as usize * 3];
        rows.extend((0..12).map(|world| (2 * learned + 1, BlockType::Train, task, world, reward(level))));
    }
    write(folder, &rows);
}

/// The output of a command with unlimited line length.
fn wide(folder: &Path, arguments: &[&str]) -> String {
    let mut command = driftworld_in(folder, arguments);
    let done = output(command.env("COLUMNS", "1000"));
    assert!(done.status.success(), "{arguments:?}");
    String::from_utf8(done.stdout).expect("the command prints UTF-8")
}

/// The words under `reading` in the table of metrics, with the metric.
fn of_table(text: &str) -> Vec<(String, String)> {
    let mut lines = text.lines().skip_while(|line| !line.starts_with("metric "));
    let head = lines.next().expect("a table of metrics");
    // A table without null bands may have no reading at all.
    let from = head.find("  reading").map(|at| at + 2);
    let rows =
        lines.take_while(|line| line.starts_with(|letter: char| letter.is_ascii_lowercase()) && line.contains("  "));
    rows.map(|line| {
        let name = line.split(' ').next().unwrap_or_default().to_owned();
        let cell: String = from.map_or_else(String::new, |from| line.chars().skip(from).collect());
        (name, cell.split("  ").next().unwrap_or_default().trim().to_owned())
    })
    .collect()
}

fn word(row: &Value) -> String {
    row["word"].as_str().unwrap_or_default().to_owned()
}

/// The words in the pills of a part of a page, in order.
fn pills(part: &str) -> Vec<String> {
    let pills = part.split("class=\"verdict ").skip(1);
    pills
        .filter_map(|pill| Some(pill.split("</span>").nth(1)?.to_owned()))
        .collect()
}

proptest! {
    #![proptest_config(ProptestConfig { cases: crate::tier::quick_or_full(5, 16), ..ProptestConfig::default() })]

    #[test]
    fn table_json_and_page_agree_for_a_lifetime(drawn in drawn(), luck in 0..1000_u32) {
        let folder = scratch();
        live(&folder.path().join("life"), &drawn, luck);
        let arguments = [&["metrics", "life"][..], &drawn.options].concat();
        let table = of_table(&wide(folder.path(), &arguments));
        let json = parsed(&succeed_in(folder.path(), &[&arguments[..], &["--json"]].concat()));
        let rows = json["readings"].as_object().expect("a row for each metric");
        let said: Vec<_> = rows.iter().map(|(name, row)| (name.clone(), word(row))).collect();
        prop_assert_eq!(&table, &said);
        let page = wide(folder.path(), &[&["report", "life", "-o", "-"][..], &drawn.options].concat());
        for (name, row) in rows {
            let place = page.find(&format!("<code>{name}</code>")).expect("each metric is on the page");
            let cells = page[place..].split("</tr>").next().unwrap_or_default();
            prop_assert_eq!(pills(cells).first().cloned().unwrap_or_default(), word(row), "{}", name);
            // If a contrast is shown, so are its pairs.
            let is_alone = cells.contains("td class=\"marks\"></td>") && name.contains("transfer");
            prop_assert!(!is_alone, "{name}: {cells}");
            let null = &row["null_band"];
            if ["good", "bad", "mixed"].contains(&row["reading"].as_str().unwrap_or_default()) {
                prop_assert!(null["p"].as_f64().expect("it is a number") <= 0.05, "{row}");
            }
        }
    }

    #[test]
    fn table_json_and_page_agree_for_several_lifetimes(drawn in drawn(), luck in 0..1000_u32, num in 2..4_u32) {
        let folder = scratch();
        for number in 0..num {
            live(&folder.path().join(format!("runs/{number}")), &drawn, luck + 7919 * number);
        }
        let options = [&drawn.options[..], &["--resamples", "200"]].concat();
        let arguments = [&["metrics", "-R", "runs"][..], &options].concat();
        let table = of_table(&wide(folder.path(), &arguments));
        let json = parsed(&succeed_in(folder.path(), &[&arguments[..], &["--json"]].concat()));
        let rows = json["repeats"].as_array().expect("it is a list");
        let said: Vec<_> = rows
            .iter()
            .map(|row| (row["name"].as_str().unwrap_or_default().to_owned(), word(row)))
            .collect();
        prop_assert_eq!(&table, &said);
        let page = wide(folder.path(), &[&["report", "runs", "-o", "-"][..], &options].concat());
        let part = page.split("Metrics over all lifetimes").nth(1).expect("there is such a table").split("</table>").next();
        let words: Vec<_> = said.into_iter().map(|(_, word)| word).filter(|word| !word.is_empty()).collect();
        prop_assert_eq!(pills(part.unwrap_or_default()), words);
    }
}
