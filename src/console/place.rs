//! Confines the console's output files to one folder, whatever file name is given.

use std::path::{Component, Path, PathBuf};

use driftworld_text::ShownPath;

use super::session::failure_text;
use crate::output_file;

/// The folder for files whose names come from commands and messages.
pub(super) struct Folder(PathBuf);

impl Folder {
    pub(super) fn new(path: &Path) -> Self {
        Self(path.to_owned())
    }

    /// Writes a file inside the folder, and returns its path. Adds a missing extension.
    pub(super) fn write(&self, name: &str, ending: &str, bytes: &[u8]) -> Result<PathBuf, String> {
        let path = self.inside(name, ending)?;
        output_file::write(&path, bytes).map_err(failure_text)?;
        Ok(path)
    }

    /// The path of a name inside the folder; refuses links, folders and other extensions.
    fn inside(&self, name: &str, ending: &str) -> Result<PathBuf, String> {
        let refuse = |found: &str| {
            Err(format!(
                "file: found {name:?}, {found}, expected a name inside {} such as picture.{ending}",
                self.0.shown()
            ))
        };
        let mut relative = PathBuf::from(name);
        if relative.extension().is_none() {
            relative.set_extension(ending);
        }
        let is_normal = relative.components().all(|part| matches!(part, Component::Normal(_)));
        if !is_normal || relative.file_name().is_none() || name.contains(['\0', '\\', ':']) || name.len() > 255 {
            return refuse("which leads elsewhere");
        }
        if !relative
            .extension()
            .is_some_and(|found| found.eq_ignore_ascii_case(ending))
        {
            return refuse("which has another extension");
        }
        let mut path = self.0.clone();
        for part in relative.components() {
            path.push(part);
            match path.symlink_metadata() {
                Ok(found) if found.is_symlink() => return refuse("which is a link"),
                Ok(found) if !(found.is_file() || found.is_dir()) => return refuse("which is not a file"),
                _ => {}
            }
        }
        if path.is_dir() {
            return refuse("which is a folder");
        }
        Ok(path)
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn names_outside_the_folder_are_refused() {
        let root = tempfile::tempdir().expect("the machine has a folder for temporary files");
        let folder = Folder::new(&root.path().join("out"));
        for name in [
            "../a.png",
            "/tmp/a.png",
            "b/../../a.png",
            "..",
            "",
            ".",
            "a\\b.png",
            "C:a.png",
            "a.sh",
            "a\0.png",
        ] {
            assert!(folder.write(name, "png", b"x").is_err(), "{name:?}");
        }
        let count = std::fs::read_dir(root.path()).expect("the folder exists").count();
        assert_eq!(count, 0, "the folder was not created either");
        let path = folder.write("deep/a", "png", b"x").expect("the name is inside");
        assert!(path.ends_with("out/deep/a.png") && path.is_file());
        assert!(folder.write("deep.png/../../b.png", "png", b"x").is_err());
    }

    #[cfg(unix)]
    #[test]
    fn links_are_not_followed() {
        let root = tempfile::tempdir().expect("the machine has a folder for temporary files");
        let out = root.path().join("out");
        std::fs::create_dir(&out).expect("the folder can be created");
        let outside = root.path().join("outside.png");
        std::fs::write(&outside, "mine").expect("the folder can be written");
        std::os::unix::fs::symlink(&outside, out.join("a.png")).expect("links can be created");
        std::os::unix::fs::symlink(root.path(), out.join("up")).expect("links can be created");
        let folder = Folder::new(&out);
        assert!(folder.write("a.png", "png", b"x").is_err());
        assert!(folder.write("up/b.png", "png", b"x").is_err());
        assert_eq!(std::fs::read_to_string(&outside).expect("the file exists"), "mine");
    }
}
