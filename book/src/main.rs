//! Makes the book: pages of `docs/`, in the order of `docs/SUMMARY.md`, as HTML that opens offline. The order of work
//! is here; how a link is followed is in `places.rs`, how the result is checked in `links.rs`.

mod error;
mod links;
mod places;
mod rewrite;
mod sources;

use std::collections::BTreeSet;
use std::path::{Path, PathBuf};
use std::process::ExitCode;

use mdbook_driver::MDBook;
use mdbook_driver::book::{Book, Chapter};
use mdbook_driver::config::Config;

use error::BookError;
use places::Places;

fn main() -> ExitCode {
    let arguments: Vec<PathBuf> = std::env::args_os().skip(1).map(PathBuf::from).collect();
    let [root, target] = arguments.as_slice() else {
        eprintln!(
            "driftworld-book: found {} arguments, expected the root of the checkout and a folder for the book",
            arguments.len()
        );
        return ExitCode::from(2);
    };
    match make(root, target) {
        Ok(pages) => {
            println!("{pages} pages: {}", target.join("index.html").display());
            ExitCode::SUCCESS
        }
        Err(error) => {
            eprintln!("driftworld-book: {error}");
            ExitCode::FAILURE
        }
    }
}

/// Builds the book and checks every link of it; returns how many pages it has.
fn make(root: &Path, target: &Path) -> Result<usize, BookError> {
    let folder = root.join("book");
    let mut config = Config::from_disk(folder.join("book.toml")).map_err(BookError::Builder)?;
    config.build.build_dir = std::path::absolute(target).map_err(|source| error::file(target, source))?;
    let mut builder = MDBook::load_with_config(&folder, config).map_err(BookError::Builder)?;
    let places = Places::of(root, &mut builder.book)?;
    let linked = rewrite_all(&mut builder.book, &places)?;
    builder.build().map_err(BookError::Builder)?;
    for path in &linked {
        sources::write(root, target, path)?;
    }
    links::check(target)?;
    Ok(places.pages())
}

/// Leads every link of every page to where its target is in the book; returns which files outside `docs/` are linked.
fn rewrite_all(book: &mut Book, places: &Places) -> Result<BTreeSet<String>, BookError> {
    let mut linked = BTreeSet::new();
    let mut findings = Vec::new();
    book.for_each_chapter_mut(|chapter: &mut Chapter| {
        let Some(out) = &chapter.path else { return };
        let Some(source) = places.source(out) else { return };
        let rewritten = rewrite::links(&chapter.content, |target| places.target(source, target));
        chapter.content = rewritten.text;
        linked.extend(rewritten.linked);
        findings.extend(
            rewritten
                .missing
                .iter()
                .map(|target| format!("{source}: found a link to `{target}`, expected a file of this repository")),
        );
    });
    if findings.is_empty() {
        Ok(linked)
    } else {
        Err(BookError::Links { findings })
    }
}
