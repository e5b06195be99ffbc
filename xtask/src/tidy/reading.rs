//! Files are opened for reading by `driftworld-files` alone: another way would wait for a pipe without an end, or read
//! a device that has none. Tests, benches and the tools of developers name their own files.

use super::tree::Tree;
use crate::finding::Finding;

/// The ways of the standard library.
const CALLS: [&str; 3] = ["fs::read(", "fs::read_to_string(", "File::open("];

/// What a comment in front says where there is a reason for one.
const REASON: &str = "not by driftworld-files:";

pub(super) fn check(tree: &Tree) -> Vec<Finding> {
    let mut findings = Vec::new();
    for (path, lines) in tree.shipped_sources("files/") {
        let mut has_reason = false;
        for (number, line) in lines {
            if line.trim_start().starts_with("//") {
                has_reason |= line.contains(REASON);
                continue;
            }
            let calls = CALLS.into_iter().filter(|call| calls(line, call));
            findings.extend(calls.filter(|_| !has_reason).map(|call| {
                let found = format!("`{call}…)`");
                let advice = format!("call it, or say above in a comment why `{REASON}`");
                Finding::new(path, number, found, "driftworld_files::read, text or open", advice)
            }));
            has_reason = false;
        }
    }
    findings
}

/// Whether a line calls this, and not something whose name ends alike.
fn calls(line: &str, call: &str) -> bool {
    let is_alone = |at: usize| !line[..at].ends_with(|letter: char| letter.is_alphanumeric() || letter == '_');
    line.match_indices(call).any(|(at, _)| is_alone(at))
}

#[cfg(test)]
mod tests {
    use super::*;

    fn lines(path: &str, text: &str) -> Vec<usize> {
        let findings = check(&Tree::of(&[(path, text)]));
        findings.into_iter().map(|finding| finding.line).collect()
    }

    #[test]
    fn files_are_opened_by_their_own_crate() {
        let text = "let a = std::fs::read(path);\nlet b = File::open(path);\nlet c = BlockFile::open(path);\n";
        assert_eq!(lines("spec/src/a.rs", text), [1, 2]);
        assert_eq!(lines("src/a.rs", text), [1, 2]);
        for path in ["tests/a.rs", "spec/benches/a.rs", "xtask/src/a.rs", "files/src/lib.rs"] {
            assert_eq!(lines(path, text), [0; 0], "{path}");
        }
    }

    #[test]
    fn a_reason_and_a_unit_test_are_let_pass() {
        let text = "// Locked, not by driftworld-files: it is a folder.\nlet a = File::open(path);\nlet b = File::open(path);\n";
        assert_eq!(lines("src/a.rs", text), [3]);
        assert_eq!(lines("src/a.rs", &format!("#[cfg(test)]\n{text}")), [0; 0]);
    }
}
