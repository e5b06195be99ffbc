//! Binary format of libraries: a header with a checksum, then the models. All numbers are little-endian. Header: `DRIFTLIB`,
//! version (u32), number of bytes after the header (u64), their SHA-256. Then the number of models (u32), and for each model:
//! class and name (length u16, UTF-8), collider (a tag and its numbers), corners (count u32, three f32 each), colours (count
//! u16; a tag and three f32 each), levels (count u8; an error as f32, then for each colour a count u32 of triangles and their
//! corner indices: u16 if the model has at most 65,536 corners, else u32).

use sha2::{Digest, Sha256};

use super::model::LibraryModel;
use super::reader::{MAX_SMALL_CORNERS, Reader, bad};
use super::{Library, MAX_LIBRARY_MODELS};
use crate::EnvError;
use crate::assets::{ColliderShape, Paint};

const MAGIC: &[u8; 8] = b"DRIFTLIB";
const VERSION: u32 = 1;
/// Bytes of the header.
const HEADER_BYTES: usize = 8 + 4 + 8 + 32;
/// Minimum size of a model in bytes.
const MIN_MODEL_BYTES: usize = 32;

impl Library {
    /// Serialises the library; the same library gives the same bytes on every machine.
    pub fn to_bytes(&self) -> Vec<u8> {
        let mut body = Vec::new();
        body.extend((self.models.len() as u32).to_le_bytes());
        for model in &self.models {
            write_model(model, &mut body);
        }
        with_header(&body)
    }

    /// Whether these bytes start like a library of any version, complete or not.
    pub fn is_meant(bytes: &[u8]) -> bool {
        bytes.starts_with(MAGIC)
    }

    /// Parses the output of [`Library::to_bytes`]. Accepts untrusted bytes; memory use stays below a fixed multiple of their
    /// number.
    ///
    /// # Errors
    /// [`EnvError::BadLibrary`], with the offset of the first fault, if the bytes are not a valid library.
    pub fn from_bytes(bytes: &[u8]) -> Result<Self, EnvError> {
        let mut reader = Reader::new(bytes);
        if reader.take(8).ok() != Some(MAGIC) {
            return Err(bad(0, "other bytes", "DRIFTLIB, with which a library starts"));
        }
        let version = reader.u32()?;
        if version != VERSION {
            let found = format!("version {version}");
            return Err(bad(8, &found, &format!("version {VERSION}; pack the library again")));
        }
        let length = reader.u64()?;
        let digest = reader.take(32)?;
        let body = &bytes[HEADER_BYTES..];
        if length != body.len() as u64 {
            let found = format!("{} bytes of models", body.len());
            return Err(bad(HEADER_BYTES, &found, &format!("{length}, as the header says")));
        }
        if Sha256::digest(body).as_slice() != digest {
            let found = "a checksum that does not match";
            return Err(bad(20, found, "unchanged models; pack the library again"));
        }
        let at = reader.at;
        let count = reader.u32()? as usize;
        if count > MAX_LIBRARY_MODELS {
            let found = format!("{count} models");
            return Err(bad(at, &found, &format!("at most {MAX_LIBRARY_MODELS}")));
        }
        reader.expect_room(count, MIN_MODEL_BYTES, "models")?;
        let mut library = Self::default();
        for _ in 0..count {
            let at = reader.at;
            let model = reader.model()?;
            let added = library.insert(model);
            added.map_err(|error| bad(at, &error.to_string(), "each model once"))?;
        }
        if reader.at != bytes.len() {
            let found = format!("{} bytes after the last model", bytes.len() - reader.at);
            return Err(bad(reader.at, &found, "the end"));
        }
        Ok(library)
    }
}

/// Prepends the header to the models' bytes.
fn with_header(body: &[u8]) -> Vec<u8> {
    let mut bytes = Vec::with_capacity(HEADER_BYTES + body.len());
    bytes.extend(MAGIC);
    bytes.extend(VERSION.to_le_bytes());
    bytes.extend((body.len() as u64).to_le_bytes());
    bytes.extend(Sha256::digest(body));
    bytes.extend(body);
    bytes
}

fn write_model(model: &LibraryModel, out: &mut Vec<u8>) {
    for text in [&model.class, &model.name] {
        out.extend((text.len() as u16).to_le_bytes());
        out.extend(text.as_bytes());
    }
    write_collider(&model.collider, out);
    out.extend((model.corners.len() as u32).to_le_bytes());
    write_numbers(model.corners.as_flattened(), out);
    out.extend((model.paints.len() as u16).to_le_bytes());
    for paint in &model.paints {
        let (tag, color) = match paint {
            Paint::Fixed(color) => (0, color),
            Paint::Main(color) => (1, color),
        };
        out.push(tag);
        write_numbers(color, out);
    }
    out.push(model.levels.len() as u8);
    for level in &model.levels {
        write_numbers(&[level.error], out);
        for triangles in &level.triangles {
            out.extend((triangles.len() as u32).to_le_bytes());
            for corner in triangles.as_flattened() {
                if model.corners.len() <= MAX_SMALL_CORNERS {
                    out.extend((*corner as u16).to_le_bytes());
                } else {
                    out.extend(corner.to_le_bytes());
                }
            }
        }
    }
}

fn write_collider(collider: &ColliderShape, out: &mut Vec<u8>) {
    let mut write = |start: &[u8], numbers: &[f32]| {
        out.extend(start);
        write_numbers(numbers, out);
    };
    match collider {
        ColliderShape::Box { half } => write(&[0], half),
        ColliderShape::Ball { radius } => write(&[1], &[*radius]),
        ColliderShape::Cylinder { radius, half_height } => write(&[2], &[*radius, *half_height]),
        ColliderShape::Capsule { radius, half_height } => write(&[3], &[*radius, *half_height]),
        ColliderShape::Hull { points } => write(&[4, points.len() as u8], points.as_flattened()),
    }
}

fn write_numbers(numbers: &[f32], out: &mut Vec<u8>) {
    out.extend(numbers.iter().flat_map(|number| number.to_le_bytes()));
}

#[cfg(test)]
mod tests {
    use super::super::model::Detail;
    use super::*;
    use proptest::prelude::*;

    fn model(class: &str, collider: ColliderShape) -> LibraryModel {
        let corners = vec![[0.0, 0.0, 0.0], [1.0, 0.0, 0.0], [0.0, 1.0, 0.0], [0.0, 0.0, 2.0]];
        let level = |error: f32, triangles: &[[u32; 3]]| Detail {
            error,
            triangles: vec![triangles.to_vec(), vec![[1, 2, 3]]],
        };
        LibraryModel::checked(
            class.into(),
            "1".into(),
            collider,
            corners,
            vec![Paint::Main([0.5, 0.25, 1.0]), Paint::Fixed([0.0, 0.1, 0.2])],
            vec![level(0.0, &[[0, 2, 1], [0, 1, 3], [0, 3, 2]]), level(0.25, &[])],
        )
        .expect("a tetrahedron is a valid model")
    }

    fn library() -> Library {
        let mut library = Library::default();
        let (radius, half_height) = (0.5, 1.0);
        let points = vec![[0.0; 3], [1.0, 0.0, 0.0], [0.0, 1.0, 0.0], [0.0, 0.0, 2.0]];
        for (class, collider) in [
            ("box", ColliderShape::Box { half: [0.5, 0.5, 1.0] }),
            ("ball", ColliderShape::Ball { radius }),
            ("post", ColliderShape::Cylinder { radius, half_height }),
            ("pill", ColliderShape::Capsule { radius, half_height }),
            ("stone", ColliderShape::Hull { points }),
        ] {
            library.insert(model(class, collider)).expect("every class is new");
        }
        library
    }

    #[test]
    fn library_round_trips_through_bytes() {
        let library = library();
        let bytes = library.to_bytes();
        assert_eq!(Library::from_bytes(&bytes), Ok(library));
        assert_eq!(&bytes[..12], b"DRIFTLIB\x01\0\0\0", "magic bytes and version 1");
    }

    #[test]
    fn truncated_files_and_flipped_bits_are_refused() {
        let bytes = library().to_bytes();
        for length in 0..bytes.len() {
            let read = Library::from_bytes(&bytes[..length]);
            assert!(read.is_err(), "the first {length} bytes");
        }
        for bit in 0..bytes.len() * 8 {
            let mut flipped = bytes.clone();
            flipped[bit / 8] ^= 1 << (bit % 8);
            assert!(Library::from_bytes(&flipped).is_err(), "bit {bit}");
        }
    }

    #[test]
    fn errors_name_the_offset_and_the_fault() {
        #[track_caller]
        fn check(bytes: &[u8], expected: &str) {
            let error = Library::from_bytes(bytes).expect_err("the bytes are not a library");
            assert_eq!(error.to_string(), expected);
        }
        check(
            b"GIF89a",
            "library, byte 0: found other bytes, expected DRIFTLIB, with which a library starts",
        );
        let many = with_header(&u32::MAX.to_le_bytes());
        check(
            &many,
            "library, byte 52: found 4294967295 models, expected at most 10000",
        );
        let few = with_header(&9_u32.to_le_bytes());
        check(&few, "library, byte 56: found 9 models in 0 bytes, expected at most 0");
        let mut body = library().to_bytes()[HEADER_BYTES..].to_vec();
        body.push(0);
        let long = with_header(&body);
        let end = long.len() - 1;
        check(
            &long,
            &format!("library, byte {end}: found 1 bytes after the last model, expected the end"),
        );
    }

    proptest! {
        #![proptest_config(ProptestConfig::with_cases(crate::tier::quick_or_full(24, 256)))]

        /// Recomputes the checksum, so that the corrupted models themselves are parsed.
        #[test]
        fn changed_models_are_refused_or_valid(
            changes in proptest::collection::vec((0_usize..2000, any::<u8>()), 1..8),
            length in 0_usize..2000,
        ) {
            let mut body = library().to_bytes()[HEADER_BYTES..].to_vec();
            for (at, byte) in changes {
                let at = at % body.len();
                body[at] = byte;
            }
            if length % 3 == 0 {
                body.truncate(length);
            }
            if let Ok(read) = Library::from_bytes(&with_header(&body)) {
                prop_assert_eq!(read.to_bytes(), with_header(&body));
                for model in read.models() {
                    let asset = model.asset();
                    prop_assert!(asset.height.is_finite() && asset.radius.is_finite());
                }
            }
        }

        #[test]
        fn arbitrary_bytes_never_panic(body in proptest::collection::vec(any::<u8>(), 0..400)) {
            prop_assert!(Library::from_bytes(&body).is_err());
            let _ = Library::from_bytes(&with_header(&body));
        }
    }
}
