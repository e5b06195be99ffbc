//! The files of the checkout, as git lists them, with the text of those that rules read. Judges nothing.

use std::collections::BTreeMap;
use std::fs;
use std::path::Path;
use std::process::Command;

use crate::error::XtaskError;
use crate::process::{not_started, shown, succeeded};

/// Paths relative to the root, `/` between folders; `None` for a file whose text no rule reads.
pub(super) struct Tree {
    files: BTreeMap<String, Option<String>>,
}

impl Tree {
    /// Tracked files, and new ones that git does not ignore.
    pub(super) fn read(root: &Path) -> Result<Self, XtaskError> {
        let mut files = BTreeMap::new();
        for path in list(root)? {
            let full = root.join(&path);
            // Deleted, but not yet committed so; or a submodule.
            if !full.is_file() {
                continue;
            }
            let bytes = if is_read(&path) {
                Some(fs::read(&full).map_err(|source| XtaskError::File { path: full, source })?)
            } else {
                None
            };
            files.insert(path, bytes.map(|bytes| String::from_utf8_lossy(&bytes).into_owned()));
        }
        Ok(Self { files })
    }

    /// A tree made of these files.
    #[cfg(test)]
    pub(super) fn of(files: &[(&str, &str)]) -> Self {
        let file = |(path, text): &(&str, &str)| ((*path).to_owned(), is_read(path).then(|| (*text).to_owned()));
        Self {
            files: files.iter().map(file).collect(),
        }
    }

    /// The text files with one of these endings, with their text.
    pub(super) fn texts<'a>(&'a self, endings: &'a [&str]) -> impl Iterator<Item = (&'a str, &'a str)> {
        let wanted = move |path: &str| endings.contains(&ending(path));
        self.files
            .iter()
            .filter_map(move |(path, text)| Some((path.as_str(), text.as_deref()?)).filter(|(path, _)| wanted(path)))
    }

    /// The Rust sources that users run, but for those below a folder: each with its lines, numbered from 1, up to the
    /// unit tests at its end.
    pub(super) fn shipped_sources<'a>(
        &'a self,
        but: &'a str,
    ) -> impl Iterator<Item = (&'a str, impl Iterator<Item = (usize, &'a str)>)> {
        let is_shipped = move |path: &str| {
            let is_source = path.starts_with("src/") || path.contains("/src/");
            let is_apart = ["xtask/", "examples/", "book/", but]
                .iter()
                .any(|folder| path.starts_with(folder));
            let is_test = path.ends_with("/tests.rs") || path.contains("/tests/");
            is_source && !is_apart && !is_test
        };
        let sources = self.texts(&["rs"]).filter(move |(path, _)| is_shipped(path));
        sources.map(|(path, text)| {
            let is_test = |line: &str| line.trim_start().starts_with("#[cfg(test)]");
            let lines = text.lines().take_while(move |line| !is_test(line));
            (path, (1..).zip(lines))
        })
    }

    /// The text of one file.
    pub(super) fn text(&self, path: &str) -> Option<&str> {
        self.files.get(path)?.as_deref()
    }

    /// Whether a file, or a folder with a file in it, has this path; the empty path is the root.
    pub(super) fn has(&self, path: &str) -> bool {
        let path = path.trim_end_matches('/');
        let folder = format!("{path}/");
        path.is_empty() || self.files.contains_key(path) || self.files.keys().any(|file| file.starts_with(&folder))
    }

    /// Whether any file, in whatever folder, has this name.
    pub(super) fn has_name(&self, name: &str) -> bool {
        self.files.keys().any(|file| file.rsplit('/').next() == Some(name))
    }
}

/// The letters after the last dot of the file's name; empty for a name without one.
pub(super) fn ending(path: &str) -> &str {
    let name = path.rsplit('/').next().unwrap_or(path);
    name.rsplit_once('.').map_or("", |(_, ending)| ending)
}

fn is_read(path: &str) -> bool {
    // Without an ending: scripts such as `.ci/run`.
    ["rs", "py", "md", "toml", "sh", ""].contains(&ending(path))
}

fn list(root: &Path) -> Result<Vec<String>, XtaskError> {
    let mut command = Command::new("git");
    // A checkout that another user owns, as in a container, is read all the same.
    let trusted = format!("safe.directory={}", root.display());
    command
        .args([
            "-c",
            &trusted,
            "ls-files",
            "-z",
            "--cached",
            "--others",
            "--exclude-standard",
        ])
        .current_dir(root);
    command.stderr(std::process::Stdio::inherit());
    let output = command.output().map_err(|source| not_started(&command, source))?;
    succeeded(&shown(&command), output.status)?;
    let names = String::from_utf8_lossy(&output.stdout).into_owned();
    Ok(names
        .split('\0')
        .filter(|name| !name.is_empty())
        .map(str::to_owned)
        .collect())
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn folders_exist_through_their_files() {
        let tree = Tree::of(&[("spec/src/lib.rs", ""), ("a.png", "")]);
        for path in ["spec", "spec/", "spec/src", "spec/src/lib.rs", "a.png", ""] {
            assert!(tree.has(path), "{path}");
        }
        for path in ["spe", "src", "spec/src/lib", "b.png"] {
            assert!(!tree.has(path), "{path}");
        }
        assert!(tree.has_name("lib.rs") && !tree.has_name("src"));
    }

    #[test]
    fn only_files_that_rules_read_have_a_text() {
        let tree = Tree::of(&[("a.rs", "x"), ("b.png", "x"), (".ci/run", "x")]);
        assert_eq!(
            (tree.text("a.rs"), tree.text("b.png"), tree.text(".ci/run")),
            (Some("x"), None, Some("x"))
        );
        assert_eq!(tree.texts(&["rs"]).collect::<Vec<_>>(), [("a.rs", "x")]);
    }

    #[test]
    fn git_lists_this_very_file() {
        let root = Path::new(env!("CARGO_MANIFEST_DIR")).parent().unwrap();
        let tree = Tree::read(root).unwrap();
        assert!(
            tree.text("xtask/src/tidy/tree.rs")
                .is_some_and(|text| text.starts_with("//! "))
        );
        assert!(!tree.has("target"));
    }
}
