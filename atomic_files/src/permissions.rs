//! Who may read and write a file that takes another's place: those who could before. A new one follows the umask.

use std::fs::{File, Metadata};

use tempfile::Builder;

/// The mode of a file that is new, before the umask takes from it.
#[cfg(unix)]
const PLAIN: u32 = 0o666;

/// Lets a temporary file begin with no more than it will end with; the umask takes from that.
#[cfg(unix)]
pub(crate) fn begin(builder: &mut Builder<'_, '_>, before: Option<&Metadata>) {
    use std::os::unix::fs::PermissionsExt;
    let mode = before.map_or(PLAIN, |before| before.permissions().mode() & 0o777);
    builder.permissions(std::fs::Permissions::from_mode(mode));
}

#[cfg(not(unix))]
pub(crate) fn begin(_: &mut Builder<'_, '_>, _: Option<&Metadata>) {}

/// Gives a file the owner and the mode of the one whose place it takes.
///
/// Where it cannot have the same group, the group may do what everybody may.
#[cfg(unix)]
pub(crate) fn keep(file: &File, before: &Metadata) {
    use std::os::unix::fs::{MetadataExt, PermissionsExt, fchown};
    let Ok(own) = file.metadata() else { return };
    let (mut kept, wanted) = (before.permissions().mode() & 0o777, (before.uid(), before.gid()));
    if (own.uid(), own.gid()) != wanted {
        let both = fchown(file, Some(wanted.0), Some(wanted.1));
        let group = both.or_else(|_| fchown(file, None, Some(wanted.1)));
        if group.is_err() && own.gid() != wanted.1 {
            kept = (kept & !0o070) | ((kept & 0o007) << 3);
        }
    }
    // Where the system has no modes to give, the file stays as closed as it was begun.
    let _ = file.set_permissions(std::fs::Permissions::from_mode(kept));
}

#[cfg(not(unix))]
pub(crate) fn keep(_: &File, _: &Metadata) {}
