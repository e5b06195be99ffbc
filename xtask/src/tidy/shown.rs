//! Names of files come into messages by `driftworld_text::ShownPath` alone: `Path::display` shows them as they are, and
//! a name may hold anything that works a terminal. Tests and the tools of developers name their own files.

use super::tree::Tree;
use crate::finding::Finding;

/// The way of the standard library, but where what it makes is a name that is handed on.
const CALL: &str = ".display()";

pub(super) fn check(tree: &Tree) -> Vec<Finding> {
    let mut findings = Vec::new();
    for (path, lines) in tree.shipped_sources("text/") {
        for (number, line) in lines {
            let is_comment = line.trim_start().starts_with("//");
            let shows = |(at, _): (usize, &str)| !line[at + CALL.len()..].starts_with(".to_string()");
            if !is_comment && line.match_indices(CALL).any(shows) {
                let found = format!("`{CALL}`");
                let advice = "a name of a file may hold escape sequences and line ends";
                let expected = "`.shown()` of driftworld_text::ShownPath";
                findings.push(Finding::new(path, number, found, expected, advice));
            }
        }
    }
    findings
}

#[cfg(test)]
mod tests {
    use super::*;

    fn check_line(path: &str, line: &str, expected: usize) {
        let findings = check(&Tree::of(&[(path, line)]));
        assert_eq!(findings.len(), expected, "{path}: {line}: {findings:?}");
    }

    #[test]
    fn paths_are_shown_and_names_are_handed_on() {
        check_line("src/a.rs", "format!(\"{}\", path.display())", 1);
        check_line("metrics/src/error.rs", "#[error(\"{}\", path.display())]", 1);
        check_line("src/a.rs", "let name = path.display().to_string();", 0);
        check_line("src/a.rs", "format!(\"{}\", path.shown())", 0);
        check_line("src/a.rs", "// path.display()", 0);
        check_line("src/a.rs", "#[cfg(test)]\nmod tests { fn f() { path.display() } }", 0);
        check_line("xtask/src/a.rs", "path.display()", 0);
        check_line("tests/command/a.rs", "path.display()", 0);
    }
}
