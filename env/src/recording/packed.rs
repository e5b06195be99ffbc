//! Encodes actions and worlds as short strings: deflated with zlib, then encoded in base64.

use std::io::{Read, Write};

use base64::Engine;
use base64::engine::general_purpose::STANDARD;
use flate2::Compression;
use flate2::read::ZlibDecoder;
use flate2::write::ZlibEncoder;
use serde::{Deserialize, Serialize};

use crate::sim::Action;

/// Maximum number of steps of an episode that can be read.
pub const MAX_RECORDED_STEPS: u32 = 1 << 24;

/// The actions of an episode in the shortest lossless form; numbers are little-endian.
#[derive(Debug, Serialize, Deserialize)]
#[serde(rename_all = "snake_case", deny_unknown_fields)]
pub(super) enum PackedActions {
    /// Rows of the action table, 16 bits each.
    Rows(String),
    /// Three 32-bit numbers per step, if all numbers fit exactly.
    F32(String),
    /// Three 64-bit numbers per step. A row of the action table is stored as its number and two NaNs, which no action contains.
    F64(String),
}

impl PackedActions {
    pub(super) fn new(actions: &[Action]) -> Self {
        let rows: Option<Vec<u16>> = actions.iter().map(|action| u16::try_from(action.row()?).ok()).collect();
        if let Some(rows) = rows {
            return Self::Rows(deflated(rows.iter().flat_map(|row| row.to_le_bytes())));
        }
        let numbers = || actions.iter().flat_map(|action| action.raw_numbers());
        if numbers().all(|number| !number.is_nan() && f64::from(number as f32).to_bits() == number.to_bits()) {
            return Self::F32(deflated(numbers().flat_map(|number| (number as f32).to_le_bytes())));
        }
        Self::F64(deflated(numbers().flat_map(f64::to_le_bytes)))
    }

    /// Decodes the actions of `steps` steps. The error is what was found, and what was expected.
    pub(super) fn unpack(&self, steps: u32) -> Result<Vec<Action>, (String, String)> {
        let (text, width) = match self {
            Self::Rows(text) => (text, 2),
            Self::F32(text) => (text, 12),
            Self::F64(text) => (text, 24),
        };
        if steps > MAX_RECORDED_STEPS {
            return Err((format!("{steps} steps"), format!("at most {MAX_RECORDED_STEPS}")));
        }
        let expected = steps as usize * width;
        let bytes = inflated(text, expected as u64)?;
        if bytes.len() != expected {
            return Err((
                format!("actions of {} bytes", bytes.len()),
                format!("{expected} bytes, {width} for each of {steps} steps"),
            ));
        }
        let action = |bytes: &[u8]| match self {
            // Chunks have `width` bytes.
            Self::Rows(_) => Action::Discrete(usize::from(u16::from_le_bytes([bytes[0], bytes[1]]))),
            Self::F32(_) => Action::Continuous(std::array::from_fn(|k| {
                f64::from(f32::from_le_bytes(std::array::from_fn(|byte| bytes[4 * k + byte])))
            })),
            Self::F64(_) => {
                let numbers: [f64; 3] =
                    std::array::from_fn(|k| f64::from_le_bytes(std::array::from_fn(|byte| bytes[8 * k + byte])));
                if numbers[1].is_nan() {
                    Action::Discrete(numbers[0] as usize)
                } else {
                    Action::Continuous(numbers)
                }
            }
        };
        Ok(bytes.chunks_exact(width).map(action).collect())
    }
}

/// Deflates bytes and encodes them in base64.
pub(super) fn deflated(bytes: impl IntoIterator<Item = u8>) -> String {
    let bytes: Vec<u8> = bytes.into_iter().collect();
    let mut deflater = ZlibEncoder::new(Vec::new(), Compression::default());
    let written = deflater.write_all(&bytes).and_then(|()| deflater.finish());
    STANDARD.encode(written.expect("writing into memory cannot fail"))
}

/// Decodes and inflates such a string to at most `most` + 1 bytes, so that callers can detect larger contents.
pub(super) fn inflated(text: &str, most: u64) -> Result<Vec<u8>, (String, String)> {
    let wrong = |reason: String| (reason, "zlib in base64".to_owned());
    let bytes = STANDARD.decode(text).map_err(|error| wrong(error.to_string()))?;
    let mut inflated = Vec::new();
    let read = ZlibDecoder::new(&bytes[..]).take(most + 1).read_to_end(&mut inflated);
    read.map_err(|error| wrong(error.to_string()))?;
    Ok(inflated)
}

#[cfg(test)]
mod tests {
    use super::*;
    use proptest::prelude::*;

    fn action() -> impl Strategy<Value = Action> {
        prop_oneof![
            (0usize..2000).prop_map(Action::Discrete),
            prop::array::uniform3(-720.0..720.0f64).prop_map(Action::Continuous),
            prop::array::uniform3(-1.0..1.0f32).prop_map(|numbers| Action::Continuous(numbers.map(f64::from))),
            Just(Action::Continuous([-0.0, 0.0, 1e300])),
        ]
    }

    fn bits(actions: &[Action]) -> Vec<String> {
        let bits = |action: &Action| match action {
            Action::Discrete(row) => format!("row {row}"),
            Action::Continuous(numbers) => format!("{:?}", numbers.map(f64::to_bits)),
        };
        actions.iter().map(bits).collect()
    }

    proptest! {
        #![proptest_config(ProptestConfig::with_cases(crate::tier::quick_or_full(24, 256)))]

        #[test]
        fn actions_round_trip_bit_for_bit(
            kind in 0usize..4,
            actions in prop::collection::vec(action(), 0..60),
        ) {
            // All of one kind, or mixed.
            let of_kind = |action: &Action| match kind {
                0 => matches!(action, Action::Discrete(_)),
                1 => matches!(action, Action::Continuous(_)),
                _ => true,
            };
            let actions: Vec<Action> = actions.into_iter().filter(of_kind).collect();
            let packed = PackedActions::new(&actions);
            let back = packed.unpack(actions.len() as u32).unwrap();
            prop_assert_eq!(bits(&back), bits(&actions));
            // A wrong number of steps is refused.
            prop_assert!(packed.unpack(actions.len() as u32 + 1).is_err());
            prop_assert!(actions.is_empty() || packed.unpack(actions.len() as u32 - 1).is_err());
        }
    }

    #[test]
    fn held_actions_compress_well() {
        let held = vec![Action::Continuous([10.0, 30.0, 0.0]); 1000];
        let PackedActions::F32(text) = PackedActions::new(&held) else {
            panic!("the actions fit in 32-bit numbers")
        };
        assert!(text.len() < 120, "{} bytes for 1,000 steps", text.len());
    }
}
