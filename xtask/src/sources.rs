//! Reads the files of the checkout that git lists, and separates code from blank lines, comments and tests.

use std::collections::BTreeMap;
use std::fs;
use std::path::Path;
use std::process::Command;

use crate::process::{Result, output};

/// The text of each file, by its path relative to the root, with `/` between folders. Files that are not UTF-8 have an empty text.
pub(crate) struct Sources {
    files: BTreeMap<String, String>,
}

impl Sources {
    /// Reads tracked files, and new files that git does not ignore.
    pub(crate) fn read(root: &Path) -> Result<Self> {
        let mut list = Command::new("git");
        // Also reads a checkout owned by another user, as in a container.
        list.args(["-c", &format!("safe.directory={}", root.display())])
            .args(["ls-files", "-z", "--cached", "--others", "--exclude-standard"])
            .current_dir(root);
        let names = output(list)?;
        let existing = names.split('\0').filter(|name| root.join(name).is_file());
        let files = existing.map(|name| (name.to_owned(), fs::read_to_string(root.join(name)).unwrap_or_default()));
        Ok(Self { files: files.collect() })
    }

    /// Sources from these files.
    #[cfg(test)]
    pub(crate) fn of(files: &[(&str, &str)]) -> Self {
        let owned = files
            .iter()
            .map(|(path, text)| ((*path).to_owned(), (*text).to_owned()));
        Self { files: owned.collect() }
    }

    /// Path and text of the files with one of these extensions.
    pub(crate) fn with_extensions<'a>(&'a self, extensions: &'a [&str]) -> impl Iterator<Item = (&'a str, &'a str)> {
        let files = self.files.iter().map(|(path, text)| (path.as_str(), text.as_str()));
        files.filter(|(path, _)| extensions.contains(&extension(path)))
    }

    /// The text of a file; empty if it does not exist.
    pub(crate) fn text(&self, path: &str) -> &str {
        self.files.get(path).map_or("", String::as_str)
    }

    /// Whether a file, or a folder with a file in it, has this path; the empty path is the root.
    pub(crate) fn has(&self, path: &str) -> bool {
        let path = path.trim_end_matches('/');
        let folder = format!("{path}/");
        path.is_empty()
            || self.files.contains_key(path)
            || self
                .files
                .range(folder.clone()..)
                .next()
                .is_some_and(|(file, _)| file.starts_with(&folder))
    }

    /// Whether any file, in any folder, has this name.
    pub(crate) fn has_name(&self, name: &str) -> bool {
        self.files.keys().any(|file| file.rsplit('/').next() == Some(name))
    }
}

/// The part of a file's name after the last dot; empty without a dot.
pub(crate) fn extension(path: &str) -> &str {
    let name = path.rsplit('/').next().unwrap_or(path);
    name.rsplit_once('.').map_or("", |(_, extension)| extension)
}

/// Whether a whole file belongs to tests, benches, examples or fuzzing.
pub(crate) fn is_test_file(path: &str) -> bool {
    let (folders, name) = path.rsplit_once('/').unwrap_or(("", path));
    let is_test_folder = |folder: &str| ["tests", "test", "benches", "examples", "fuzz"].contains(&folder);
    name == "tests.rs" || folders.split('/').any(is_test_folder)
}

/// Classifies each line of a file: whether it is code, and whether it belongs to a test.
pub(crate) fn lines_of_code(path: &str, text: &str) -> Vec<Line> {
    let lines: Vec<&str> = text.lines().collect();
    let is_python = extension(path) == "py";
    let mut found = vec![Line::NoCode; lines.len()];
    let mut comment_end: Option<&str> = None;
    let mut in_test_module = false;
    for (number, line) in lines.iter().enumerate() {
        let word = line.trim();
        let opens_module = |next: &&str| next.ends_with(" {") && next.contains("mod ") && !next.starts_with(' ');
        in_test_module |= !is_python && word == "#[cfg(test)]" && lines.get(number + 1).is_some_and(opens_module);
        if let Some(end) = comment_end {
            comment_end = (!word.contains(end)).then_some(end);
        } else if let Some((end, rest)) = opened_comment(word, is_python) {
            comment_end = (!rest.contains(end)).then_some(end);
        } else if !word.is_empty() && !word.starts_with(if is_python { "#" } else { "//" }) {
            found[number] = if in_test_module || is_test_file(path) {
                Line::Test
            } else {
                Line::Code
            };
        }
        in_test_module &= *line != "}";
    }
    found
}

/// The class of a line.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(crate) enum Line {
    /// Blank, or a comment.
    NoCode,
    Code,
    Test,
}

/// The end marker of the block comment or docstring that starts on a line, and the text after its opening.
fn opened_comment(word: &str, is_python: bool) -> Option<(&'static str, &str)> {
    if is_python {
        let word = word.strip_prefix('r').unwrap_or(word);
        return word.strip_prefix("\"\"\"").map(|rest| ("\"\"\"", rest));
    }
    word.strip_prefix("/*").map(|rest| ("*/", rest))
}

/// A line without its trailing comment.
fn before_comment(line: &str) -> &str {
    line.split_once(" // ").map_or(line, |(code, _)| code)
}

/// The lines of a file; comments and tests become empty.
pub(crate) fn shipped_lines(text: &str) -> Vec<&str> {
    let code = |line: &str| !line.trim_start().starts_with("//");
    let mut lines: Vec<&str> = text
        .lines()
        .map(|line| if code(line) { before_comment(line) } else { "" })
        .collect();
    for start in 0..lines.len() {
        if lines[start].trim_start().starts_with("#[cfg(test)]") {
            let is_attribute = |line: &&str| line.trim_start().starts_with('#') || line.is_empty();
            let first = start + lines[start..].iter().take_while(|line| is_attribute(line)).count();
            let end = end_of_item(&lines, first);
            lines[start..=end].fill("");
        }
    }
    lines
}

/// The last line of the item, field or statement that starts at a line of a formatted file.
pub(crate) fn end_of_item(lines: &[&str], start: usize) -> usize {
    let indent = |line: &str| line.len() - line.trim_start().len();
    let Some(first) = lines.get(start) else {
        return lines.len() - 1;
    };
    let closes = |line: &&&str| {
        indent(line) == indent(first) && (line.trim_start().starts_with('}') || line.ends_with([';', ',']))
    };
    if first.ends_with([';', ',', '}']) {
        return start;
    }
    let rest = lines[start..].iter().position(|line| closes(&line));
    rest.map_or(lines.len() - 1, |length| start + length)
}

/// Whether a character may occur in a name.
pub(crate) fn is_name_char(c: char) -> bool {
    c.is_alphanumeric() || c == '_'
}

#[cfg(test)]
mod tests {
    use super::Line::{Code, NoCode, Test};
    use super::*;

    #[test]
    fn blank_lines_and_comments_are_not_code() {
        let rust = "//! Opens.\n\nuse a; // why\n/* one\n   two */\n/* three */\nfn f() {\n    // note\n}\n";
        assert_eq!(
            lines_of_code("spec/src/a.rs", rust),
            [NoCode, NoCode, Code, NoCode, NoCode, NoCode, Code, NoCode, Code]
        );
        let python = "\"\"\"Opens.\n\nMore.\n\"\"\"\nimport a  # why\n# note\ndef f():\n    \"\"\"Short.\"\"\"\n    return \"\"\"x\"\"\"\n";
        assert_eq!(
            lines_of_code("python/a.py", python),
            [NoCode, NoCode, NoCode, NoCode, Code, NoCode, Code, NoCode, Code]
        );
    }

    #[test]
    fn tests_are_counted_separately() {
        let inline = "fn f() {}\n#[cfg(test)]\nmod tests {\n    fn g() {}\n}\nfn h() {}\n";
        assert_eq!(
            lines_of_code("spec/src/a.rs", inline),
            [Code, Test, Test, Test, Test, Code]
        );
        for path in "spec/tests/a.rs spec/src/tests.rs env/benches/a.rs examples/a.rs fuzz/src/a.rs".split(' ') {
            assert_eq!(lines_of_code(path, "fn f() {}\n"), [Test], "{path}");
        }
        // The declaration of a test module in its own file has no block to skip.
        assert_eq!(
            lines_of_code("spec/src/a.rs", "#[cfg(test)]\nmod tests;\nfn f() {}\n"),
            [Code, Code, Code]
        );
    }
}
