//! Relative links in Markdown lead to files of the repository. Links to other sites are not followed: a check that
//! needs the network fails for reasons that are not ours.

use super::tree::Tree;
use crate::finding::Finding;

pub(super) fn check(tree: &Tree) -> Vec<Finding> {
    let mut findings = Vec::new();
    for (path, text) in tree.texts(&["md"]) {
        for (line, target) in links(text) {
            let broken = resolve(path, target).is_none_or(|file| !tree.has(&file));
            if broken {
                let found = format!("a link to `{target}`");
                let advice = "correct the link, or restore what it led to";
                findings.push(Finding::new(
                    path,
                    line,
                    found,
                    "a file or folder of this repository",
                    advice,
                ));
            }
        }
    }
    findings
}

/// The paths from the root that a page's links name.
pub(super) fn resolved(path: &str, text: &str) -> impl Iterator<Item = String> {
    links(text).filter_map(move |(_, target)| resolve(path, target))
}

/// Lines of a Markdown text outside fenced blocks, numbered from 1.
pub(super) fn prose(text: &str) -> impl Iterator<Item = (usize, &str)> {
    let mut fence: Option<&str> = None;
    text.lines().enumerate().filter_map(move |(index, line)| {
        let mark = ["```", "~~~"]
            .into_iter()
            .find(|mark| line.trim_start().starts_with(mark));
        match (fence, mark) {
            (None, None) => return Some((index + 1, line)),
            (None, opened) => fence = opened,
            (Some(open), Some(mark)) if open == mark => fence = None,
            _ => {}
        }
        None
    })
}

/// Line and target of every link to something of ours.
fn links(text: &str) -> impl Iterator<Item = (usize, &str)> {
    let targets = prose(text).flat_map(|(number, line)| targets(line).into_iter().map(move |target| (number, target)));
    targets.filter(|(_, target)| {
        let elsewhere = target.contains("://") || target.starts_with("mailto:") || target.starts_with('#');
        !target.is_empty() && !elsewhere
    })
}

/// The targets of `[text](target "title")` and of `[label]: target`, outside code spans.
fn targets(line: &str) -> Vec<&str> {
    let definition = line
        .trim_start()
        .strip_prefix('[')
        .and_then(|rest| rest.split_once("]: "));
    let defined = definition
        .filter(|(label, _)| !label.contains(['[', ']', '^']))
        .map(|(_, target)| target);
    let inline = line
        .match_indices("](")
        .filter(|(at, _)| !in_code(line, *at))
        .filter_map(|(at, mark)| {
            let rest = &line[at + mark.len()..];
            rest.find(')').map(|end| &rest[..end])
        });
    let first_word = |target| {
        str::split_whitespace(target)
            .next()
            .unwrap_or("")
            .trim_matches(['<', '>'])
    };
    inline.chain(defined).map(first_word).collect()
}

/// Whether an odd number of backticks stands before this place.
fn in_code(line: &str, at: usize) -> bool {
    line[..at].matches('`').count() % 2 == 1
}

/// The path from the root that the target names, seen from the file; `None` when it leaves the repository.
fn resolve(file: &str, target: &str) -> Option<String> {
    let path = target.split(['#', '?']).next().unwrap_or(target).replace("%20", " ");
    let (absolute, path) = path
        .strip_prefix('/')
        .map_or((false, path.as_str()), |path| (true, path));
    let mut parts: Vec<&str> = if absolute {
        Vec::new()
    } else {
        file.split('/').collect()
    };
    parts.pop();
    for part in path.split('/').filter(|part| !part.is_empty() && *part != ".") {
        match part {
            ".." => drop(parts.pop()?),
            name => parts.push(name),
        }
    }
    Some(parts.join("/"))
}

#[cfg(test)]
mod tests {
    use super::*;

    fn check_text(text: &str, expected: &[(usize, &str)]) {
        assert_eq!(links(text).collect::<Vec<_>>(), expected, "{text}");
    }

    #[test]
    fn links_of_every_kind_are_seen() {
        check_text(
            "a [b](c.md) and [d](e/f.md#part)\n\n![g](h.png \"i\")\n",
            &[(1, "c.md"), (1, "e/f.md#part"), (3, "h.png")],
        );
        check_text("[label]: docs/a.md\n[x](<b.md>)\n", &[(1, "docs/a.md"), (2, "b.md")]);
        check_text("[![badge](b.svg)](c.md)", &[(1, "b.svg"), (1, "c.md")]);
    }

    #[test]
    fn other_sites_anchors_and_code_are_not_ours() {
        check_text("[a](https://x.org/y.md) [b](#part) [c](mailto:a@b.c)\n", &[]);
        check_text("`a[i](x.md)`\n```\n[d](gone.md)\n```\n[e](f.md)\n", &[(5, "f.md")]);
        check_text("~~~\n```\n[d](gone.md)\n~~~\n[e](f.md)\n", &[(5, "f.md")]);
    }

    #[test]
    fn targets_are_seen_from_their_file() {
        let check_path = |file, target, expected: Option<&str>| {
            assert_eq!(resolve(file, target).as_deref(), expected, "{file}: {target}");
        };
        check_path("README.md", "docs/a.md#top", Some("docs/a.md"));
        check_path("docs/b.md", "./a.md", Some("docs/a.md"));
        check_path("docs/b.md", "../spec/", Some("spec"));
        check_path("docs/b.md", "/spec/lib.rs", Some("spec/lib.rs"));
        check_path("docs/b.md", "../../elsewhere.md", None);
    }

    #[test]
    fn a_broken_link_is_reported_at_its_line() {
        let files = [
            ("README.md", "[a](docs/a.md)\n[b](docs/b.md)\n"),
            ("docs/a.md", "[up](../README.md)\n"),
        ];
        let findings = check(&Tree::of(&files));
        assert_eq!(findings.len(), 1);
        assert_eq!(
            (findings[0].line, findings[0].found.as_str()),
            (2, "a link to `docs/b.md`")
        );
    }
}
