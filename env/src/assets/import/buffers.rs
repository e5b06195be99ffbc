//! Resolves a glTF file's buffers and views to bytes, checking every range.

use std::borrow::Cow;

use gltf_json::{Index, Root, buffer};

use super::refusal::{at_most, named, refuse};
use super::uri::{self, ReadBeside};
use crate::EnvError;

/// Maximum number of buffers, and of bytes in all buffers together.
const MAX_BUFFERS: usize = 1000;
const MAX_BYTES: usize = 256 << 20;

/// All buffers of a file.
pub(super) struct Buffers<'a> {
    pub(super) root: &'a Root,
    data: Vec<Cow<'a, [u8]>>,
}

/// A view's bytes, and its stride if given.
pub(super) struct View<'a> {
    pub(super) bytes: &'a [u8],
    pub(super) stride: Option<usize>,
}

impl<'a> Buffers<'a> {
    pub(super) fn load(root: &'a Root, binary: Option<&'a [u8]>, read: &mut ReadBeside) -> Result<Self, EnvError> {
        at_most(MAX_BUFFERS, root.buffers.len(), "buffers", "/buffers")?;
        let mut data: Vec<Cow<[u8]>> = Vec::new();
        let mut total = 0;
        for (index, buffer) in root.buffers.iter().enumerate() {
            let place = format!("/buffers/{index}");
            let bytes: Cow<[u8]> = match (&buffer.uri, binary) {
                (Some(uri), _) => Cow::Owned(uri::bytes(uri, &format!("{place}/uri"), read)?),
                (None, Some(binary)) if index == 0 => Cow::Borrowed(binary),
                (None, _) => return Err(refuse(place, "no data", "a uri, or the binary chunk of a GLB file")),
            };
            let length = buffer.byte_length.0;
            if length > bytes.len() as u64 {
                let found = format!("{length} bytes");
                let place = format!("{place}/byteLength");
                return Err(refuse(place, found, format!("at most the {} available", bytes.len())));
            }
            total += bytes.len();
            at_most(MAX_BYTES, total, "bytes", "/buffers")?;
            data.push(bytes);
        }
        Ok(Self { root, data })
    }

    /// The bytes of a view; `place` is the reference to it.
    pub(super) fn view(&self, index: Index<buffer::View>, place: &str) -> Result<View<'_>, EnvError> {
        let place = format!("{place}/bufferView");
        let view = named(&self.root.buffer_views, index.value(), "view", &place)?;
        let place = format!("/bufferViews/{}", index.value());
        let index = view.buffer.value();
        let buffer = named(&self.root.buffers, index, "buffer", &format!("{place}/buffer"))?;
        let (offset, length) = (view.byte_offset.map_or(0, |offset| offset.0), view.byte_length.0);
        let whole = buffer.byte_length.0;
        let end = offset.checked_add(length).filter(|end| *end <= whole);
        let Some(end) = end else {
            let found = format!("{length} bytes starting at byte {offset}");
            return Err(refuse(place, found, format!("a range in the buffer's {whole} bytes")));
        };
        let stride = view.byte_stride.as_ref().map(|stride| stride.0);
        if let Some(stride) = stride.filter(|stride| !(4..=252).contains(stride) || stride % 4 != 0) {
            let place = format!("{place}/byteStride");
            return Err(refuse(place, stride.to_string(), "a multiple of 4 in 4..252"));
        }
        // Checked above: the view ends within its buffer, and the buffer within the data.
        let bytes = self.data[index].get(offset as usize..end as usize).unwrap_or_default();
        Ok(View { bytes, stride })
    }
}
