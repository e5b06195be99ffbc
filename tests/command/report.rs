//! `driftworld report`: the page and its figures as files, and the source of the distances on the timeline.

use std::fs;
use std::path::Path;

use super::run_files::write;
use super::terminal::{Says, driftworld_in, fail_in, json_in, output, read, root, scratch, succeed_in};

/// Runs a lifetime and logs it in `log`: three learning blocks on two variants, each after an evaluation.
fn run_lifetime(folder: &Path) {
    let regime = |variant: &str, count: u32| {
        format!(r#"{{ "task": "find_objects", "variant": "{variant}", "count": {count}, "max_steps": 20 }}"#)
    };
    let blocks = ["blue", "red", "blue"].map(|learned| {
        let (blue, red, learned) = (regime("blue", 2), regime("red", 2), regime(learned, 6));
        format!(
            r#"{{ "type": "evaluation", "regimes": [{blue}, {red}] }}, {{ "type": "learning", "regimes": [{learned}] }}"#
        )
    });
    let scenario = format!(r#"{{ "name": "in_turns", "blocks": [{}] }}"#, blocks.join(", "));
    write(&folder.join("scenario.json"), &scenario);
    succeed_in(folder, "run scenario.json --agent random --output log");
}

#[test]
fn lifetime_becomes_a_page_and_figures_with_its_scenarios_distances() {
    let folder = scratch();
    run_lifetime(folder.path());
    let stdout = succeed_in(folder.path(), "report log -o out/page.html --plots figures");
    assert!(stdout.starts_with("wrote out/page.html (1 lifetime, "), "{stdout}");
    assert!(stdout.contains("wrote figures (8 figures, "), "{stdout}");
    let page = read(folder.path().join("out/page.html"));
    assert!(
        page.contains("as measured by parameters from the scenario in the log"),
        "the page names the source of the distances"
    );
    let distance = json_in(folder.path(), "distance find_objects#blue find_objects#red --json");
    let label = format!("{:.2}\n</text>", distance["total"].as_f64().expect("it is a number"));
    assert_eq!(
        page.matches(&label).count(),
        4,
        "{label} twice in each of the wide and the narrow figure"
    );
    for name in ["timeline", "learning", "evaluation", "raw"] {
        let svg = read(folder.path().join(format!("figures/log_{name}.svg")));
        assert!(svg.starts_with("<svg "), "{name}");
        let png = fs::read(folder.path().join(format!("figures/log_{name}.png"))).expect("it was written");
        assert!(png.starts_with(b"\x89PNG"), "{name}");
    }
    assert!(
        !folder.path().join("figures/log_ste.svg").exists(),
        "there is no expert"
    );
    for name in ["find_objects#blue", "find_objects#red"] {
        assert!(
            page.contains(&format!("alt=\"a world of {name}, as its agent sees it\"")),
            "{name}"
        );
    }
    assert_eq!(
        page.matches("src=\"data:image/png;base64,iVBOR").count(),
        4,
        "a view and a map of each"
    );
    for named in ["-o again.html", "-oagain.html", "--output=again.html --plots=more"] {
        succeed_in(folder.path(), &format!("report log {named}"));
        let repeated = read(folder.path().join("again.html"));
        assert_eq!(repeated, page, "the same log gives the same bytes: {named}");
    }
}

#[test]
fn failed_worlds_are_linked_to_a_workbench() {
    let folder = scratch();
    run_lifetime(folder.path());
    succeed_in(
        folder.path(),
        "report log --studio http://127.0.0.1:8008/secret/#/play/maze",
    );
    let page = read(folder.path().join("report.html"));
    let start = "<a href=\"http://127.0.0.1:8008/secret/#/play/find_objects?variant=";
    assert_eq!(page.matches(start).count(), 4, "two worlds of each variant");
    assert!(page.contains("variant=red&amp;seed=0&amp;index=1\">"), "{page}");
    let error = fail_in(folder.path(), 2, "report log --studio javascript:alert(1)");
    error.says("expected an address that begins with http://");
}

#[test]
fn matrix_distances_take_precedence_and_a_mismatch_is_reported() {
    let folder = scratch();
    run_lifetime(folder.path());
    write(
        &folder.path().join("far.csv"),
        ",find_objects#blue,find_objects#red\nfind_objects#blue,0,0.77\nfind_objects#red,0.77,0\n",
    );
    succeed_in(folder.path(), "report log --distances far.csv");
    let page = read(folder.path().join("report.html"));
    assert!(page.contains("0.77\n</text>") && page.contains("from far.csv"));
    write(&folder.path().join("other.csv"), ",a#b,c#d\na#b,0,1\nc#d,1,0\n");
    succeed_in(folder.path(), "report log --distances other.csv");
    let page = read(folder.path().join("report.html"));
    assert!(page.contains("other.csv has none of the log's variants"));
}

#[test]
fn tasks_without_their_variants_have_no_distances() {
    let folder = scratch();
    run_lifetime(folder.path());
    succeed_in(folder.path(), "report log -r agnostic");
    let page = read(folder.path().join("report.html"));
    assert!(page.contains("scored by whole tasks (variant mode agnostic), and distances are between variants"));
    assert!(!page.contains("0.00\n</text>"), "no distance is invented");
}

#[test]
fn drift_is_measured_at_both_ends() {
    let folder = scratch();
    let regime = |keys: &str| {
        let keys = format!(r#"{{ "task": "find_objects", "count": 6, "max_steps": 20, {keys} }}"#);
        format!(r#"{{ "type": "learning", "regimes": [{keys}] }}"#)
    };
    let blocks = [
        regime(r#""variant": "blue""#),
        regime(r#""variant": "blue", "drift": { "to": "red" }"#),
        regime(r#""variant": "blue""#),
    ];
    let scenario = format!(r#"{{ "name": "drifting", "blocks": [{}] }}"#, blocks.join(", "));
    write(&folder.path().join("scenario.json"), &scenario);
    succeed_in(folder.path(), "run scenario.json --agent random --output log");
    succeed_in(folder.path(), "report log");
    let page = read(folder.path().join("report.html"));
    let distance = json_in(folder.path(), "distance find_objects#red find_objects#blue --json");
    let label = format!("{:.2}\n</text>", distance["total"].as_f64().expect("it is a number"));
    assert_eq!(
        page.matches("0.00\n</text>").count(),
        2,
        "the drift begins at the variant of the block before"
    );
    assert_eq!(
        page.matches(&label).count(),
        2,
        "the block after the drift is {label} from the end of the drift"
    );
    assert!(page.contains("The beginning of a drifting block"));
}

#[test]
fn several_lifetimes_have_intervals_and_steps_on_request() {
    let folder = scratch();
    run_lifetime(folder.path());
    for output in ["more/second", "theirs/third"] {
        succeed_in(
            folder.path(),
            &format!("run scenario.json --agent random --output {output}"),
        );
    }
    let stdout = succeed_in(
        folder.path(),
        "report log more -u steps --against theirs --title All -T lb timeline",
    );
    assert!(stdout.starts_with("wrote report.html (2 lifetimes, "), "{stdout}");
    let page = read(folder.path().join("report.html"));
    for part in [
        "<h1>All</h1>",
        "Over all lifetimes",
        "against theirs",
        "step\n</text>",
        "#life-2",
    ] {
        assert!(page.contains(part), "{part}");
    }
    assert_eq!(page.matches("<figure>").count(), 4, "two figures of each");
    assert_eq!(page.matches("<figure class=\"world\">").count(), 2, "no world twice");
    assert!(page.contains("ran the same scenario as one above"));
}

#[test]
fn worlds_of_a_task_that_changed_since_the_run_are_not_pictured() {
    let folder = scratch();
    run_lifetime(folder.path());
    let info = folder.path().join("log/scenario_info.json");
    let mut json: serde_json::Value = serde_json::from_str(&read(&info)).expect("it is JSON");
    json["made_from"]["find_objects#red"]["variant"] = "0".repeat(64).into();
    write(&info, &json.to_string());
    succeed_in(folder.path(), "report log");
    let page = read(folder.path().join("report.html"));
    assert!(page.contains("No pictures of worlds: find_objects#red has changed since this run."));
    assert!(!page.contains("<figure class=\"world\">"));
}

#[test]
fn scenario_without_learning_gets_its_own_reason_for_missing_pictures() {
    let folder = scratch();
    let regime = r#"{ "task": "find_objects", "variant": "blue", "count": 2, "max_steps": 5 }"#;
    let scenario = format!(r#"{{ "name": "s", "blocks": [{{ "type": "evaluation", "regimes": [{regime}] }}] }}"#);
    write(&folder.path().join("scenario.json"), &scenario);
    succeed_in(folder.path(), "run scenario.json --agent random --output log");
    succeed_in(folder.path(), "report log");
    let page = read(folder.path().join("report.html"));
    assert!(page.contains("No pictures of worlds: no variant of a task was learned in the scenario."));
}

#[test]
fn log_warnings_are_printed_and_on_the_page() {
    let folder = scratch();
    run_lifetime(folder.path());
    fs::remove_file(folder.path().join("log/scenario_info.json")).expect("it exists");
    let done = output(&mut driftworld_in(folder.path(), "report log"));
    assert!(String::from_utf8_lossy(&done.stderr).contains("warning: log: "));
    let page = read(folder.path().join("report.html"));
    assert!(page.contains("⚠ Warning: ") && page.contains("the log does not say which scenario was run"));
}

#[test]
fn unreadable_logs_are_named_and_the_page_can_go_to_standard_output() {
    let folder = scratch();
    run_lifetime(folder.path());
    for name in ["bad", "worse"] {
        write(&folder.path().join(name).join("logger_info.json"), "{");
        write(&folder.path().join(name).join("w/0-train/data-log.tsv"), "");
    }
    let error = fail_in(folder.path(), 1, "report bad log worse");
    let lines: Vec<&str> = error.lines().collect();
    assert_eq!(lines.len(), 2, "{error}");
    assert!(lines[0].contains("bad/logger_info.json:1:") && lines[1].contains("worse/logger_info.json:1:"));
    assert!(!folder.path().join("report.html").exists());
    let page = succeed_in(folder.path(), &["report", "log", "-o", "-", "--title", " "]);
    assert!(page.starts_with("<!DOCTYPE html>") && page.ends_with("</html>\n") || page.ends_with("</html>"));
    assert!(page.contains("<h1>log</h1>"), "a blank title is ignored");
}

/// A log may name any file: only those on the command line are opened.
#[cfg(unix)]
#[test]
fn files_named_in_a_log_are_not_opened() {
    let folder = scratch();
    let path = folder.path();
    let regime = |variant: &str| {
        let keys = format!(r#""task": "mine.json", "variant": "{variant}", "count": 3, "max_steps": 5"#);
        format!(r#"{{ "type": "learning", "regimes": [{{ {keys} }}] }}"#)
    };
    let blocks = [regime("red"), regime("blue")];
    let scenario = format!(r#"{{ "name": "s", "blocks": [{}] }}"#, blocks.join(", "));
    write(&path.join("scenario.json"), &scenario);
    std::fs::copy(root().join("examples/tasks/find_objects.json"), path.join("mine.json")).expect("it is writable");
    succeed_in(path, "run scenario.json --agent random --output log");
    // Not even the file that does define the task is opened.
    succeed_in(path, "report log");
    let page = read(path.join("report.html"));
    assert!(
        page.contains("give it with --task FILE")
            && page.contains("(column distance)")
            && !page.contains("as measured from")
    );
    succeed_in(path, "report log --task mine.json");
    assert!(read(path.join("report.html")).contains("as measured by parameters from the scenario in the log"));
    // From another folder, the file's name identifies the task.
    std::fs::create_dir(path.join("tasks")).expect("the folder is writable");
    std::fs::rename(path.join("mine.json"), path.join("tasks/mine.json")).expect("the folder is writable");
    succeed_in(path, "report log --task tasks/mine.json");
    assert!(read(path.join("report.html")).contains("as measured by parameters from the scenario in the log"));
    let info = path.join("log/scenario_info.json");
    let status = std::process::Command::new("mkfifo").arg(path.join("pipe")).status();
    assert!(status.expect("every unix has mkfifo").success());
    for named in ["/dev/zero", "pipe", "../../etc/passwd"] {
        let text = read(&info).replace("mine.json", named);
        write(&path.join("other/scenario_info.json"), &text);
        let file = "logger_info.json";
        fs::copy(path.join("log").join(file), path.join("other").join(file)).expect("the folder is writable");
        let copied = std::process::Command::new("cp")
            .arg("-r")
            .arg(path.join("log/worker-default"))
            .arg(path.join("other/"))
            .status();
        assert!(copied.expect("every unix has cp").success());
        succeed_in(path, "report other");
        assert!(
            read(path.join("report.html")).contains("files that a log names are not opened"),
            "{named}"
        );
    }
}
