//! All faults of a log at once, as listed by `validate_log`.

use std::fs;
use std::path::Path;

use driftworld_metrics::{
    BlockType, LogWarning, LogWriter, LoggerInfo, MAX_LISTED, MetricsError, Record, ScenarioInfo, Timestamp,
    Validation, read_log, validate_log,
};

const HEADER: &str =
    "block_num\texp_num\tworker_id\tblock_type\tblock_subtype\ttask_name\ttask_params\texp_status\ttimestamp\treward\n";

/// A row with this block number, experience number and status.
fn row(block_num: u64, exp_num: u64, status: &str) -> String {
    format!("{block_num}\t{exp_num}\tw\ttrain\twake\ta_b\t{{}}\t{status}\t20200913T122640.{exp_num:06}\t1\n")
}

/// Validates a log with these data files, each given with its folder; returns the problems and warnings.
fn validate(files: &[(&str, String)], version: &str) -> (Vec<String>, Vec<String>, Validation) {
    let base = tempfile::tempdir().unwrap();
    let dir = base.path();
    let info = format!(r#"{{"metrics_columns": ["reward"], "log_format_version": "{version}"}}"#);
    fs::write(dir.join("logger_info.json"), info).unwrap();
    let scenario = r#"{"complexity": "1-low", "difficulty": "1-easy", "scenario_type": "custom"}"#;
    fs::write(dir.join("scenario_info.json"), scenario).unwrap();
    for (folder, text) in files {
        fs::create_dir_all(dir.join(folder)).unwrap();
        fs::write(dir.join(folder).join("data-log.tsv"), text).unwrap();
    }
    let found = validate_log(dir);
    let plain = |text: String| text.replace(&dir.display().to_string(), "LOG").replace('\\', "/");
    // Reading refuses, or warns of, the faults that validation lists, with the same text.
    let message = |problem: &MetricsError| problem.to_string();
    match read_log(dir) {
        Ok(log) => {
            let warned = |text: String| {
                log.warnings
                    .iter()
                    .any(|warning| warning.to_string().starts_with(&text))
            };
            assert!(
                found.problems.iter().map(message).all(warned),
                "{found:?} {:?}",
                log.warnings
            );
            let of_rows = found
                .warnings
                .iter()
                .filter(|warning| !matches!(warning, LogWarning::NoNumbers { .. }));
            assert!(
                of_rows.map(ToString::to_string).all(warned),
                "{found:?} {:?}",
                log.warnings
            );
        }
        Err(error) => assert!(
            found.problems.iter().any(|problem| message(problem) == message(&error)),
            "{error}"
        ),
    }
    let problems = found.problems.iter().map(|problem| plain(problem.to_string()));
    let warnings = found.warnings.iter().map(|warning| plain(warning.to_string()));
    (problems.collect(), warnings.collect(), found)
}

/// Checks the problems and warnings of a log with one file.
fn check(text: String, problems: &[&str], warnings: &[&str]) {
    let (found_problems, found_warnings, _) = validate(&[("w/0-train", text)], "1.1");
    assert_eq!(found_problems, problems);
    assert_eq!(found_warnings, warnings);
}

#[test]
fn written_logs_are_valid() {
    let base = tempfile::tempdir().unwrap();
    let info = LoggerInfo::new(["reward"]).unwrap();
    let mut writer = LogWriter::create(base.path(), &info, &ScenarioInfo::default()).unwrap();
    for exp_num in 0..6_u64 {
        let stamp = Timestamp::from_unix_micros(exp_num as i64).unwrap();
        let record = Record::new(exp_num / 2, exp_num, BlockType::Train, "a_b", stamp);
        writer
            .write(
                &record
                    .with_worker(["v", "w"][exp_num as usize % 2])
                    .with_metric("reward", 1.0),
            )
            .unwrap();
    }
    let found = validate_log(base.path());
    assert!(found.is_valid(), "{found:?}");
    let counts = found.counts;
    assert_eq!((counts.files, counts.rows, counts.complete_rows), (6, 6, 6));
    assert_eq!(
        (counts.experiences, counts.blocks, counts.workers, counts.tasks),
        (6, 3, 2, 1)
    );
    assert_eq!(
        found.warnings.len(),
        3,
        "complexity, difficulty and scenario type are not given"
    );
}

#[test]
fn every_fault_is_listed_and_other_rows_are_read() {
    let text = [
        HEADER,
        &row(0, 0, "complete")
            .replace("train", "eval")
            .replace("\t1\n", "\tmuch\n"),
        &row(0, 1, "complete"),
        "0\t2\tw\n",
        &row(0, 3, "done"),
        "0\t4\tw\ttra",
    ];
    let (problems, _, found) = validate(&[("w/0-train", text.concat()), ("w/1-train", String::new())], "1.1");
    assert_eq!(
        problems,
        [
            "LOG/w/0-train/data-log.tsv:2, column block_type: found \"eval\", expected one of train, test",
            "LOG/w/0-train/data-log.tsv:2, column reward: found \"much\", expected a finite number, or nothing for a \
             missing one",
            "LOG/w/0-train/data-log.tsv:4: found 3 cells, expected 10 as in the header; is a tab or a quote missing?",
            "LOG/w/0-train/data-log.tsv:5, column exp_status: found \"done\", expected one of complete, incomplete",
            "LOG/w/0-train/data-log.tsv:6: found a last line without a line ending, expected complete rows; its writer was interrupted, or an editor omitted the line ending: add one if the line is complete; otherwise delete the line, or continue the log, which deletes it (`driftworld run … --resume`, LogWriter::resume)",
            "LOG/w/1-train/data-log.tsv:1: found an empty file, expected a header line that begins with block_num",
        ]
    );
    assert_eq!((found.counts.files, found.counts.rows), (2, 1));
}

#[test]
fn every_missing_column_is_named() {
    let header = HEADER.replace("exp_num\t", "").replace("\treward", "\tscore");
    let named = |column: &str| {
        format!(
            "LOG/w/0-train/data-log.tsv:1: found the columns {}, expected {column} as well",
            header.trim_end().replace('\t', ", ")
        )
    };
    check(header.clone(), &[&named("exp_num"), &named("reward")], &[]);
}

/// Whatever the first line holds, the message is short and appears once.
#[test]
fn row_instead_of_the_header_is_reported_briefly() {
    for width in [2, 10, 900] {
        for cell in ["7".to_owned(), "{\"a\": [1, 2]}".repeat(500), "ä".repeat(7000)] {
            let row = vec![cell; width].join("\t") + "\n";
            let (problems, _, _) = validate(&[("w/0-train", row.clone()), ("w/1-train", row)], "1.1");
            assert_eq!(problems.len(), 2, "{problems:?}");
            for problem in problems {
                assert!(
                    problem.contains("expected a header line that begins with block_num"),
                    "{problem}"
                );
                assert!(problem.chars().count() < 300, "{problem}");
            }
        }
    }
    // One standard column shows that a header is meant.
    let names: Vec<String> = (0..900).map(|number| format!("{number}{}", "x".repeat(8))).collect();
    let header = format!("block_num\t{}\n", names.join("\t"));
    let (problems, _, _) = validate(&[("w/0-train", header)], "1.1");
    assert_eq!(problems.len(), 8, "{problems:?}");
    for problem in problems {
        assert!(
            problem.contains("and 881 more, expected ") && problem.ends_with(" as well"),
            "{problem}"
        );
        assert!(problem.chars().count() < 600, "{problem}");
    }
}

#[test]
fn decreasing_numbers_are_faults_and_decreasing_time_is_a_warning() {
    let early = row(0, 3, "complete").replace("20200913", "20200912");
    let earlier = row(0, 4, "complete").replace("20200913", "20200911");
    check(
        [HEADER, &row(0, 2, "complete"), &row(0, 1, "complete"), &early, &earlier].concat(),
        &[
            "LOG/w/0-train/data-log.tsv:3, column exp_num: found 1, expected at least 2 as in the row above: numbers \
             never decrease",
        ],
        &[
            "LOG/w/0-train/data-log.tsv:3, column timestamp: found 20200913T122640.000001, expected at least 20200913T122640.000002 as in the row above; kept",
        ],
    );
    check(
        [HEADER, &row(1, 1, "complete"), &row(0, 2, "complete")].concat(),
        &[
            "LOG/w/0-train/data-log.tsv:3, column block_num: found 0, expected at least 1 as in the row above: \
             numbers never decrease",
            "LOG/w/0-train/data-log.tsv:3, column block_num: found 0, expected at least 1: \
             in order of exp_num, block numbers never decrease",
        ],
        &["LOG/w/0-train/data-log.tsv:2: found a misplaced row, expected it in w/1-train; kept"],
    );
}

#[test]
fn experience_has_one_complete_row_and_it_is_the_last() {
    check(
        [
            HEADER,
            &row(0, 0, "incomplete"),
            &row(0, 1, "complete"),
            &row(0, 1, "complete"),
            &row(0, 2, "incomplete"),
        ]
        .concat(),
        &[
            "LOG/w/0-train/data-log.tsv:2: found experience 0 of w without a complete row, expected exactly one: it \
             is not scored",
            "LOG/w/0-train/data-log.tsv:4: found another row of experience 1 of w after its complete one, expected \
             the complete row to be the last: give the next experience a new number",
        ],
        &[
            "LOG/w/0-train/data-log.tsv:5: found experience 2 without a complete row, the last of its worker; ignored \
             until it has one",
        ],
    );
    let two_workers = row(0, 0, "complete").replace("\tw\t", "\tv\t");
    let text = [HEADER, &row(0, 0, "complete")].concat();
    let (problems, warnings, _) = validate(
        &[("w/0-train", text), ("v/0-train", HEADER.to_owned() + &two_workers)],
        "1.1",
    );
    assert!(problems.is_empty() && warnings.is_empty(), "{problems:?} {warnings:?}");
}

#[test]
fn files_share_the_columns_of_their_version() {
    let other = HEADER.replace("\treward", "\treward\tsteps") + &row(1, 1, "complete").replace("\t1\n", "\t1\t2\n");
    let first = [HEADER, &row(0, 0, "complete")].concat();
    let (problems, warnings, _) = validate(&[("w/0-train", first), ("w/1-train", other)], "1.0");
    let columns = HEADER.trim_end().replace('\t', ", ");
    let expected = format!(
        "LOG/w/1-train/data-log.tsv:1: found the columns {columns}, steps, expected {columns} as in \
         LOG/w/0-train/data-log.tsv"
    );
    assert_eq!(problems, [expected]);
    let version = "LOG/w/0-train/data-log.tsv:1: found the column block_subtype, expected none in a log of format 1.0; used as is";
    assert_eq!(warnings, [version]);
    let old = [HEADER, &row(0, 0, "complete")]
        .concat()
        .replace("block_subtype\t", "")
        .replace("wake\t", "");
    check(
        old,
        &[],
        &[
            "LOG/w/0-train/data-log.tsv:1: found no column block_subtype, expected one in a log of format 1.1; read \
             as wake",
        ],
    );
}

#[test]
fn unconventional_names_and_metrics_without_numbers_are_warned_about() {
    check(
        [
            HEADER,
            &row(0, 0, "complete").replace("a_b", "a").replace("\t1\n", "\t\n"),
        ]
        .concat(),
        &[],
        &[
            "column reward: found no number in any row, expected at least one; it cannot be scored",
            "task_name: found \"a\", expected TASK_VARIANT, with letters and digits on both sides; used as is",
        ],
    );
}

#[test]
fn problems_beyond_the_limit_are_counted() {
    let rows: String = (0..MAX_LISTED as u64 + 5)
        .map(|exp_num| row(0, exp_num, "done"))
        .collect();
    let (problems, _, found) = validate(&[("w/0-train", HEADER.to_owned() + &rows)], "1.1");
    assert_eq!((problems.len(), found.more_problems), (MAX_LISTED, 5));
}

#[test]
fn directory_without_a_log_has_one_problem() {
    let check = |dir: &Path, code: &str| {
        let codes: Vec<&str> = validate_log(dir)
            .problems
            .iter()
            .map(driftworld_metrics::MetricsError::code)
            .collect();
        assert_eq!(codes, [code]);
    };
    let base = tempfile::tempdir().unwrap();
    check(&base.path().join("nowhere"), "metrics/not-a-directory");
    check(base.path(), "metrics/missing-file");
    fs::write(
        base.path().join("logger_info.json"),
        r#"{"metrics_columns": ["reward"]}"#,
    )
    .unwrap();
    check(base.path(), "metrics/no-data-files");
}

#[test]
fn unclosed_quote_is_not_a_torn_row() {
    let open = row(0, 0, "complete").replace("a_b", "\"a_b");
    check(
        [HEADER, &open, &row(0, 1, "complete"), &row(0, 2, "complete")].concat(),
        &[
            "LOG/w/0-train/data-log.tsv:2: found a quote that opens a cell and is never closed, expected a closing \
             quote at the end of the cell; the rows after it were read as part of the cell",
        ],
        &[],
    );
    let torn = "LOG/w/0-train/data-log.tsv:3: found a last line without a line ending, expected complete rows; its writer was interrupted, or an editor omitted the line ending: add one if the line is complete; otherwise delete the line, or continue the log, which deletes it (`driftworld run … --resume`, LogWriter::resume)";
    check(
        [HEADER, &row(0, 0, "complete"), "0\t1\tw\ttrain\twake\t\"a\n"].concat(),
        &[torn],
        &[],
    );
    check(
        [HEADER, &row(0, 0, "complete"), "0\t1\tw\ttrain\twake\t\"a\nb"].concat(),
        &[torn],
        &[],
    );
}

#[test]
fn undeclared_columns_may_be_empty() {
    let header = HEADER.replace("reward\n", "reward\tnote\n");
    check(
        [header, row(0, 0, "complete").replace("\t1\n", "\t1\t\n")].concat(),
        &[],
        &[],
    );
}

#[test]
fn rows_in_another_workers_or_blocks_folder_are_warned_about() {
    let text = |rows: &[String]| [HEADER, &rows.concat()].concat();
    let other_worker = row(1, 3, "complete").replace("\tw\t", "\tv\t");
    let files = [
        ("w/0-train", text(&[row(0, 0, "complete")])),
        ("w/7-test", text(&[row(0, 1, "complete")])),
        ("w/1-train", text(&[row(1, 2, "complete"), other_worker])),
    ];
    let (problems, warnings, _) = validate(&files, "1.1");
    assert_eq!(problems, [""; 0]);
    assert_eq!(
        warnings,
        [
            "LOG/w/1-train/data-log.tsv:3: found a misplaced row, expected it in v/1-train; kept",
            "LOG/w/7-test/data-log.tsv:2: found a misplaced row, expected it in w/0-train; kept",
        ]
    );
}

#[test]
fn gaps_in_numbers_are_warned_about_once() {
    let all: Vec<String> = (3..20).map(|exp_num| row(0, exp_num, "complete")).collect();
    check([HEADER, &all.concat()].concat(), &[], &[]);
    let kept: Vec<&str> = (0..17)
        .filter(|place| ![2, 3, 7].contains(place))
        .map(|place| all[place].as_str())
        .collect();
    let warning = "LOG/w/0-train/data-log.tsv:4: found experience 7 after 4, expected 5; numbers without a row: 3";
    check([HEADER, &kept.concat()].concat(), &[], &[warning]);
    // Numbers are counted over all workers.
    let shared = |lacking: usize| {
        let mut texts = [HEADER.to_owned(), HEADER.to_owned()];
        for place in (0..17).filter(|&place| place != lacking) {
            texts[place % 2] += &all[place].replace("\tw\t", ["\tv\t", "\tw\t"][place % 2]);
        }
        let [v, w] = texts;
        validate(&[("v/0-train", v), ("w/0-train", w)], "1.1").1
    };
    assert_eq!(shared(99), [""; 0]);
    assert!(shared(5)[0].contains("found experience 9 after 7"), "{:?}", shared(5));
}
