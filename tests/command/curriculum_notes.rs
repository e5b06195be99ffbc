//! Tests that `driftworld curriculum` prints notes on surprising designs and does not overwrite files.

use std::path::Path;

use super::terminal::{Says, driftworld_in, fail_in, output, scratch, succeed_in};

/// A small design of two variants, with further arguments.
fn design(more: &str) -> String {
    format!("curriculum find_objects#blue find_objects#red --learn 2 --eval-episodes 1 {more}")
}

/// Runs the command, which must succeed, and returns its standard output and standard error.
#[track_caller]
fn run_design(folder: &Path, more: &str) -> (String, String) {
    let output = output(&mut driftworld_in(folder, &design(&format!("--worlds 0 {more}"))));
    let stderr = String::from_utf8(output.stderr).expect("it is text");
    assert!(output.status.success(), "{more}: {stderr}");
    (String::from_utf8(output.stdout).expect("it is text"), stderr)
}

#[test]
fn note_names_held_out_variants() {
    let folder = scratch();
    let (_, stderr) = run_design(folder.path(), "find_objects#dusk --hold-out find_objects#dusk");
    let note = "note: find_objects#dusk is named and held out: it is evaluated but not learned";
    assert!(stderr.contains(note), "{stderr}");
    let (whole, stderr) = run_design(folder.path(), "--hold-out find_objects#dusk");
    assert!(!stderr.contains("note:"), "{stderr}");
    // A bare name refers to a learned task.
    let (bare, _) = run_design(folder.path(), "--hold-out dusk");
    assert_eq!(bare, whole);
}

/// For a random order, ends are refused, and so are starts without a probe.
#[test]
fn start_of_a_probe_is_the_base_of_comparison() {
    let folder = scratch();
    run_design(
        folder.path(),
        "--probe observation --start find_objects#blue --form permuted",
    );
}

#[test]
fn note_reports_incomplete_squares() {
    let folder = scratch();
    let three = "find_objects#dusk --form permuted --lifetimes";
    let (_, stderr) = run_design(folder.path(), &format!("{three} 4 -o four"));
    let note = "note: 4 lifetimes of 3 variants are not balanced";
    assert!(
        stderr.contains(note) && stderr.contains("6 lifetimes, or a multiple of it"),
        "{stderr}"
    );
    let (_, stderr) = run_design(folder.path(), &format!("{three} 12 -o twelve"));
    assert!(!stderr.contains("balanced"), "{stderr}");
}

#[test]
fn existing_files_in_a_folder_are_not_replaced() {
    let folder = scratch();
    let lifetimes = "--lifetimes 2 -o lives --experts experts";
    run_design(folder.path(), lifetimes);
    let file = folder.path().join("lives/curriculum-2.json");
    let before = std::fs::read(&file).expect("the scenario exists");
    let other = format!("{lifetimes} --seed 5");
    let error = fail_in(folder.path(), 1, &design(&other));
    error.says("lives/curriculum-1.json: found a file, expected none");
    error.says("--force");
    assert_eq!(std::fs::read(&file).expect("the scenario exists"), before);
    // Nothing is written if a later folder is in the way.
    std::fs::remove_dir_all(folder.path().join("lives")).expect("the folder exists");
    let error = fail_in(folder.path(), 1, &design(&other));
    assert!(error.contains("experts/curriculum-1-"), "{error}");
    assert!(!folder.path().join("lives").exists());
    run_design(folder.path(), &format!("{other} --force"));
    assert_ne!(std::fs::read(&file).expect("the scenario exists"), before);
}

#[test]
fn reward_probe_reports_whether_the_optimum_changes() {
    let folder = scratch();
    let probe = |other: &str, worlds: u8| {
        let line = format!("curriculum find_objects#blue {other} --probe reward --worlds {worlds} --force -o x.json");
        succeed_in(folder.path(), &line)
    };
    let row = |shown: &str| {
        shown
            .lines()
            .find(|line| line.starts_with("find_objects#blue, find_objects#"))
            .map(str::to_owned)
    };
    let half = row(&probe("half", 1)).expect("there is such a row");
    assert!(half.starts_with("find_objects#blue, find_objects#half  no"), "{half}");
    let turned = probe("turned", 1);
    assert!(row(&turned).is_some_and(|row| row.contains("  yes")), "{turned}");
    assert_eq!(row(&probe("half", 0)), None);
}

#[test]
fn tables_of_lifetimes_name_both_ends_of_a_drift() {
    let folder = scratch();
    let (shown, _) = run_design(folder.path(), "--drift linear --lifetimes 2 -o lives");
    assert!(
        shown
            .lines()
            .next()
            .is_some_and(|line| line.ends_with(" (blue to red)")),
        "{shown}"
    );
}

#[test]
fn note_says_that_experts_of_a_mixture_learn_other_worlds() {
    let folder = scratch();
    let mixed = "--drift linear --experts experts -o x.json";
    let (_, stderr) = run_design(folder.path(), &format!("{mixed} --mix=task"));
    assert!(stderr.contains("note: experts of a mixture"), "{stderr}");
    let (_, stderr) = run_design(folder.path(), &format!("{mixed} --force"));
    assert!(!stderr.contains("note:"), "{stderr}");
}
