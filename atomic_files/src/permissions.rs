//! Permissions of written files: a file that replaces an existing one keeps its permissions; a new file follows the
//! umask.

use std::fs::{File, Metadata};

use tempfile::Builder;

/// Mode of a new file, before the umask is applied.
#[cfg(unix)]
const DEFAULT_MODE: u32 = 0o666;

/// Creates temporary files with at most their final mode; the umask restricts it further.
#[cfg(unix)]
pub(crate) fn begin(builder: &mut Builder<'_, '_>, before: Option<&Metadata>) {
    use std::os::unix::fs::PermissionsExt;
    let mode = before.map_or(DEFAULT_MODE, |before| before.permissions().mode() & 0o777);
    builder.permissions(std::fs::Permissions::from_mode(mode));
}

#[cfg(not(unix))]
pub(crate) fn begin(_: &mut Builder<'_, '_>, _: Option<&Metadata>) {}

/// Gives a file the owner and the mode of the one that it replaces.
///
/// If the group cannot be kept, the new group gets only the permissions that the file grants to others.
#[cfg(unix)]
pub(crate) fn keep(file: &File, before: &Metadata) {
    use std::os::unix::fs::{MetadataExt, PermissionsExt, fchown};
    let Ok(own) = file.metadata() else { return };
    let (mut mode, owner) = (before.permissions().mode() & 0o777, (before.uid(), before.gid()));
    if (own.uid(), own.gid()) != owner {
        let owner_and_group = fchown(file, Some(owner.0), Some(owner.1));
        let group_kept = owner_and_group.or_else(|_| fchown(file, None, Some(owner.1)));
        if group_kept.is_err() && own.gid() != owner.1 {
            mode = (mode & !0o070) | ((mode & 0o007) << 3);
        }
    }
    // If the mode cannot be set, the file keeps the restrictive one that it was created with.
    let _ = file.set_permissions(std::fs::Permissions::from_mode(mode));
}

#[cfg(not(unix))]
pub(crate) fn keep(_: &File, _: &Metadata) {}
