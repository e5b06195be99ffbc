//! Where a file of the repository is in the book: pages of `docs/` at their own names, pages from elsewhere under
//! `project/`, sources as pages under `files/`. Paths are text with `/` between folders, from the root of the checkout
//! or from that of the book. What the links in a page look like is the business of `rewrite.rs`.

use std::collections::BTreeMap;
use std::path::{Path, PathBuf};

use mdbook_driver::book::{Book, Chapter};

use crate::error::BookError;

/// The page that the book opens with.
const FIRST: &str = "README.md";

/// The list of pages, and the page that the builder makes of it.
const SUMMARY: (&str, &str) = ("docs/SUMMARY.md", "toc.html");

/// Where every page of the book comes from and goes to.
pub(crate) struct Places {
    root: PathBuf,
    /// Path in the book, by path in the repository; both of Markdown.
    pages: BTreeMap<String, String>,
}

/// What a link leads to.
#[derive(Debug, PartialEq)]
pub(crate) enum Target {
    /// Another site, or a place on the same page: left as it is.
    AsItIs,
    /// A page or a picture of the book.
    InTheBook(String),
    /// A file or folder outside `docs/` that is shown as a page of its own: the new target, and the file in the
    /// repository.
    Source(String, String),
    /// Nothing that there is.
    Missing,
}

impl Places {
    /// Reads them off the chapters, and moves those from outside `docs/` to where they belong in the book.
    pub(crate) fn of(root: &Path, book: &mut Book) -> Result<Self, BookError> {
        let mut pages = BTreeMap::new();
        let mut twice = Vec::new();
        book.for_each_chapter_mut(|chapter: &mut Chapter| {
            let Some(path) = &chapter.path else { return };
            let Some(source) = joined("docs", &slashed(path)) else {
                return;
            };
            let out = match source.strip_prefix("docs/") {
                Some(page) => page.to_owned(),
                None if source == FIRST => source.clone(),
                None => format!("project/{source}"),
            };
            // A folder opens with its page of this name.
            let out = match out.strip_suffix("README.md") {
                Some(folder) => format!("{folder}index.md"),
                None => out,
            };
            chapter.path = Some(PathBuf::from(&out));
            if pages.insert(source.clone(), out).is_some() {
                twice.push(format!(
                    "docs/SUMMARY.md: found {source} twice, expected every page once"
                ));
            }
        });
        if twice.is_empty() {
            Ok(Self {
                root: root.to_owned(),
                pages,
            })
        } else {
            Err(BookError::Links { findings: twice })
        }
    }

    /// How many pages there are.
    pub(crate) fn pages(&self) -> usize {
        self.pages.len()
    }

    /// The file in the repository that a page of the book is made of.
    pub(crate) fn source(&self, out: &Path) -> Option<&str> {
        let out = slashed(out);
        let mut pages = self.pages.iter();
        pages.find(|(_, page)| **page == out).map(|(source, _)| source.as_str())
    }

    /// Where a link on the page made of `source` leads in the book.
    pub(crate) fn target(&self, source: &str, link: &str) -> Target {
        if link.is_empty() || link.starts_with('#') || link.contains("://") || link.starts_with("mailto:") {
            return Target::AsItIs;
        }
        let (path, anchor) = link.find('#').map_or((link, ""), |at| link.split_at(at));
        let Some(path) = joined(folder(source), path) else {
            return Target::Missing;
        };
        let Some(here) = self.pages.get(source) else {
            return Target::Missing;
        };
        let seen_from_here = |out: &str| format!("{}{anchor}", relative(folder(here), out));
        if path == SUMMARY.0 {
            return Target::InTheBook(seen_from_here(SUMMARY.1));
        }
        let readme = format!("{path}/README.md");
        if let Some(out) = self.pages.get(&path).or_else(|| self.pages.get(&readme)) {
            return Target::InTheBook(seen_from_here(out));
        }
        if !self.root.join(&path).exists() {
            return Target::Missing;
        }
        match path.strip_prefix("docs/") {
            Some(inside) if !path.ends_with(".md") => Target::InTheBook(seen_from_here(inside)),
            // A page of docs/ that the summary leaves out.
            Some(_) => Target::Missing,
            None => Target::Source(seen_from_here(&format!("files/{path}.html")), path),
        }
    }

    /// Places made of these pages, for tests.
    #[cfg(test)]
    pub(crate) fn with(root: &Path, pages: &[(&str, &str)]) -> Self {
        let owned = |(source, out): &(&str, &str)| ((*source).to_owned(), (*out).to_owned());
        Self {
            root: root.to_owned(),
            pages: pages.iter().map(owned).collect(),
        }
    }
}

/// A path with `/` between its parts, on every system.
fn slashed(path: &Path) -> String {
    path.to_string_lossy().replace('\\', "/")
}

/// The folder of a file; empty for one at the root.
pub(crate) fn folder(path: &str) -> &str {
    path.rsplit_once('/').map_or("", |(folder, _)| folder)
}

/// The path from the root that `path` names, seen from `folder`; `None` when it leaves the root.
pub(crate) fn joined(folder: &str, path: &str) -> Option<String> {
    let mut parts: Vec<&str> = folder.split('/').filter(|part| !part.is_empty()).collect();
    for part in path.split('/').filter(|part| !part.is_empty() && *part != ".") {
        match part {
            ".." => drop(parts.pop()?),
            name => parts.push(name),
        }
    }
    Some(parts.join("/"))
}

/// The way from a folder to a file, both from the root.
pub(crate) fn relative(folder: &str, path: &str) -> String {
    let from: Vec<&str> = folder.split('/').filter(|part| !part.is_empty()).collect();
    let to: Vec<&str> = path.split('/').collect();
    let shared = from.iter().zip(&to[..to.len() - 1]).take_while(|(a, b)| a == b).count();
    let up = std::iter::repeat_n("..", from.len() - shared);
    up.chain(to[shared..].iter().copied()).collect::<Vec<_>>().join("/")
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn ways_lead_from_folder_to_file() {
        for (folder, path, expected) in [
            ("", "a.md", "a.md"),
            ("", "b/a.md", "b/a.md"),
            ("b", "a.md", "../a.md"),
            ("b", "b/a.md", "a.md"),
            ("b/c", "b/d/a.md", "../d/a.md"),
            ("a", "a/a/a", "a/a"),
        ] {
            assert_eq!(relative(folder, path), expected, "{folder} to {path}");
            assert_eq!(
                joined(folder, &relative(folder, path)).as_deref(),
                Some(path),
                "{folder} to {path}"
            );
        }
        assert_eq!(joined("docs", "../../a"), None);
    }

    #[test]
    fn links_are_followed_from_where_their_page_was() {
        let root = Path::new(env!("CARGO_MANIFEST_DIR")).join("..");
        let pages = [
            ("README.md", "index.md"),
            ("docs/worlds.md", "worlds.md"),
            ("docs/reference/world.md", "reference/world.md"),
            ("examples/python/README.md", "project/examples/python/index.md"),
        ];
        let places = Places::with(&root, &pages);
        let inside = |target: &str| Target::InTheBook(target.to_owned());
        for (source, link, expected) in [
            ("README.md", "docs/worlds.md#maps", inside("worlds.md#maps")),
            ("README.md", "docs/images/demo.png", inside("images/demo.png")),
            ("docs/reference/world.md", "../worlds.md", inside("../worlds.md")),
            ("README.md", "docs/SUMMARY.md", inside("toc.html")),
            ("docs/reference/world.md", "../../README.md", inside("../index.md")),
            (
                "docs/worlds.md",
                "../examples/python",
                inside("project/examples/python/index.md"),
            ),
            (
                "examples/python/README.md",
                "../../docs/worlds.md",
                inside("../../../worlds.md"),
            ),
            ("docs/worlds.md", "https://a.org/b.md", Target::AsItIs),
            ("docs/worlds.md", "#maps", Target::AsItIs),
            ("docs/worlds.md", "gone.md", Target::Missing),
            ("docs/worlds.md", "../../elsewhere.md", Target::Missing),
            // It is there, but no chapter.
            ("docs/worlds.md", "zones.md", Target::Missing),
        ] {
            assert_eq!(places.target(source, link), expected, "{source}: {link}");
        }
        let source = Target::Source("../files/deny.toml.html".to_owned(), "deny.toml".to_owned());
        assert_eq!(places.target("docs/reference/world.md", "../../deny.toml"), source);
    }
}
