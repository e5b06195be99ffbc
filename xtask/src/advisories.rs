//! Which crates were held against the database of advisories, and by which state of it: a file in the tree, so that a
//! machine that cannot reach the database says what is known all the same. The check itself is cargo-deny's, see
//! `deny.rs`.

use std::collections::BTreeSet;
use std::fmt::Write;
use std::fs;

use crate::error::XtaskError;
use crate::lock::{Locked, locked};
use crate::process::{bare, quiet_output};
use crate::workspace::Workspace;

/// The file, from the workspace's root.
const FILE: &str = "xtask/advisories-checked.txt";

/// What the file says.
#[derive(Debug, PartialEq, Eq)]
struct Checked {
    /// Two lines: the day of the check, and the state of the database.
    when: String,
    /// Names with versions.
    crates: BTreeSet<String>,
}

/// How much of what `Cargo.lock` holds was checked elsewhere, as a sentence.
pub(crate) fn known(workspace: &Workspace) -> Result<String, XtaskError> {
    let path = workspace.root.join(FILE);
    let text = match fs::read_to_string(&path) {
        Ok(text) => text,
        Err(source) if source.kind() == std::io::ErrorKind::NotFound => String::new(),
        Err(source) => return Err(XtaskError::File { path, source }),
    };
    let foreign = foreign(&locked(workspace)?);
    Ok(sentence(&read(&text), &foreign))
}

/// Writes down that every crate in `Cargo.lock` was checked today.
pub(crate) fn write(workspace: &Workspace, date: &str, commit: &str) -> Result<(), XtaskError> {
    let mut today = bare("date");
    today.args(["-u", "+%F"]);
    let today = quiet_output(today)?;
    let mut text = format!(
        "# The crates of Cargo.lock in which `cargo xtask advisories` found no advisory that deny.toml does not name.\n\
         checked on {}\ndatabase of {date}, {commit}\n",
        today.trim()
    );
    for name in foreign(&locked(workspace)?) {
        writeln!(text, "{name}").expect("writing to a String does not fail");
    }
    let path = workspace.root.join(FILE);
    fs::write(&path, text).map_err(|source| XtaskError::File { path, source })?;
    println!("wrote {FILE}");
    Ok(())
}

/// What comes from a registry, by name and version.
fn foreign(locked: &[Locked]) -> BTreeSet<String> {
    let foreign = locked.iter().filter(|locked| locked.checksum.is_some());
    foreign
        .map(|locked| format!("{} {}", locked.name, locked.version))
        .collect()
}

fn read(text: &str) -> Checked {
    let lines: Vec<&str> = text.lines().filter(|line| !line.starts_with('#')).collect();
    let (when, crates) = lines.split_at(lines.len().min(2));
    Checked {
        when: when.join(" by the "),
        crates: crates.iter().map(|line| (*line).to_owned()).collect(),
    }
}

fn sentence(checked: &Checked, foreign: &BTreeSet<String>) -> String {
    let new: Vec<&str> = foreign.difference(&checked.crates).map(String::as_str).collect();
    let (all, known) = (foreign.len(), foreign.len() - new.len());
    if checked.when.is_empty() {
        return format!("No check of the {all} crates is written down in {FILE}");
    }
    let rest = if new.is_empty() {
        String::new()
    } else {
        format!("; new since then: {}", new.join(", "))
    };
    format!("{known} of the {all} crates were {}{rest}", checked.when)
}

#[cfg(test)]
mod tests {
    use super::*;

    fn check(text: &str, crates: &[&str], expected: &str) {
        let foreign = crates.iter().map(|name| (*name).to_owned()).collect();
        assert_eq!(sentence(&read(text), &foreign), expected);
    }

    #[test]
    fn what_was_not_checked_is_named() {
        let text = "# words\nchecked on 2026-01-02\ndatabase of 2026-01-01, abc\na 1.0.0\nb 2.0.0\n";
        let when = "checked on 2026-01-02 by the database of 2026-01-01, abc";
        check(text, &["a 1.0.0"], &format!("1 of the 1 crates were {when}"));
        check(
            text,
            &["a 1.0.1", "b 2.0.0", "c 1.0.0"],
            &format!("1 of the 3 crates were {when}; new since then: a 1.0.1, c 1.0.0"),
        );
        check(
            "",
            &["a 1.0.0"],
            "No check of the 1 crates is written down in xtask/advisories-checked.txt",
        );
    }
}
