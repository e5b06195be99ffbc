//! Files of the repository that pages link to, each shown as a page of its own: a reader of the book needs neither the
//! checkout nor the network. Folders become lists of what is in them.

use std::fmt::Write as _;
use std::fs;
use std::path::Path;

use crate::error::{self, BookError};

/// A longer file is cut, and says so: no page is megabytes.
const MOST_BYTES: usize = 400_000;

/// Writes the page of a file or a folder; `path` is from the root of the checkout, without `..`.
pub(crate) fn write(root: &Path, target: &Path, path: &str) -> Result<(), BookError> {
    let from = root.join(path);
    let body = if from.is_dir() { listing(&from)? } else { text(&from)? };
    let to = target.join("files").join(format!("{path}.html"));
    if let Some(folder) = to.parent() {
        fs::create_dir_all(folder).map_err(|source| error::file(folder, source))?;
    }
    let home = "../".repeat(path.matches('/').count() + 1) + "index.html";
    let name = escaped(path);
    let page = format!(
        "<!DOCTYPE html>\n<html lang=\"en\"><head><meta charset=\"utf-8\"><title>{name}</title>\n\
         <meta name=\"viewport\" content=\"width=device-width, initial-scale=1\">\n\
         <style>:root {{ color-scheme: light dark }} body {{ margin: 1rem; font-family: sans-serif }} \
         pre {{ overflow-x: auto; font-size: 0.85rem; line-height: 1.4 }}</style></head>\n\
         <body><p><a href=\"{home}\">Driftworld</a> / <b>{name}</b></p>\n<pre>{body}</pre></body></html>\n"
    );
    fs::write(&to, page).map_err(|source| error::file(&to, source))
}

fn text(path: &Path) -> Result<String, BookError> {
    let bytes = fs::read(path).map_err(|source| error::file(path, source))?;
    let shown = &bytes[..bytes.len().min(MOST_BYTES)];
    let mut text = escaped(&String::from_utf8_lossy(shown));
    if shown.len() < bytes.len() {
        text.push_str("\n… the rest of this file is in the repository");
    }
    Ok(text)
}

/// The names in a folder, sorted; folders end with `/`.
fn listing(folder: &Path) -> Result<String, BookError> {
    let failed = |source| error::file(folder, source);
    let mut names = Vec::new();
    for entry in fs::read_dir(folder).map_err(failed)? {
        let entry = entry.map_err(failed)?;
        let end = if entry.path().is_dir() { "/" } else { "" };
        names.push(format!("{}{end}", entry.file_name().to_string_lossy()));
    }
    names.sort();
    let mut list = String::new();
    for name in names.iter().filter(|name| !name.starts_with(['.', '_'])) {
        // Writing into a String does not fail.
        let _ = writeln!(list, "{}", escaped(name));
    }
    Ok(list)
}

/// Text as HTML shows it.
fn escaped(text: &str) -> String {
    text.replace('&', "&amp;")
        .replace('<', "&lt;")
        .replace('>', "&gt;")
        .replace('"', "&quot;")
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_file_is_shown_as_it_is() {
        let folder = std::env::temp_dir().join(format!("driftworld-book-{}", std::process::id()));
        fs::create_dir_all(folder.join("in/a")).unwrap();
        fs::write(folder.join("in/a/b.json"), "{\"a\": \"<b> & c\"}").unwrap();
        write(&folder.join("in"), &folder.join("out"), "a/b.json").unwrap();
        write(&folder.join("in"), &folder.join("out"), "a").unwrap();
        let page = fs::read_to_string(folder.join("out/files/a/b.json.html")).unwrap();
        let list = fs::read_to_string(folder.join("out/files/a.html")).unwrap();
        fs::remove_dir_all(&folder).unwrap();
        assert!(
            page.contains("<pre>{&quot;a&quot;: &quot;&lt;b&gt; &amp; c&quot;}</pre>"),
            "{page}"
        );
        assert!(page.contains("href=\"../../index.html\""), "{page}");
        assert!(
            list.contains("<pre>b.json\n</pre>") && list.contains("href=\"../index.html\""),
            "{list}"
        );
    }
}
