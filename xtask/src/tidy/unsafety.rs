//! `docs/unsafe.md` lists every file with `unsafe`, with as many places as the code has, and nothing that has none.

use std::collections::BTreeMap;

use super::tree::Tree;
use crate::finding::Finding;

const FILE: &str = "docs/unsafe.md";

pub(super) fn check(tree: &Tree) -> Vec<Finding> {
    let found = places(tree);
    let text = tree.text(FILE).unwrap_or_default();
    let listed: BTreeMap<&str, (usize, usize)> = (1..)
        .zip(text.lines())
        .filter_map(|(line, row)| {
            let (file, count) = listed(row)?;
            Some((file, (line, count)))
        })
        .collect();
    let mut findings = Vec::new();
    for (&file, &count) in &found {
        let line = listed.get(file).map_or(1, |(line, _)| *line);
        if listed.get(file).is_none_or(|(_, listed)| *listed != count) {
            let said = listed
                .get(file)
                .map_or_else(|| "no row".to_owned(), |(_, listed)| listed.to_string());
            findings.push(Finding::new(
                FILE,
                line,
                format!("{said} for {file}"),
                format!("a row with {count} places, and why each is sound"),
                "write down what was added or is gone",
            ));
        }
    }
    for (file, (line, _)) in listed.iter().filter(|(file, _)| !found.contains_key(**file)) {
        let advice = "take the row out";
        findings.push(Finding::new(
            FILE,
            *line,
            format!("a row for {file}"),
            "files with `unsafe`",
            advice,
        ));
    }
    findings
}

/// The file and the number of places of a row such as "| `env/src/x.rs` | 3 | why |".
fn listed(row: &str) -> Option<(&str, usize)> {
    let mut cells = row.split('|').map(str::trim).skip(1);
    let file = cells.next()?.strip_prefix('`')?.strip_suffix('`')?;
    Some((file, cells.next()?.parse().ok()?))
}

/// How often each Rust file says `unsafe` as code: blocks, functions and implementations.
fn places(tree: &Tree) -> BTreeMap<&str, usize> {
    let files = tree.texts(&["rs"]);
    let counted = files.map(|(file, text)| {
        let code = text.lines().map(|line| line.split("//").next().unwrap_or_default());
        (file, code.map(in_line).sum())
    });
    counted.filter(|(_, count)| *count > 0).collect()
}

fn in_line(line: &str) -> usize {
    // Of texts, none opens a block.
    let words = line.match_indices("unsafe").map(|(at, word)| &line[at + word.len()..]);
    words
        .filter(|rest| {
            [" {", " fn ", " impl ", " extern ", " trait "]
                .iter()
                .any(|next| rest.starts_with(next))
        })
        .count()
}

#[cfg(test)]
mod tests {
    use super::*;

    fn found(list: &str, code: &str) -> Vec<String> {
        let tree = Tree::of(&[(FILE, list), ("env/src/x.rs", code)]);
        check(&tree).into_iter().map(|finding| finding.found).collect()
    }

    #[test]
    fn the_list_and_the_code_agree() {
        let code = concat!(
            "// un",
            "safe { }\nfn f() { un",
            "safe { g() } }\nun",
            "safe fn g() {}\n"
        );
        assert_eq!(found("| `env/src/x.rs` | 2 | why |\n", code), [""; 0]);
        assert_eq!(found("| `env/src/x.rs` | 1 | why |\n", code), ["1 for env/src/x.rs"]);
        assert_eq!(found("", code), ["no row for env/src/x.rs"]);
        assert_eq!(
            found("| `env/src/x.rs` | 2 | |\n| `env/src/y.rs` | 2 | |\n", code),
            ["a row for env/src/y.rs"]
        );
        assert_eq!(found("", "//! Nothing.\n"), [""; 0]);
    }
}
