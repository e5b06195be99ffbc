//! Resolves URIs in a glTF file: embedded data, and files in the same folder.

use base64::Engine;

use super::limits::MAX_IMPORT_BYTES;
use super::refusal::{at_most, quoted, refuse};
use crate::EnvError;

/// Reads a file in the folder of the glTF file, or returns the reason why it cannot. It is called only with relative paths
/// inside that folder, separated by `/`. If it follows links, it must check that they stay inside as well.
pub type ReadBeside<'a> = dyn FnMut(&str) -> Result<Vec<u8>, String> + 'a;

/// The bytes behind a URI.
pub(super) fn bytes(uri: &str, place: &str, read: &mut ReadBeside) -> Result<Vec<u8>, EnvError> {
    let bytes = if uri.get(..5).is_some_and(|start| start.eq_ignore_ascii_case("data:")) {
        embedded(uri, place)?
    } else {
        let path = path_inside(uri, place)?;
        read(&path).map_err(|reason| {
            let found = format!("{}, which cannot be read: {reason}", quoted(&path));
            refuse(place, found, "a readable file next to this one")
        })?
    };
    at_most(MAX_IMPORT_BYTES, bytes.len(), "bytes", place)?;
    Ok(bytes)
}

fn embedded(uri: &str, place: &str) -> Result<Vec<u8>, EnvError> {
    let Some((_, text)) = uri.split_once(";base64,") else {
        return Err(refuse(place, quoted(uri), "data:…;base64,…"));
    };
    let engine = base64::engine::GeneralPurpose::new(
        &base64::alphabet::STANDARD,
        base64::engine::general_purpose::PAD.with_decode_padding_mode(base64::engine::DecodePaddingMode::Indifferent),
    );
    let decoded = engine.decode(text);
    decoded.map_err(|error| refuse(place, format!("data that is not base64: {error}"), "base64"))
}

/// A URI as a relative path that stays inside the folder.
fn path_inside(uri: &str, place: &str) -> Result<String, EnvError> {
    let expected = "the relative path of a file in the same folder";
    let outside = || refuse(place, quoted(uri), expected);
    let path = percent_decoded(uri).ok_or_else(outside)?;
    let leads_out = |part: &str| part == ".." || part.is_empty();
    let has_scheme = path.contains(':');
    let has_bad_char = path.chars().any(|c| c == '\\' || c.is_control());
    if has_scheme || has_bad_char || path.len() > 1000 || path.split('/').any(leads_out) {
        return Err(outside());
    }
    Ok(path)
}

fn percent_decoded(text: &str) -> Option<String> {
    let mut bytes = Vec::with_capacity(text.len());
    let mut rest = text.as_bytes();
    while let Some((&first, tail)) = rest.split_first() {
        if first == b'%' {
            let digits = std::str::from_utf8(tail.get(..2)?).ok()?;
            if !digits.bytes().all(|digit| digit.is_ascii_hexdigit()) {
                return None;
            }
            bytes.push(u8::from_str_radix(digits, 16).ok()?);
            rest = &tail[2..];
        } else {
            bytes.push(first);
            rest = tail;
        }
    }
    String::from_utf8(bytes).ok()
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn only_paths_inside_the_folder_are_accepted() {
        #[track_caller]
        fn check(uri: &str, expected: Option<&str>) {
            assert_eq!(path_inside(uri, "here").ok().as_deref(), expected, "{uri}");
        }
        check("lamp.bin", Some("lamp.bin"));
        check("parts/my%20lamp.bin", Some("parts/my lamp.bin"));
        check("./lamp.bin", Some("./lamp.bin"));
        check("", None);
        for outside in ".. ../lamp.bin parts/../../lamp.bin %2e%2e/lamp.bin ..%2Flamp.bin /etc/passwd \
             %2Fetc/passwd //server/share C:\\lamp.bin C:lamp.bin ..\\lamp.bin http://example.org/lamp.bin \
             file:///etc/passwd lamp%00.bin lamp%zz.bin lamp%+1.bin lamp%2 lamp%ff.bin"
            .split(' ')
        {
            check(outside, None);
        }
    }

    #[test]
    fn data_uris_are_decoded_with_or_without_padding() {
        let read = |uri: &str| bytes(uri, "here", &mut |_| Err("nothing is beside it".into()));
        assert_eq!(read("data:application/octet-stream;base64,AQID"), Ok(vec![1, 2, 3]));
        assert_eq!(read("data:;base64,AQ=="), Ok(vec![1]));
        assert_eq!(read("DATA:;base64,AQ"), Ok(vec![1]));
        assert!(read("data:text/plain,AQID").is_err() && read("data:;base64,A*").is_err());
    }
}
