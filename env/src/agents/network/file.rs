//! Reads network files in the safetensors format: eight bytes with the length of the JSON header, the header, and the tensors.

use std::collections::BTreeMap;

use driftworld_text::shortened;
use serde::Deserialize;
use serde_json::Value;

use super::Trained;
use super::forward::{Layer, PATCH, PatchNetwork};
use crate::EnvError;

/// Maximum size of the header in bytes.
const MAX_NETWORK_HEADER: u64 = 1 << 20;
/// Maximum side of an image in pixels.
const MAX_NETWORK_SIDE: u32 = 512;
/// Maximum number of multiplications per image.
const MAX_NETWORK_PRODUCTS: u64 = 1_000_000_000;
/// Maximum number of rows of the action table, as in worlds.
const MAX_NETWORK_ACTIONS: usize = 1000;
/// Maximum number of time steps for which an action is held.
const MAX_NETWORK_FRAME_SKIP: u32 = 1000;

/// A tensor's entry in the header.
#[derive(Deserialize)]
struct Tensor {
    dtype: String,
    shape: Vec<u64>,
    data_offsets: [usize; 2],
}

/// A file being read.
struct Safetensors<'a> {
    name: &'a str,
    metadata: BTreeMap<String, String>,
    tensors: BTreeMap<String, Value>,
    data: &'a [u8],
}

pub(super) fn read(name: &str, bytes: &[u8]) -> Result<Trained, EnvError> {
    let file = Safetensors::parse(name, bytes)?;
    file.expect_word("architecture", &["patch"])?;
    let side = file.number("size", MAX_NETWORK_SIDE)? as usize;
    if !side.is_multiple_of(2 * PATCH) {
        return Err(file.bad_metadata("size", "a multiple of 8"));
    }
    let actions = file.actions()?;
    let halves = (side / PATCH / 2) as u64;
    let small = file.layer("trunk.small", (PATCH * PATCH * 3) as u64, None)?;
    let width = small.outputs() as u64;
    let large = file.layer("trunk.large", 4 * width, Some(2 * width))?;
    let image = file.layer("trunk.image", halves * halves * 2 * width, None)?;
    let hidden = image.outputs() as u64;
    let policy = file.layer("policy", hidden, Some(actions.len() as u64))?;
    // Per block of 2 × 2 patches: the patches themselves, the layer that joins them, and their share of the hidden layer.
    let products_per_block = width * ((4 * PATCH * PATCH * 3) as u64 + 8 * width + 2 * hidden);
    let products = halves * halves * products_per_block + hidden * actions.len() as u64;
    if products > MAX_NETWORK_PRODUCTS {
        let found = format!("{products} multiplications for an image");
        return Err(file.bad("size", found, format!("at most {MAX_NETWORK_PRODUCTS}")));
    }
    Ok(Trained {
        network: PatchNetwork {
            side,
            small,
            large,
            image,
            policy,
        },
        actions,
        frame_skip: match file.metadata.get("frame_skip") {
            None => None,
            Some(_) => Some(file.number("frame_skip", MAX_NETWORK_FRAME_SKIP)?),
        },
        is_greedy: file.expect_word("policy", &["sampled", "greedy"])? == "greedy",
    })
}

impl<'a> Safetensors<'a> {
    /// Parses the header.
    fn parse(name: &'a str, bytes: &'a [u8]) -> Result<Self, EnvError> {
        let mut file = Self {
            name,
            metadata: BTreeMap::new(),
            tensors: BTreeMap::new(),
            data: &[],
        };
        let kind = "a network in safetensors format, as written by a learner's `export`";
        let Some((length, rest)) = bytes.split_first_chunk() else {
            return Err(file.bad("length of the header", format!("a file of {} bytes", bytes.len()), kind));
        };
        let length = u64::from_le_bytes(*length);
        let most = MAX_NETWORK_HEADER.min(rest.len() as u64);
        if length > most {
            let expected = format!("at most {most}, in {kind}");
            return Err(file.bad("length of the header", format!("{length} bytes"), expected));
        }
        let (header, data) = rest.split_at(length as usize);
        file.data = data;
        file.tensors = serde_json::from_slice(header).map_err(|error| file.bad("header", error.to_string(), kind))?;
        let metadata = file.tensors.remove("__metadata__").unwrap_or_default();
        file.metadata = Deserialize::deserialize(&metadata)
            .map_err(|_| file.bad("__metadata__", shown(&metadata), format!("strings by name, in {kind}")))?;
        Ok(file)
    }

    fn bad(&self, place: &str, found: impl Into<String>, expected: impl Into<String>) -> EnvError {
        EnvError::BadNetwork {
            file: self.name.to_owned(),
            place: place.to_owned(),
            found: found.into(),
            expected: expected.into(),
        }
    }

    fn bad_metadata(&self, key: &str, expected: impl Into<String>) -> EnvError {
        let found = self.metadata.get(key);
        let found = found.map_or("none".to_owned(), |text| shown(&Value::from(text.as_str())));
        self.bad(&format!("__metadata__, {key}"), found, expected)
    }

    fn expect_word(&self, key: &str, words: &[&'static str]) -> Result<&'static str, EnvError> {
        let found = self.metadata.get(key).map_or("", String::as_str);
        let known = words.iter().find(|word| **word == found);
        known.copied().ok_or_else(|| self.bad_metadata(key, words.join(" or ")))
    }

    fn number(&self, key: &str, most: u32) -> Result<u32, EnvError> {
        let number = self.metadata.get(key).and_then(|text| text.parse().ok());
        let number = number.filter(|number| (1..=most).contains(number));
        number.ok_or_else(|| self.bad_metadata(key, format!("a whole number in 1..{most}")))
    }

    fn actions(&self) -> Result<Vec<[f64; 3]>, EnvError> {
        let text = self.metadata.get("actions").map_or("", String::as_str);
        let actions: Option<Vec<[f64; 3]>> = serde_json::from_str(text).ok();
        let actions = actions.filter(|rows| (1..=MAX_NETWORK_ACTIONS).contains(&rows.len()));
        actions.ok_or_else(|| {
            let expected = format!("1 to {MAX_NETWORK_ACTIONS} rows of three numbers, such as [[10,0,0],[3,90,0]]");
            self.bad_metadata("actions", expected)
        })
    }

    /// A layer with the given number of inputs and, if known, of outputs.
    fn layer(&self, name: &str, inputs: u64, outputs: Option<u64>) -> Result<Layer, EnvError> {
        let biases = self.tensor(&format!("{name}.bias"), [outputs].as_slice())?;
        let weights = self.tensor(&format!("{name}.weight"), &[Some(biases.len() as u64), Some(inputs)])?;
        Ok(Layer::new(&weights, biases))
    }

    /// The numbers of a tensor with this shape; an axis of unknown length must have at least one entry.
    fn tensor(&self, name: &str, shape: &[Option<u64>]) -> Result<Vec<f32>, EnvError> {
        let axes: Vec<String> = shape
            .iter()
            .map(|axis| axis.map_or("n".to_owned(), |n| n.to_string()))
            .collect();
        let expected = format!("F32 or BF16 [{}]", axes.join(","));
        let Some(entry) = self.tensors.get(name) else {
            return Err(self.bad(name, "none", expected));
        };
        let Ok(tensor) = Tensor::deserialize(entry) else {
            return Err(self.bad(name, shown(entry), "dtype, shape and data_offsets"));
        };
        let fits = tensor.shape.len() == shape.len()
            && (tensor.shape.iter().zip(shape)).all(|(found, axis)| axis.map_or(*found > 0, |axis| axis == *found));
        let width = match tensor.dtype.as_str() {
            "F32" if fits => 4_u64,
            "BF16" if fits => 2,
            other => {
                let found = format!("{other} {}", shown(&Value::from(tensor.shape)));
                return Err(self.bad(name, found, expected));
            }
        };
        let mut axes = tensor.shape.iter();
        let bytes = axes.try_fold(width, |bytes, axis| bytes.checked_mul(*axis));
        let [start, end] = tensor.data_offsets;
        let length_matches = bytes == end.checked_sub(start).map(|length| length as u64);
        let data = length_matches.then(|| self.data.get(start..end)).flatten();
        let Some(data) = data else {
            let expected = format!(
                "a range of {} bytes within {} bytes of data",
                bytes.unwrap_or(u64::MAX),
                self.data.len()
            );
            return Err(self.bad(name, format!("data_offsets [{start},{end}]"), expected));
        };
        let numbers: Vec<f32> = if width == 4 {
            let chunks = data.as_chunks().0.iter();
            chunks.map(|bytes| f32::from_le_bytes(*bytes)).collect()
        } else {
            // BF16 is the upper half of F32.
            let chunks = data.as_chunks().0.iter();
            chunks
                .map(|[low, high]| f32::from_le_bytes([0, 0, *low, *high]))
                .collect()
        };
        match numbers.iter().find(|number| !number.is_finite()) {
            Some(number) => Err(self.bad(name, number.to_string(), "finite numbers")),
            None => Ok(numbers),
        }
    }
}

/// Formats a value for a message.
fn shown(value: &Value) -> String {
    shortened(&value.to_string(), 60)
}
