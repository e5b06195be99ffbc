//! Runs the commands of a page as a reader would: one block after the other, in a separate folder in which `examples/` is the
//! checkout's. A block `sh terminal=KEYS` runs on a terminal where these keys are pressed, one after each step that it shows. A
//! block `json file=NAME` or `text file=NAME` is saved; a block `sh fails` must fail; a block `text output` is the output of
//! the commands above it. A block `sh needs=MODULE` is skipped, together with its output, if `python3`, or the Python in
//! `DRIFTWORLD_PYTHON`, cannot import the module. A block `sh feature=NAME` needs a build with that feature: without it the
//! block must fail and name the feature; every other block runs in every build.
//!
//! `DRIFTWORLD_COMMAND` names the build that runs them, such as the release build that most readers have; by default the tests'
//! own.
//!
//! `DRIFTWORLD_UPDATE_PAGES=1` writes the actual output into the page, and copies pictures made by the commands to the place
//! where the page shows them: `sheet.png` becomes `images/PAGE-sheet.png`. Review the diff before committing.

use std::io::{Read, Write};
use std::path::{Path, PathBuf};
use std::process::{Command, ExitStatus, Stdio};

use super::blocks::{Block, blocks};
use super::recording::{self, Recorded};
use super::{read, root};
use crate::tier::quick_or_full;

/// Stands for any output, either lines or the rest of a line.
const OMISSION: &str = "…";

/// Runs the commands of a page; in the quick tier, only if pages are to be updated.
pub(crate) fn run(page: &str) {
    if !quick_or_full(updates(), true) {
        return;
    }
    let scratch = tempfile::tempdir().unwrap();
    let folder = scratch.path();
    for shared in ["examples", "schemas"] {
        std::os::unix::fs::symlink(root().join(shared), folder.join(shared)).unwrap();
    }
    let mut text = read(page);
    let mut printed = String::new();
    let mut recorded = if page == "docs/first-hour.md" {
        recording::first_hour()
    } else {
        Vec::new()
    };
    let is_recorded = !recorded.is_empty();
    for block in blocks(&text.clone()) {
        if let Some(name) = block.file() {
            std::fs::write(folder.join(name), &block.text).unwrap();
        } else if is_skipped(page, &block, folder) {
            OMISSION.clone_into(&mut printed);
        } else if let Some(feature) = missing_feature(&block, folder) {
            let script = ["bash", "-euo", "pipefail", "-c", &block.text];
            let done = command(&script, folder).output().unwrap();
            let stderr = String::from_utf8_lossy(&done.stderr).into_owned();
            let names_it = stderr.contains(&format!("`{feature}`"));
            assert!(!done.status.success() && names_it, "{page}:{}: {stderr}", block.line);
            OMISSION.clone_into(&mut printed);
        } else if block.language == "sh" && !block.has("by-hand") {
            printed = run_block(page, &block, folder);
            if is_recorded {
                compare(page, &block, &printed, &mut recorded);
            }
        } else if block.has("output") {
            if printed == OMISSION || same(&block.text, &printed) {
                continue;
            }
            assert!(
                updates(),
                "{page}:{}: found\n{printed}\nexpected\n{}\nDRIFTWORLD_UPDATE_PAGES=1 rewrites it",
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
    assert!(
        recorded.is_empty(),
        "{page}: these recorded commands are not on the page: {recorded:?}"
    );
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

/// Removes the commands of a block from a recording, and compares their output.
fn compare(page: &str, block: &Block, printed: &str, recorded: &mut Vec<Recorded>) {
    let advice = "python book/record.py target/release/driftworld records it again";
    let (mut commands, mut output) = (String::new(), String::new());
    while commands.len() < block.text.len() && !recorded.is_empty() {
        let next = recorded.remove(0);
        commands.extend([next.command.as_str(), "\n"]);
        output += &next.output;
    }
    assert_eq!(
        commands, block.text,
        "{page}:{}: other commands are recorded; {advice}",
        block.line
    );
    assert!(
        same(&output, printed),
        "{page}:{}: found\n{printed}\nexpected, as recorded,\n{output}\n{advice}",
        block.line
    );
}

/// Whether a block needs a module that Python cannot import here.
#[expect(clippy::print_stdout, reason = "a skip must be seen")]
fn is_skipped(page: &str, block: &Block, folder: &Path) -> bool {
    let Some(module) = block.marks.iter().find_map(|mark| mark.strip_prefix("needs=")) else {
        return false;
    };
    let tried = command(&["python3", "-c", &format!("import {module}")], folder).output();
    let is_missing = !tried.is_ok_and(|done| done.status.success());
    if is_missing {
        println!("{page}:{}: skipped: Python cannot import {module}", block.line);
    }
    is_missing
}

/// The feature that a block needs but the command lacks.
fn missing_feature<'a>(block: &'a Block, folder: &Path) -> Option<&'a str> {
    let feature = block.marks.iter().find_map(|mark| mark.strip_prefix("feature="))?;
    let report = command(&["driftworld", "doctor"], folder).output().unwrap().stdout;
    let report = String::from_utf8_lossy(&report).into_owned();
    let lacks = report.lines().find_map(|line| line.strip_prefix("build lacks "))?;
    lacks.contains(feature).then_some(feature)
}

fn updates() -> bool {
    std::env::var_os("DRIFTWORLD_UPDATE_PAGES").is_some()
}

/// The pictures of a page that its own commands make: the file in their folder, and its place on the page.
fn pictures(page: &str, text: &str) -> Vec<(String, String)> {
    let stem = Path::new(page).file_stem().unwrap().to_str().unwrap();
    let prefix = format!("images/{stem}-");
    let places = text.split("](").skip(1).filter_map(|rest| rest.split(')').next());
    let own = places.filter_map(|place| Some((place.strip_prefix(&prefix)?.to_owned(), place.to_owned())));
    // The picture of the report is taken by a browser.
    own.filter(|(name, _)| name != "report.png").collect()
}

/// The output of a block, standard output and error; without trailing spaces.
fn run_block(page: &str, block: &Block, folder: &Path) -> String {
    let script = format!("exec 2>&1\n{}", block.text);
    let bash = ["bash", "-euo", "pipefail", "-c", &script];
    let keys = block.marks.iter().find_map(|mark| mark.strip_prefix("terminal="));
    let (status, printed) = if let Some(keys) = keys {
        on_a_terminal(&bash, keys, folder)
    } else {
        let done = command(&bash, folder).output().unwrap();
        (done.status, String::from_utf8_lossy(&done.stdout).into_owned())
    };
    assert_eq!(
        status.success(),
        !block.has("fails"),
        "{page}:{}: {status}\n{}\n{printed}",
        block.line,
        block.text
    );
    // Data keep every digit.
    if !["--json", "cat ", "head "].iter().any(|data| block.text.contains(data)) {
        assert_eq!(
            noise(&printed),
            None,
            "{page}:{}: output for people has no excess decimals",
            block.line
        );
    }
    printed.lines().flat_map(|line| [line.trim_end(), "\n"]).collect()
}

/// A command whose PATH begins with the folder of our binary.
fn command(words: &[&str], folder: &Path) -> Command {
    let named = std::env::var_os("DRIFTWORLD_COMMAND").map(PathBuf::from);
    let ours = named.unwrap_or_else(|| env!("CARGO_BIN_EXE_driftworld").into());
    let mut path = std::env::var("PATH").unwrap_or_default();
    // Acts as if the virtual environment of `DRIFTWORLD_PYTHON` were active.
    let python = std::env::var("DRIFTWORLD_PYTHON").unwrap_or_default();
    if let Some(folder) = Path::new(&python).parent().filter(|folder| folder.is_dir()) {
        path = format!("{}:{path}", folder.display());
    }
    let mut command = Command::new(words[0]);
    command
        .args(&words[1..])
        .current_dir(folder)
        .env("PATH", format!("{}:{path}", ours.parent().unwrap().display()))
        .env("COLUMNS", "80")
        .env("NO_COLOR", "1");
    command
}

/// Runs an interactive command on a terminal made by `script`, and presses each key once the step before it is shown.
fn on_a_terminal(bash: &[&str], keys: &str, folder: &Path) -> (ExitStatus, String) {
    let sized = format!("stty cols 80 rows 24\n{}", bash[4]);
    let words: Vec<&str> = if cfg!(target_os = "linux") {
        // `script` passes its command to a shell as one string.
        let names = [
            "script",
            "-qec",
            "exec bash -euo pipefail -c \"$DRIFTWORLD_BLOCK\"",
            "/dev/null",
        ];
        names.to_vec()
    } else {
        [&["script", "-q", "/dev/null"], &bash[..4], &[sized.as_str()]].concat()
    };
    let mut child = command(&words, folder)
        .env("DRIFTWORLD_BLOCK", &sized)
        .env("TERM", "xterm-256color")
        .stdin(Stdio::piped())
        .stdout(Stdio::piped())
        .spawn()
        .unwrap_or_else(|error| panic!("`script` makes a terminal: {error}"));
    let (mut pressed, mut shown) = (child.stdin.take().unwrap(), child.stdout.take().unwrap());
    let mut drawn = String::new();
    let mut piece = [0; 4096];
    for (step, key) in (1..).zip(keys.chars()) {
        while !drawn.contains(&format!("step {step} ")) {
            let length = shown.read(&mut piece).unwrap();
            assert!(length > 0, "the command ended before {key:?} was pressed:\n{drawn}");
            drawn.push_str(&String::from_utf8_lossy(&piece[..length]));
        }
        pressed.write_all(key.to_string().as_bytes()).unwrap();
    }
    let mut rest = Vec::new();
    shown.read_to_end(&mut rest).unwrap();
    // The command's text follows the picture, which is removed.
    let text = String::from_utf8_lossy(&rest).replace('\r', "");
    let text = text
        .rsplit_once("\x1b[?1049l")
        .map_or(text.clone(), |(_, text)| text.to_owned());
    (child.wait().unwrap(), text)
}

/// A number with too many decimals to read, such as 100.72999999999999. Lines of JSON are data.
fn noise(printed: &str) -> Option<&str> {
    let is_part = |letter: char| letter.is_ascii_digit() || letter == '.';
    let lines = printed.lines().filter(|line| !line.contains("\": "));
    let numbers = lines.flat_map(|line| line.split(|letter| !is_part(letter)));
    let mut noisy = numbers.filter(|number| number.rsplit_once('.').is_some_and(|(_, places)| places.len() > 9));
    noisy.next()
}

#[test]
fn excessive_decimals_are_found() {
    assert_eq!(noise("reward 100.72999999999999, ended"), Some("100.72999999999999"));
    assert_eq!(noise("reward 100.73 of 5, v1.2.3, 0.12345678."), None);
    assert_eq!(noise("  \"light\": 3.0599365234375\n"), None);
}

/// Whether a page matches the output, apart from omissions. Column widths are ignored.
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
    let parts: Vec<&str> = shown.split(OMISSION).collect();
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
fn output_matches_except_for_omissions() {
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
