//! Numbers derived from bytes by a hash: similar inputs give unrelated numbers.

use sha2::{Digest, Sha256};

/// The first 64 bits of the hash of the concatenated parts.
pub(crate) fn number_of<P: AsRef<[u8]>>(parts: impl IntoIterator<Item = P>) -> u64 {
    let mut hash = Sha256::new();
    for part in parts {
        hash.update(part);
    }
    let digest = hash.finalize();
    digest
        .iter()
        .take(8)
        .fold(0, |number, byte| number << 8 | u64::from(*byte))
}
