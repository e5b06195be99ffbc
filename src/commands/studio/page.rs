//! [`Page`]: the files of the workbench in memory, embedded in the program or read from what `cargo xtask studio` built.

use std::borrow::Cow;
use std::collections::BTreeMap;
use std::path::{Path, PathBuf};

use driftworld_text::ShownPath;

use crate::Failure;

/// The files embedded in the program at build time; none unless the page had been built before.
const EMBEDDED: &[(&str, &[u8])] = include!(concat!(env!("OUT_DIR"), "/studio_files.rs"));

/// The environment variable that names a folder with the page, both at run time and at build time.
const VARIABLE: &str = "DRIFTWORLD_STUDIO";

/// Maximum size in bytes of a file of the page.
const MAX_FILE_BYTES: u64 = 1 << 26;

/// Files by their paths below the page's folder, with `/` as separator. No other file can be served.
pub(super) struct Page(BTreeMap<String, Cow<'static, [u8]>>);

impl Page {
    /// The page in the folder named by the environment variable, else the embedded page, else the one built beside the program.
    pub(super) fn find() -> Result<Self, Failure> {
        if let Some(folder) = std::env::var_os(VARIABLE).map(PathBuf::from) {
            return Self::read(&folder);
        }
        if !EMBEDDED.is_empty() {
            let owned = |(name, bytes): &(&str, &'static [u8])| ((*name).to_owned(), Cow::Borrowed(*bytes));
            return Ok(Self(EMBEDDED.iter().map(owned).collect()));
        }
        let folder = std::env::current_exe().ok().as_deref().and_then(built_beside).ok_or_else(|| {
            Failure::input(
                "studio: found no page in this program and none beside it, expected one; in a checkout, `cargo xtask studio` \
                 builds it",
            )
        })?;
        Self::read(&folder)
    }

    fn read(folder: &Path) -> Result<Self, Failure> {
        let mut files = BTreeMap::new();
        read(folder, "", &mut files)?;
        if !files.contains_key("index.html") {
            return Err(Failure::in_file(
                folder,
                "found no index.html, expected the page that `cargo xtask studio` built",
            ));
        }
        Ok(Self(files))
    }

    #[cfg(test)]
    pub(super) fn of(files: &[(&str, &[u8])]) -> Self {
        let owned = |(name, bytes): &(&str, &[u8])| ((*name).to_owned(), Cow::Owned(bytes.to_vec()));
        Self(files.iter().map(owned).collect())
    }

    pub(super) fn add(&mut self, name: &str, bytes: Vec<u8>) {
        self.0.insert(name.to_owned(), Cow::Owned(bytes));
    }

    pub(super) fn files(&self) -> impl Iterator<Item = (&str, &[u8])> {
        self.0.iter().map(|(name, bytes)| (name.as_str(), bytes.as_ref()))
    }
}

/// The folder of a page that was built in the same target folder as the program.
fn built_beside(program: &Path) -> Option<PathBuf> {
    let folders = program.ancestors().skip(1).take(4).map(|folder| folder.join("studio"));
    folders
        .into_iter()
        .find(|folder| folder.join("driftworld.wasm.br").is_file())
}

fn read(folder: &Path, above: &str, files: &mut BTreeMap<String, Cow<'static, [u8]>>) -> Result<(), Failure> {
    let unreadable = |error: std::io::Error| Failure::in_file(folder, format!("cannot be read: {error}"));
    for entry in std::fs::read_dir(folder).map_err(unreadable)? {
        let path = entry.map_err(unreadable)?.path();
        let name = path.file_name().unwrap_or_default().to_string_lossy();
        let name = format!("{above}{name}");
        if path.is_dir() {
            read(&path, &format!("{name}/"), files)?;
        } else {
            let bytes = driftworld_files::read(&path, MAX_FILE_BYTES)
                .map_err(|error| Failure::input(format!("{}: {error}", path.shown())))?;
            files.insert(name, Cow::Owned(bytes));
        }
    }
    Ok(())
}
