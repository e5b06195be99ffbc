//! Every page of `docs/` is a chapter of the book, and README.md is a page that is read to its end. What is on a page is
//! left to readers; that it can be built, to the stage `docs`.

use super::links::resolved;
use super::tree::Tree;
use crate::finding::Finding;

const SUMMARY: &str = "docs/SUMMARY.md";
const README: &str = "README.md";
const MOST_LINES: usize = 120;

pub(super) fn check(tree: &Tree) -> Vec<Finding> {
    let mut findings = Vec::new();
    if let Some(summary) = tree.text(SUMMARY) {
        let chapters: Vec<String> = resolved(SUMMARY, summary).collect();
        let pages = tree.texts(&["md"]).map(|(path, _)| path);
        let left_out = pages.filter(|path| {
            path.starts_with("docs/") && *path != SUMMARY && !chapters.iter().any(|chapter| chapter == path)
        });
        findings.extend(left_out.map(|path| {
            let advice = "add a line to docs/SUMMARY.md, where a reader would look for it";
            Finding::new(
                path,
                1,
                "no chapter of the book",
                "every page of docs/ in docs/SUMMARY.md",
                advice,
            )
        }));
    }
    let lines = tree.text(README).map_or(0, |text| text.lines().count());
    if lines > MOST_LINES {
        let expected = format!("at most {MOST_LINES}");
        let advice = "move detail to a page of docs/, and link it";
        findings.push(Finding::new(
            README,
            MOST_LINES,
            format!("{lines} lines"),
            expected,
            advice,
        ));
    }
    findings
}

#[cfg(test)]
mod tests {
    use super::*;

    fn check_files(files: &[(&str, &str)], expected: &[&str]) {
        let found: Vec<String> = check(&Tree::of(files))
            .into_iter()
            .map(|finding| finding.file)
            .collect();
        assert_eq!(found, expected, "{files:?}");
    }

    #[test]
    fn a_page_that_no_chapter_leads_to_is_reported() {
        let summary = (
            "docs/SUMMARY.md",
            "- [A](a.md)\n  - [B](b/c.md)\n- [Changes](../CHANGELOG.md)\n",
        );
        let pages = [summary, ("docs/a.md", ""), ("docs/b/c.md", ""), ("CHANGELOG.md", "")];
        check_files(&pages, &[]);
        check_files(&[&pages[..], &[("docs/b/d.md", "")]].concat(), &["docs/b/d.md"]);
    }

    #[test]
    fn the_first_page_is_short() {
        check_files(&[("README.md", &"\n".repeat(MOST_LINES))], &[]);
        check_files(&[("README.md", &"\n".repeat(MOST_LINES + 1))], &["README.md"]);
    }
}
