//! [`Screenshots`]: the only folder that messages can write to.

use std::fs;
use std::io::{Read, Write};
use std::path::{Component, Path, PathBuf};

use driftworld_atomic_files::AtomicFile;
use driftworld_text::ShownPath;

/// Maximum length of a file name, in bytes.
const MAX_NAME_BYTES: usize = 200;

/// The first bytes of every PNG file.
const SIGNATURE: [u8; 8] = *b"\x89PNG\r\n\x1a\n";

/// A folder for images whose names come from messages.
#[derive(Clone, Debug)]
pub struct Screenshots {
    folder: PathBuf,
}

impl Screenshots {
    /// Uses this folder, which is created when the first image is written.
    pub fn new(folder: impl Into<PathBuf>) -> Self {
        Self { folder: folder.into() }
    }

    /// Writes a PNG file inside the folder, whatever path the name contains, and returns its path.
    ///
    /// Subfolders in the name are kept if they stay inside the folder; of any other path only the last part is used. An existing
    /// image of that name is replaced. If the name is a link, the link is replaced, not the file that it points to.
    ///
    /// # Errors
    /// The reason why the file could not be written: an invalid name, a folder of that name, or the system's error.
    pub(crate) fn write(&self, name: &str, png: &[u8]) -> Result<PathBuf, String> {
        let relative = inside(name)?;
        let path = self.folder.join(&relative);
        let failed = |error: std::io::Error| format!("{}: {error}", path.shown());
        let refused = |found: &str, expected: &str| {
            Err(format!(
                "payload/filename: found {name:?}, which {found}, expected {expected}"
            ))
        };
        let mut folder = self.folder.clone();
        fs::create_dir_all(&folder).map_err(failed)?;
        for part in relative.parent().into_iter().flat_map(Path::components) {
            folder.push(part);
            if folder.symlink_metadata().is_ok_and(|found| found.is_symlink()) {
                return refused("leads through a link", "a plain folder");
            }
            if !folder.is_dir() {
                fs::create_dir(&folder).map_err(failed)?;
            }
        }
        if path.symlink_metadata().is_ok_and(|found| found.is_dir()) {
            return refused("is a folder", "a name for a file");
        }
        if path.is_file() && !path.is_symlink() && !is_png(&path) {
            return refused("is a file but not a picture", "another name");
        }
        let mut file = AtomicFile::create_in_place_of_links(&path).map_err(failed)?;
        file.write_all(png).map_err(failed)?;
        file.commit().map_err(failed)?;
        Ok(path)
    }
}

/// Whether a file starts like a PNG file; false if it cannot be read.
fn is_png(path: &Path) -> bool {
    let mut start = [0; SIGNATURE.len()];
    let Ok(mut opened) = driftworld_files::open(path, u64::MAX) else {
        return false;
    };
    opened.file.read_exact(&mut start).is_ok() && start == SIGNATURE
}

/// The path inside the folder for a name.
fn inside(name: &str) -> Result<PathBuf, String> {
    let refuse = || {
        Err(format!(
            "payload/filename: found {:?}, expected a name such as picture.png",
            name.chars().take(100).collect::<String>()
        ))
    };
    // Clients on Windows use Windows paths.
    let slashed = name.replace('\\', "/");
    let path = Path::new(&slashed);
    let stays_inside = path.components().all(|part| matches!(part, Component::Normal(_))) && !slashed.contains(':');
    let last = slashed.rsplit(['/', ':']).next().unwrap_or_default();
    let mut path = if stays_inside {
        path.to_owned()
    } else {
        PathBuf::from(last)
    };
    let is_name = |part: Component| match part {
        Component::Normal(part) => {
            let text = part.to_string_lossy();
            part.len() <= MAX_NAME_BYTES && !text.starts_with('.') && !text.contains(char::is_control)
        }
        _ => false,
    };
    if last.is_empty() || name.len() > 4 * MAX_NAME_BYTES || !path.components().all(is_name) {
        return refuse();
    }
    // As in the original, other extensions are kept, although the contents are PNG.
    if path.extension().is_none() {
        path.set_extension("png");
    }
    Ok(path)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn every_name_stays_inside_the_folder() {
        let check = |name: &str, expected: &str| assert_eq!(inside(name), Ok(PathBuf::from(expected)), "{name}");
        check("a.png", "a.png");
        check("a", "a.png");
        check("a.jpg", "a.jpg");
        check("runs/7/a.PNG", "runs/7/a.PNG");
        check("/etc/passwd", "passwd.png");
        check("/etc/rc.local", "rc.local");
        check("../../a.png", "a.png");
        check("runs/../../a.png", "a.png");
        check("C:\\Users\\me\\a.png", "a.png");
        check("C:a.png", "a.png");
        for name in [
            "",
            "/",
            "..",
            ".",
            ".bashrc",
            ".git/a.png",
            "a/.ssh/b",
            "a/",
            "a\0b",
            "a\nb",
            &"x".repeat(300),
        ] {
            assert!(inside(name).is_err(), "{name:?}: {:?}", inside(name));
        }
    }

    #[test]
    fn screenshots_replace_only_images() {
        let root = tempfile::tempdir().expect("a temporary folder can be created");
        let screenshots = Screenshots::new(root.path().join("deep/out"));
        let path = screenshots
            .write("/tmp/a.png", &[&SIGNATURE[..], b"one"].concat())
            .expect("the name is valid");
        assert_eq!(path, root.path().join("deep/out/a.png"));
        screenshots.write("a", b"two").expect("existing images are replaced");
        assert_eq!(fs::read(&path).expect("the file was written"), b"two");
        screenshots.write("b/c.png", b"x").expect("missing folders are created");
        let mine = root.path().join("deep/out/train.py");
        fs::write(&mine, "mine").expect("the folder can be written");
        let error = screenshots
            .write("train.py", b"x")
            .expect_err("a program is not a picture");
        assert!(error.contains("not a picture"), "{error}");
        assert_eq!(fs::read_to_string(&mine).expect("the file still exists"), "mine");
        fs::create_dir(root.path().join("deep/out/d.png")).expect("the folder can be written");
        let error = screenshots.write("d.png", b"x").expect_err("a folder is not a picture");
        assert!(error.contains("which is a folder"), "{error}");
        let left = fs::read_dir(root.path().join("deep/out")).expect("the folder exists");
        assert_eq!(left.count(), 4, "no temporary file is left");
    }

    #[cfg(unix)]
    #[test]
    fn replaced_screenshot_keeps_its_file_mode() {
        use std::os::unix::fs::PermissionsExt;
        let root = tempfile::tempdir().expect("a temporary folder can be created");
        let screenshots = Screenshots::new(root.path());
        let mode = |path: &Path| fs::metadata(path).expect("the file exists").permissions().mode() & 0o777;
        let path = screenshots.write("a", &SIGNATURE).expect("the name is valid");
        fs::write(root.path().join("plain"), "").expect("the folder can be written");
        assert_eq!(
            mode(&path),
            mode(&root.path().join("plain")),
            "a new file follows the umask"
        );
        fs::set_permissions(&path, fs::Permissions::from_mode(0o600)).expect("the file is ours");
        screenshots
            .write("a", &SIGNATURE)
            .expect("existing images are replaced");
        assert_eq!(mode(&path), 0o600);
    }

    #[cfg(unix)]
    #[test]
    fn links_are_not_followed() {
        let root = tempfile::tempdir().expect("a temporary folder can be created");
        let out = root.path().join("out");
        fs::create_dir(&out).expect("the folder can be created");
        let outside = root.path().join("outside.png");
        fs::write(&outside, "mine").expect("the folder can be written");
        std::os::unix::fs::symlink(&outside, out.join("a.png")).expect("links can be created");
        std::os::unix::fs::symlink(root.path(), out.join("up")).expect("links can be created");
        let screenshots = Screenshots::new(&out);
        screenshots.write("a.png", b"x").expect("the link itself is replaced");
        assert!(screenshots.write("up/b.png", b"x").is_err());
        assert_eq!(fs::read_to_string(&outside).expect("the file still exists"), "mine");
        assert!(!root.path().join("b.png").exists());
    }
}
