//! What `driftworld curriculum` says of designs that are not what they seem, and what it does not write over.

use std::path::Path;

use super::terminal::{driftworld_in, fail_in, output, scratch};

const TWO: [&str; 2] = ["find_objects#blue", "find_objects#red"];

const SMALL: [&str; 6] = ["--learn", "2", "--eval-episodes", "1", "--worlds", "0"];

/// What is printed and what is said beside it; the command succeeds.
#[track_caller]
fn said(folder: &Path, arguments: &[&str]) -> (String, String) {
    let all = [&["curriculum"][..], arguments, &SMALL].concat();
    let output = output(&mut driftworld_in(folder, &all));
    let beside = String::from_utf8(output.stderr).expect("text");
    assert!(output.status.success(), "{all:?}: {beside}");
    (String::from_utf8(output.stdout).expect("text"), beside)
}

#[track_caller]
fn refused(folder: &Path, code: i32, arguments: &[&str]) -> String {
    fail_in(folder, code, &[&["curriculum"][..], arguments, &SMALL].concat())
}

#[test]
fn a_named_variant_that_is_held_out_is_said() {
    let folder = scratch();
    let three = [&TWO[..], &["find_objects#dusk", "--hold-out", "find_objects#dusk"]].concat();
    let (_, beside) = said(folder.path(), &three);
    let note = "note: find_objects#dusk is named and held out: it is evaluated and not learned";
    assert!(beside.contains(note), "{beside}");
    let (_, beside) = said(
        folder.path(),
        &[&TWO[..], &["--hold-out", "find_objects#dusk"]].concat(),
    );
    assert!(!beside.contains("note:"), "{beside}");
    // A bare name is one of a task that is learned.
    let (bare, _) = said(folder.path(), &[&TWO[..], &["--hold-out", "dusk"]].concat());
    let (whole, _) = said(
        folder.path(),
        &[&TWO[..], &["--hold-out", "find_objects#dusk"]].concat(),
    );
    assert_eq!(bare, whole);
    let none = refused(folder.path(), 1, &[&TWO[..], &["--hold-out", "nothing"]].concat());
    assert!(none.contains("--hold-out: found task \"nothing\""), "{none}");
}

#[test]
fn an_order_beside_a_random_one_is_refused() {
    let folder = scratch();
    for order in [
        ["--order", "gradual"],
        ["--order", "exact"],
        ["--start", TWO[1]],
        ["--end", TWO[1]],
    ] {
        let both = refused(folder.path(), 2, &[&TWO[..], &["--form", "permuted"], &order].concat());
        let expected = format!(
            "{}: found with --form permuted, whose order is drawn at random",
            order[0]
        );
        assert!(both.contains(&expected), "{both}");
    }
    // The start of a probe says what the others differ from.
    let probe = ["--probe", "observation", "--start", TWO[0], "--form", "permuted"];
    said(folder.path(), &[&TWO[..], &probe].concat());
}

#[test]
fn squares_that_are_not_full_are_said() {
    let folder = scratch();
    let three = [&TWO[..], &["find_objects#dusk", "--form", "permuted", "--lifetimes"]].concat();
    let (_, beside) = said(folder.path(), &[&three[..], &["4", "-o", "four"]].concat());
    let note = "note: 4 lifetimes of 3 variants are not balanced";
    assert!(
        beside.contains(note) && beside.contains("6 lifetimes, or a multiple of it"),
        "{beside}"
    );
    let (_, beside) = said(folder.path(), &[&three[..], &["12", "-o", "twelve"]].concat());
    assert!(!beside.contains("balanced"), "{beside}");
}

#[test]
fn what_stands_in_a_folder_is_not_replaced() {
    let folder = scratch();
    let lifetimes = [&TWO[..], &["--lifetimes", "2", "-o", "lives", "--experts", "experts"]].concat();
    said(folder.path(), &lifetimes);
    let file = folder.path().join("lives/curriculum-2.json");
    let before = std::fs::read(&file).expect("a scenario");
    let other = [&lifetimes[..], &["--seed", "5"]].concat();
    let again = refused(folder.path(), 1, &other);
    assert!(
        again.contains("lives/curriculum-1.json: found a file, expected none") && again.contains("--force"),
        "{again}"
    );
    assert_eq!(std::fs::read(&file).expect("a scenario"), before);
    // Nothing is written where a later folder is in the way.
    std::fs::remove_dir_all(folder.path().join("lives")).expect("a folder");
    assert!(refused(folder.path(), 1, &other).contains("experts/curriculum-1-blue.json"));
    assert!(!folder.path().join("lives").exists());
    said(folder.path(), &[&other[..], &["--force"]].concat());
    assert_ne!(std::fs::read(&file).expect("a scenario"), before);
}

#[test]
fn a_file_or_standard_output_for_several_scenarios_is_refused() {
    let folder = scratch();
    let file = refused(
        folder.path(),
        2,
        &[&TWO[..], &["--lifetimes", "2", "-o", "x.json"]].concat(),
    );
    assert!(
        file.contains("--output: found the file x.json, expected a folder: several scenarios"),
        "{file}"
    );
    for option in ["--experts", "--controls"] {
        let dash = refused(folder.path(), 2, &[&TWO[..], &[option, "-", "-o", "one.json"]].concat());
        assert!(
            dash.contains(&format!("{option}: found standard output, expected a folder")),
            "{dash}"
        );
    }
    assert!(!folder.path().join("-").exists() && !folder.path().join("one.json").exists());
}

#[test]
fn a_probe_of_the_reward_says_whether_what_is_best_changes() {
    let folder = scratch();
    let probe = |variants: [&str; 2], worlds: &str| {
        let arguments = [
            &["curriculum"][..],
            &variants,
            &[
                "--probe",
                "reward",
                "--learn",
                "2",
                "--eval-episodes",
                "1",
                "--worlds",
                worlds,
                "-o",
                "x.json",
            ],
        ];
        let output = output(&mut driftworld_in(folder.path(), &arguments.concat()));
        String::from_utf8(output.stdout).expect("text")
    };
    let row = |shown: &str| {
        shown
            .lines()
            .find(|line| line.starts_with("find_objects#blue, find_objects#"))
            .map(str::to_owned)
    };
    let half = row(&probe(["find_objects#blue", "find_objects#half"], "1")).expect("a row");
    assert!(half.starts_with("find_objects#blue, find_objects#half  no"), "{half}");
    let turned = probe(["find_objects#blue", "find_objects#turned"], "1");
    assert!(row(&turned).is_some_and(|row| row.contains("  yes")), "{turned}");
    assert_eq!(row(&probe(["find_objects#blue", "find_objects#half"], "0")), None);
}

#[test]
fn lists_of_lifetimes_name_both_ends_of_a_drift() {
    let folder = scratch();
    let drift = ["--drift", "linear", "--lifetimes", "2", "-o", "lives"];
    let (shown, _) = said(folder.path(), &[&TWO[..], &drift].concat());
    assert!(
        shown
            .lines()
            .next()
            .is_some_and(|line| line.ends_with(" (blue to red)")),
        "{shown}"
    );
}

#[test]
fn experts_of_a_mixture_are_said_to_learn_other_worlds() {
    let folder = scratch();
    let mixed = ["--drift", "linear", "--experts", "experts", "-o", "x.json"];
    let (_, beside) = said(folder.path(), &[&TWO[..], &mixed, &["--mix=task"]].concat());
    assert!(beside.contains("note: experts of a mixture"), "{beside}");
    let (_, beside) = said(folder.path(), &[&TWO[..], &mixed, &["--force"]].concat());
    assert!(!beside.contains("note:"), "{beside}");
}

#[test]
fn a_negative_seed_is_a_wrong_value_and_no_option() {
    let folder = scratch();
    let negative = refused(folder.path(), 2, &[&TWO[..], &["--seed", "-1"]].concat());
    assert!(
        negative.contains("invalid value '-1' for '--seed <SEED>'"),
        "{negative}"
    );
}
