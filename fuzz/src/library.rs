//! Fuzz target for asset libraries. Input that starts with [`SEALED`] gets a valid header, so that the checksum does not stop
//! the fuzzer.

use driftworld_env::Library;
use sha2::{Digest, Sha256};

use crate::refusal;

/// First byte of an input that gets a valid header.
pub(crate) const SEALED: u8 = b'S';

/// A library that can be read serialises to the same bytes.
pub(crate) fn check(bytes: &[u8]) {
    let sealed;
    let bytes = match bytes.split_first() {
        Some((&SEALED, body)) => {
            sealed = seal(body);
            &sealed
        }
        _ => bytes,
    };
    match Library::from_bytes(bytes) {
        Ok(library) => assert!(library.to_bytes() == bytes, "the library serialises to the same bytes"),
        Err(error) => refusal::message(&error.to_string()),
    }
}

fn seal(body: &[u8]) -> Vec<u8> {
    let mut bytes = b"DRIFTLIB".to_vec();
    bytes.extend(1_u32.to_le_bytes());
    bytes.extend((body.len() as u64).to_le_bytes());
    bytes.extend(Sha256::digest(body));
    bytes.extend(body);
    bytes
}
