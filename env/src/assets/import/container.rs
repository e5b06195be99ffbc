//! Opens a glTF file: GLB with its chunks, or plain JSON.

use super::refusal::refuse;
use crate::EnvError;

const JSON: u32 = 0x4E4F_534A;
const BIN: u32 = 0x004E_4942;

/// The JSON of a file, and the binary chunk of a GLB file.
pub(super) fn open(bytes: &[u8]) -> Result<(&str, Option<&[u8]>), EnvError> {
    if !bytes.starts_with(b"glTF") {
        return Ok((text(bytes)?, None));
    }
    let (Some(version), Some(length)) = (number(bytes, 4), number(bytes, 8)) else {
        let found = format!("{} bytes", bytes.len());
        return Err(refuse("GLB header", found, "at least 12"));
    };
    if version != 2 {
        let found = format!("version {version}");
        return Err(refuse("GLB header", found, "version 2; export as glTF 2.0"));
    }
    if length as usize != bytes.len() {
        let found = format!("a file of {} bytes", bytes.len());
        return Err(refuse("GLB header", found, format!("{length}, as the header says")));
    }
    let mut remaining = &bytes[12..];
    let mut chunks = Vec::new();
    // glTF defines only the first two chunks; others may follow and are ignored.
    while chunks.len() < 2 && !remaining.is_empty() {
        let (kind, data, rest) = chunk(remaining, chunks.len())?;
        chunks.push((kind, data));
        remaining = rest;
    }
    let Some(&(JSON, json)) = chunks.first() else {
        return Err(refuse("GLB chunk 0", "no JSON", "the JSON chunk first"));
    };
    let binary = chunks.get(1).filter(|(kind, _)| *kind == BIN).map(|(_, data)| *data);
    Ok((text(json)?, binary))
}

/// A chunk's kind and data, and the bytes after it.
fn chunk(bytes: &[u8], index: usize) -> Result<(u32, &[u8], &[u8]), EnvError> {
    let place = || format!("GLB chunk {index}");
    let (Some(length), Some(kind)) = (number(bytes, 0), number(bytes, 4)) else {
        let found = format!("{} bytes", bytes.len());
        return Err(refuse(place(), found, "a header of 8 bytes"));
    };
    let data = &bytes[8..];
    if length as usize > data.len() {
        let found = format!("a length of {length} bytes");
        return Err(refuse(place(), found, format!("at most the {} available", data.len())));
    }
    let (data, rest) = data.split_at(length as usize);
    Ok((kind, data, rest))
}

fn number(bytes: &[u8], at: usize) -> Option<u32> {
    bytes.get(at..)?.first_chunk().map(|four| u32::from_le_bytes(*four))
}

fn text(bytes: &[u8]) -> Result<&str, EnvError> {
    let bytes = bytes.strip_prefix(b"\xEF\xBB\xBF").unwrap_or(bytes);
    std::str::from_utf8(bytes).map_err(|error| {
        let place = format!("byte {}", error.valid_up_to());
        refuse(place, "neither GLB nor UTF-8 text", "a .glb or .gltf file")
    })
}
