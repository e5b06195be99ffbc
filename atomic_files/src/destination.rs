//! What a path stands for: a file that can appear whole, or something that takes what it is given, such as a device, a
//! pipe or what this process has open.

use std::fs::{self, File, OpenOptions};
use std::io;
use std::path::{Path, PathBuf};

/// Most links that are followed one after the other, as Linux does.
const MOST_LINKS: usize = 40;

/// Where what is written goes.
#[derive(Debug)]
pub(crate) enum Destination {
    /// A file, or where there is none yet; no link.
    File(PathBuf),
    /// A device, a pipe, or what a process has open: opened for writing.
    Straight(File),
}

impl Destination {
    /// Follows links: they stay, and what they lead to is written.
    pub(crate) fn of(path: &Path) -> io::Result<Self> {
        let (path, descriptor) = followed(path);
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

/// Whether a path, such as `/dev/stdout`, stands for this process's own standard output.
pub fn is_own_stdout(path: &Path) -> bool {
    followed(path)
        .1
        .is_some_and(|descriptor| descriptor.is_own && descriptor.number == Some(1))
}

/// What a process has open, under a path such as `/dev/fd/3`.
struct Descriptor {
    path: PathBuf,
    is_own: bool,
    number: Option<u32>,
}

impl Descriptor {
    /// The descriptor that a path names; its folder is what tells.
    fn named(path: &Path) -> Option<Self> {
        // Links elsewhere need no look at their folders.
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

    /// Goes on where the process is that opened it: in the same description where it can be had, else at the end.
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

/// Where the links end that a path leads through, and the descriptor if they end in one.
fn followed(path: &Path) -> (PathBuf, Option<Descriptor>) {
    let mut path = path.to_owned();
    for _ in 0..MOST_LINKS {
        if let Some(descriptor) = Descriptor::named(&path) {
            return (path, Some(descriptor));
        }
        let Ok(to) = fs::read_link(&path) else { break };
        path = path.parent().unwrap_or(Path::new("")).join(to);
    }
    (path, None)
}
