//! `ARCHITECTURE.md` stays a true map: short, and with every crate on it. That its paths lead somewhere is checked by `paths.rs`.

use super::links::prose;
use super::paths::code_spans;
use super::tree::Tree;
use crate::finding::Finding;

const FILE: &str = "ARCHITECTURE.md";
const MOST_LINES: usize = 200;

/// `members` are the crates' names and folders.
pub(super) fn check(tree: &Tree, members: &[(String, String)]) -> Vec<Finding> {
    let Some(text) = tree.text(FILE) else {
        let advice = "write it: the idea, how data flows, a code map, invariants, where to change what";
        return vec![Finding::new(FILE, 1, "no such file", "the map of the code", advice)];
    };
    let mut findings = missing_members(text, members);
    let lines = text.lines().count();
    if lines >= MOST_LINES {
        let expected = format!("fewer than {MOST_LINES}");
        findings.push(Finding::new(
            FILE,
            MOST_LINES,
            format!("{lines} lines"),
            expected,
            "move detail into docs/",
        ));
    }
    findings
}

fn missing_members(text: &str, members: &[(String, String)]) -> Vec<Finding> {
    let named = |name: &str, folder: &str| {
        let mut spans = prose(text).flat_map(|(_, line)| code_spans(line));
        spans.any(|span| span == name || (!folder.is_empty() && span.trim_end_matches('/') == folder))
    };
    let missing = members.iter().filter(|(name, folder)| !named(name, folder));
    let finding = |name: &str| {
        let advice = format!("add `{name}` or its folder to the code map");
        Finding::new(
            FILE,
            1,
            format!("no mention of the crate `{name}`"),
            "every crate in backticks",
            advice,
        )
    };
    missing.map(|(name, _)| finding(name)).collect()
}

#[cfg(test)]
mod tests {
    use super::*;

    fn check_text(text: &str, expected: &[&str]) {
        let members = [("driftworld", ""), ("driftworld-spec", "spec")].map(|(a, b)| (a.to_owned(), b.to_owned()));
        let tree = Tree::of(&[
            (FILE, text),
            ("spec/src/lib.rs", ""),
            ("src/lib.rs", ""),
            ("Cargo.toml", ""),
        ]);
        let found: Vec<String> = check(&tree, &members)
            .into_iter()
            .map(|finding| finding.found)
            .collect();
        assert_eq!(found, expected, "{text}");
    }

    #[test]
    fn a_true_map_passes() {
        check_text("`driftworld` in `src/`, `driftworld-spec` in `spec/src/lib.rs`\n", &[]);
        check_text("`driftworld`: `spec/`\n", &[]);
    }

    #[test]
    fn a_crate_off_the_map_is_reported() {
        check_text(
            "`driftworld` and its specification\n",
            &["no mention of the crate `driftworld-spec`"],
        );
    }

    #[test]
    fn the_map_is_short() {
        check_text(
            &("`driftworld` `spec`\n".to_owned() + &"\n".repeat(MOST_LINES - 2)),
            &[],
        );
        check_text(
            &("`driftworld` `spec`\n".to_owned() + &"\n".repeat(MOST_LINES - 1)),
            &["200 lines"],
        );
    }

    #[test]
    fn its_absence_is_reported() {
        let findings = check(&Tree::of(&[]), &[]);
        assert_eq!(findings.len(), 1);
        assert_eq!(findings[0].file, FILE);
    }
}
