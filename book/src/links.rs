//! Every link of the finished book leads somewhere: to a file that is there, and to an anchor on its page. Pictures and
//! style sheets count as well. Other sites are not asked: a check that needs the network fails for reasons that are
//! not ours.

use std::collections::{BTreeMap, BTreeSet};
use std::fs;
use std::path::Path;

use crate::error::{self, BookError};
use crate::places::{folder, joined};

/// What is asked of a page of HTML.
struct Page {
    ids: BTreeSet<String>,
    targets: Vec<String>,
}

/// Fails with every broken link of every page below a folder.
pub(crate) fn check(target: &Path) -> Result<(), BookError> {
    let mut files = BTreeSet::new();
    list(target, "", &mut files)?;
    let mut pages = BTreeMap::new();
    for path in files.iter().filter(|path| path.ends_with(".html")) {
        let full = target.join(path);
        let text = fs::read_to_string(&full).map_err(|source| error::file(&full, source))?;
        pages.insert(path.clone(), read(&text));
    }
    let findings = broken(&files, &pages);
    if findings.is_empty() {
        Ok(())
    } else {
        Err(BookError::Links { findings })
    }
}

fn broken(files: &BTreeSet<String>, pages: &BTreeMap<String, Page>) -> Vec<String> {
    let mut findings = Vec::new();
    for (path, page) in pages {
        for link in &page.targets {
            let elsewhere =
                link.is_empty() || link.contains("://") || link.starts_with("mailto:") || link.starts_with("data:");
            if elsewhere {
                continue;
            }
            let (file, anchor) = link.split_once('#').unwrap_or((link, ""));
            let found = if file.is_empty() {
                Some(path.clone())
            } else {
                joined(folder(path), file)
            };
            let Some(found) = found.filter(|found| files.contains(found)) else {
                findings.push(format!("{path}: found a link to `{link}`, expected a file of the book"));
                continue;
            };
            let has_anchor = |page: &Page| page.ids.contains(anchor);
            if !anchor.is_empty() && pages.get(&found).is_some_and(|page| !has_anchor(page)) {
                findings.push(format!(
                    "{path}: found a link to `{link}`, expected `{anchor}` to be a heading of {found}"
                ));
            }
        }
    }
    findings
}

/// Every file below a folder, from it.
fn list(root: &Path, below: &str, files: &mut BTreeSet<String>) -> Result<(), BookError> {
    let folder = root.join(below);
    let failed = |source| error::file(&folder, source);
    for entry in fs::read_dir(&folder).map_err(failed)? {
        let entry = entry.map_err(failed)?;
        let name = entry.file_name().to_string_lossy().into_owned();
        let path = if below.is_empty() {
            name
        } else {
            format!("{below}/{name}")
        };
        if entry.path().is_dir() {
            list(root, &path, files)?;
        } else {
            files.insert(path);
        }
    }
    Ok(())
}

/// Reads what matters off a page: the values of `id`, `href` and `src` within tags.
fn read(text: &str) -> Page {
    let mut page = Page {
        ids: BTreeSet::new(),
        targets: Vec::new(),
    };
    for tag in tags(text) {
        for (name, value) in attributes(tag) {
            match name {
                "id" | "name" => drop(page.ids.insert(plain(value))),
                "href" | "src" => page.targets.push(plain(value)),
                _ => {}
            }
        }
    }
    page
}

/// What stands between `<` and `>`, but for comments and what is in scripts.
fn tags(text: &str) -> impl Iterator<Item = &str> {
    let mut rest = text;
    std::iter::from_fn(move || {
        loop {
            rest = &rest[rest.find('<')? + 1..];
            if let Some(comment) = rest.strip_prefix("!--") {
                rest = &comment[comment.find("-->")?..];
                continue;
            }
            let tag = &rest[..rest.find('>')?];
            rest = &rest[tag.len()..];
            if tag.starts_with("script") {
                rest = &rest[rest.find("</script")?..];
            }
            return Some(tag);
        }
    })
}

/// Names and values of a tag's attributes; values stand in double quotes, as the builder writes them.
fn attributes(tag: &str) -> impl Iterator<Item = (&str, &str)> {
    let mut rest = tag;
    std::iter::from_fn(move || {
        let (before, after) = rest.split_once("=\"")?;
        let (value, after) = after.split_once('"')?;
        rest = after;
        let name = before.rsplit(char::is_whitespace).next().unwrap_or(before);
        Some((name, value))
    })
}

/// The text of an attribute's value.
fn plain(value: &str) -> String {
    value.replace("&amp;", "&").replace("&quot;", "\"").replace("%20", " ")
}

#[cfg(test)]
mod tests {
    use super::*;

    fn findings(pages: &[(&str, &str)]) -> usize {
        let files = pages
            .iter()
            .map(|(path, _)| (*path).to_owned())
            .chain(["a/b.png".to_owned()])
            .collect();
        let pages = pages
            .iter()
            .map(|(path, text)| ((*path).to_owned(), read(text)))
            .collect();
        broken(&files, &pages).len()
    }

    #[test]
    fn links_to_what_is_there_pass() {
        let page = r##"<h2 id="x">X</h2><a href="a/c.html#y">1</a><img src="a/b.png"><a href="#x">2</a><a href="https://a.b">3</a>"##;
        assert_eq!(
            findings(&[("p.html", page), ("a/c.html", r#"<p id="y"><a href="../p.html#x">"#)]),
            0
        );
    }

    #[test]
    fn a_missing_file_anchor_or_picture_is_found() {
        let there = ("a/c.html", r#"<p id="y">"#);
        for link in ["a/d.html", "a/c.html#z", "#x", "../p.html", "a/b.jpg"] {
            assert_eq!(
                findings(&[("p.html", &format!("<a href=\"{link}\">")), there]),
                1,
                "{link}"
            );
            assert_eq!(
                findings(&[("p.html", &format!("<img src=\"{link}\">")), there]),
                1,
                "{link}"
            );
        }
    }

    #[test]
    fn comments_and_scripts_hold_no_links() {
        assert_eq!(
            findings(&[(
                "p.html",
                r#"<!-- <a href="gone"> --><script>"<a href=\"gone\">"</script>"#
            )]),
            0
        );
    }
}
