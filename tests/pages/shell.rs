//! Runs the commands of a page as its reader would: one block after the other, in a folder of their own in which
//! `examples/` is the checkout's. A block `json file=NAME` or `text file=NAME` is saved; a block `sh fails` must fail; a
//! block `text output` is what the commands above it print.
//!
//! `DRIFTWORLD_UPDATE_PAGES=1` writes what is printed into the page, and copies the pictures that the commands made to where
//! the page shows them: `sheet.png` is `images/PAGE-sheet.png`. Read the difference before you commit it.

use std::path::Path;
use std::process::Command;

use crate::blocks::{Block, blocks};
use crate::{read, root};

/// It stands for whatever was printed there, be it lines or the rest of one.
const LEFT_OUT: &str = "…";

pub(crate) fn run(page: &str) {
    let scratch = tempfile::tempdir().unwrap();
    let folder = scratch.path();
    for shared in ["examples", "schemas"] {
        std::os::unix::fs::symlink(root().join(shared), folder.join(shared)).unwrap();
    }
    let mut text = read(page);
    let mut printed = String::new();
    for block in blocks(&text.clone()) {
        if let Some(name) = block.file() {
            std::fs::write(folder.join(name), &block.text).unwrap();
        } else if block.language == "sh" && !block.has("by-hand") {
            printed = run_block(page, &block, folder);
        } else if block.has("output") {
            if same(&block.text, &printed) {
                continue;
            }
            assert!(
                updates(),
                "{page}:{}: found\n{printed}\nexpected\n{}\nDRIFTWORLD_UPDATE_PAGES=1 writes it anew",
                block.line,
                block.text
            );
            text = text.replacen(
                &format!("```text output\n{}```", block.text),
                &format!("```text output\n{printed}```"),
                1,
            );
        }
    }
    let pictures = pictures(page, &text);
    for (picture, place) in &pictures {
        assert!(
            folder.join(picture).is_file(),
            "{page}: shows {place}, but no command makes {picture}"
        );
        if updates() {
            std::fs::copy(folder.join(picture), root().join("docs").join(place)).unwrap();
        }
    }
    if updates() {
        std::fs::write(root().join(page), text).unwrap();
    }
}

fn updates() -> bool {
    std::env::var_os("DRIFTWORLD_UPDATE_PAGES").is_some()
}

/// The pictures of a page that its own commands make: the file in their folder, and where the page shows it from.
fn pictures(page: &str, text: &str) -> Vec<(String, String)> {
    let stem = Path::new(page).file_stem().unwrap().to_str().unwrap();
    let prefix = format!("images/{stem}-");
    let places = text.split("](").skip(1).filter_map(|rest| rest.split(')').next());
    let own = places.filter_map(|place| Some((place.strip_prefix(&prefix)?.to_owned(), place.to_owned())));
    // A picture of a page is taken by a browser.
    own.filter(|(name, _)| name != "report.png").collect()
}

/// What a block prints, to both of its outputs; lines have no spaces at their ends.
fn run_block(page: &str, block: &Block, folder: &Path) -> String {
    let command = Path::new(env!("CARGO_BIN_EXE_driftworld"));
    let path = std::env::var("PATH").unwrap_or_default();
    let done = Command::new("bash")
        .args(["-euo", "pipefail", "-c", &format!("exec 2>&1\n{}", block.text)])
        .current_dir(folder)
        .env("PATH", format!("{}:{path}", command.parent().unwrap().display()))
        .env("COLUMNS", "80")
        .env("NO_COLOR", "1")
        .output()
        .unwrap();
    let printed = String::from_utf8_lossy(&done.stdout);
    let ends_well = done.status.success();
    assert_eq!(
        ends_well,
        !block.has("fails"),
        "{page}:{}: {}\n{}\n{printed}",
        block.line,
        done.status,
        block.text
    );
    printed.lines().flat_map(|line| [line.trim_end(), "\n"]).collect()
}

/// Whether a page shows what was printed, apart from what it leaves out. How wide columns are does not matter.
fn same(shown: &str, printed: &str) -> bool {
    let narrow = |text: &str| {
        let lines = text.lines().map(|line| {
            line.split(' ')
                .filter(|word| !word.is_empty())
                .collect::<Vec<_>>()
                .join(" ")
        });
        lines.map(|line| line + "\n").collect::<String>()
    };
    let (shown, printed) = (narrow(shown).replace("…\n", "…"), narrow(printed));
    let parts: Vec<&str> = shown.split(LEFT_OUT).collect();
    let [first, .., last] = parts.as_slice() else {
        return shown == printed;
    };
    let Some(mut rest) = printed.strip_prefix(first) else {
        return false;
    };
    for part in &parts[1..parts.len() - 1] {
        let Some(at) = rest.find(part) else { return false };
        rest = &rest[at + part.len()..];
    }
    rest.ends_with(last)
}

#[test]
fn output_is_what_was_printed_but_for_what_is_left_out() {
    for (shown, is_same) in [
        ("a\nb  b\nc\n", true),
        ("a\n…\nc\n", true),
        ("…\nc\n", true),
        ("a\n…\n", true),
        ("…\nb …\n…\n", true),
        ("a\nb …\nc\n", true),
        ("…\na\nb b\nc\n", true),
        ("a\nb\n", false),
        ("b b\n…\n", false),
        ("…\nb b\n", false),
        ("…\nd\n…\n", false),
    ] {
        assert_eq!(same(shown, "a\nb b\nc\n"), is_same, "{shown:?}");
    }
}
