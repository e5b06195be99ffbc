//! Resolves a path to write to: a regular file, which can be replaced atomically, or a device, pipe or open descriptor,
//! which is written directly.

use std::fs::{self, File, OpenOptions};
use std::io;
use std::path::{Path, PathBuf};

/// Maximum number of links followed in a row, as on Linux.
const MAX_LINKS: usize = 40;

/// Where output goes.
#[derive(Debug)]
pub(crate) enum Destination {
    /// The path of a regular file, which need not exist yet. It is never a link.
    File(PathBuf),
    /// A device, a pipe or an open descriptor of a process, opened for writing.
    Straight(File),
}

impl Destination {
    /// Follows links, so that their target is written and the links are kept.
    pub(crate) fn of(path: &Path) -> io::Result<Self> {
        let (path, descriptor) = follow_links(path);
        if let Some(descriptor) = descriptor {
            return descriptor.open().map(Self::Straight);
        }
        match fs::metadata(&path) {
            Ok(found) if found.is_dir() => Err(io::ErrorKind::IsADirectory.into()),
            Ok(found) if !found.is_file() => OpenOptions::new().write(true).open(&path).map(Self::Straight),
            _ => Ok(Self::File(path)),
        }
    }
}

/// Whether a path, such as `/dev/stdout`, refers to this process's own standard output.
pub fn is_own_stdout(path: &Path) -> bool {
    follow_links(path)
        .1
        .is_some_and(|descriptor| descriptor.is_own && descriptor.number == Some(1))
}

/// An open file descriptor of a process, named by a path such as `/dev/fd/3`.
struct Descriptor {
    path: PathBuf,
    is_own: bool,
    number: Option<u32>,
}

impl Descriptor {
    /// The descriptor that a path names, recognised by its folder.
    fn named(path: &Path) -> Option<Self> {
        // The folders of other paths need not be resolved.
        if !path.starts_with("/dev") && !path.starts_with("/proc") {
            return None;
        }
        let folder = path.parent()?.canonicalize().ok()?;
        let own = Path::new("/proc").join(std::process::id().to_string());
        let is_of_a_process = folder.starts_with("/proc") && folder.file_name()? == "fd";
        if !is_of_a_process && folder != Path::new("/dev/fd") {
            return None;
        }
        Some(Self {
            path: path.to_owned(),
            is_own: folder.starts_with(own) || folder == Path::new("/dev/fd"),
            number: path.file_name()?.to_str()?.parse().ok(),
        })
    }

    /// Opens it to continue where its process left off: on the same file description if possible, otherwise by
    /// appending.
    fn open(&self) -> io::Result<File> {
        #[cfg(unix)]
        {
            use std::os::fd::AsFd;
            let same = match self.number {
                Some(1) if self.is_own => Some(io::stdout().as_fd().try_clone_to_owned()),
                Some(2) if self.is_own => Some(io::stderr().as_fd().try_clone_to_owned()),
                _ => None,
            };
            if let Some(same) = same {
                return same.map(File::from);
            }
        }
        OpenOptions::new().append(true).open(&self.path)
    }
}

/// The path after following all links, and the descriptor if they lead to one.
fn follow_links(path: &Path) -> (PathBuf, Option<Descriptor>) {
    let mut path = path.to_owned();
    for _ in 0..MAX_LINKS {
        if let Some(descriptor) = Descriptor::named(&path) {
            return (path, Some(descriptor));
        }
        let Ok(to) = fs::read_link(&path) else { break };
        path = path.parent().unwrap_or(Path::new("")).join(to);
    }
    (path, None)
}
