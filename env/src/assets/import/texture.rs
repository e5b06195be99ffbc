//! Reads PNG textures to look up colours. For other formats, materials keep their plain colour.

use std::collections::BTreeMap;
use std::sync::LazyLock;

use gltf_json::Index;
use gltf_json::texture::{Sampler, WrappingMode};
use gltf_json::validation::Checked;

use super::buffers::Buffers;
use super::color::linear;
use super::limits::MAX_TEXTURE_SIDE;
use super::refusal::{named, refuse};
use super::uri::{self, ReadBeside};
use super::warning::{ImportWarning, Warnings};
use crate::EnvError;

/// Maximum number of pixels in all textures of a model together: two textures of the maximum size.
const MAX_PIXELS: usize = 2 * 4096 * 4096;

/// Maximum number of images that are read.
const MAX_IMAGES: usize = 256;

/// Marks a missing image index.
const NO_SOURCE: usize = u32::MAX as usize;

/// The textures of a file, read on first use.
pub(super) struct Textures<'a, 'b> {
    buffers: &'a Buffers<'a>,
    read: &'a mut ReadBeside<'b>,
    /// By image index; `None` if its format is not supported.
    images: BTreeMap<usize, Option<Pixels>>,
    num_pixels: usize,
}

/// An image with its wrap modes.
#[derive(Clone, Copy)]
pub(super) struct Texture<'a> {
    pixels: &'a Pixels,
    /// Wrap modes across and down.
    wrap: [WrappingMode; 2],
}

/// An image: 8-bit RGBA, row 0 on top.
struct Pixels {
    width: usize,
    height: usize,
    rgba: Vec<[u8; 4]>,
}

impl<'a, 'b> Textures<'a, 'b> {
    pub(super) fn new(buffers: &'a Buffers<'a>, read: &'a mut ReadBeside<'b>) -> Self {
        Self {
            buffers,
            read,
            images: BTreeMap::new(),
            num_pixels: 0,
        }
    }

    /// The texture that `place` refers to; `None` if it has no image, or one in an unsupported format.
    pub(super) fn texture(
        &mut self,
        texture: Index<gltf_json::Texture>,
        place: &str,
        warnings: &mut Warnings,
    ) -> Result<Option<Texture<'_>>, EnvError> {
        let index = texture.value();
        let texture = named(&self.buffers.root.textures, index, "texture", place)?;
        let place = format!("/textures/{index}");
        let wrap = self.wrap(texture.sampler, &format!("{place}/sampler"))?;
        let image = texture.source.value();
        if image == NO_SOURCE {
            warnings.insert(ImportWarning::TextureWithoutImage { texture: index });
            return Ok(None);
        }
        if !self.images.contains_key(&image) {
            let pixels = self.load(image, &format!("{place}/source"), warnings)?;
            self.images.insert(image, pixels);
        }
        let pixels = self.images.get(&image).and_then(Option::as_ref);
        Ok(pixels.map(|pixels| Texture { pixels, wrap }))
    }

    /// A texture's wrap modes across and down; without a sampler it repeats.
    fn wrap(&self, sampler: Option<Index<Sampler>>, place: &str) -> Result<[WrappingMode; 2], EnvError> {
        let Some(index) = sampler.map(|sampler| sampler.value()) else {
            return Ok([WrappingMode::Repeat; 2]);
        };
        let sampler = named(&self.buffers.root.samplers, index, "sampler", place)?;
        let [Checked::Valid(across), Checked::Valid(down)] = [sampler.wrap_s, sampler.wrap_t] else {
            let place = format!("/samplers/{index}");
            return Err(refuse(place, "an unknown wrapS or wrapT", "10497, 33071 or 33648"));
        };
        Ok([across, down])
    }

    fn load(&mut self, index: usize, from: &str, warnings: &mut Warnings) -> Result<Option<Pixels>, EnvError> {
        let image = named(&self.buffers.root.images, index, "image", from)?;
        if self.images.len() >= MAX_IMAGES {
            let found = format!("more than {MAX_IMAGES} images in use");
            return Err(refuse("/images", found, "no more than that"));
        }
        let place = format!("/images/{index}");
        let owned;
        let bytes = match (&image.uri, image.buffer_view) {
            (Some(uri), _) => {
                owned = uri::bytes(uri, &format!("{place}/uri"), self.read)?;
                &owned
            }
            (None, Some(view)) => self.buffers.view(view, &place)?.bytes,
            (None, None) => return Err(refuse(place, "neither a uri nor a bufferView", "one of them")),
        };
        if !bytes.starts_with(b"\x89PNG") {
            let found = match bytes {
                [0xFF, 0xD8, ..] => "JPEG",
                [b'R', b'I', b'F', b'F', ..] => "WebP",
                _ => "a format other than PNG",
            };
            warnings.insert(ImportWarning::TextureFormat {
                image: index,
                found: found.to_owned(),
            });
            return Ok(None);
        }
        let pixels = decoded(bytes, &place)?;
        self.num_pixels += pixels.rgba.len();
        if self.num_pixels > MAX_PIXELS {
            let found = format!("textures of {} pixels together", self.num_pixels);
            return Err(refuse("/images", found, format!("at most {MAX_PIXELS}")));
        }
        Ok(Some(pixels))
    }
}

fn decoded(bytes: &[u8], place: &str) -> Result<Pixels, EnvError> {
    let unreadable =
        |error: png::DecodingError| refuse(place, format!("a PNG that cannot be read: {error}"), "a complete PNG");
    let limits = png::Limits { bytes: 128 << 20 };
    let mut decoder = png::Decoder::new_with_limits(std::io::Cursor::new(bytes), limits);
    decoder.set_transformations(png::Transformations::normalize_to_color8());
    // Checks the size before reading anything else.
    let header = decoder.read_header_info().map_err(unreadable)?;
    let (width, height) = (header.width, header.height);
    if width.max(height) > MAX_TEXTURE_SIDE {
        let found = format!("{width} × {height} pixels");
        return Err(refuse(place, found, format!("at most {MAX_TEXTURE_SIDE} each way")));
    }
    let mut reader = decoder.read_info().map_err(unreadable)?;
    // At most 4096 × 4096 × 4 bytes, by the check above.
    let size = reader.output_buffer_size().unwrap_or(0);
    let mut data = vec![0; size];
    let info = reader.next_frame(&mut data).map_err(unreadable)?;
    let channels = info.color_type.samples();
    let pixel = |bytes: &[u8]| match *bytes {
        [gray] => [gray, gray, gray, 255],
        [gray, alpha] => [gray, gray, gray, alpha],
        [r, g, b] => [r, g, b, 255],
        [r, g, b, alpha, ..] => [r, g, b, alpha],
        [] => [0; 4],
    };
    Ok(Pixels {
        width: width as usize,
        height: height as usize,
        rgba: data.chunks_exact(channels).map(pixel).collect(),
    })
}

/// The linear light value of each sRGB byte.
static LIGHT: LazyLock<[f32; 256]> = LazyLock::new(|| std::array::from_fn(|byte| linear(byte as f32 / 255.0)));

impl Texture<'_> {
    /// Linear colour and opacity at texture coordinates, from the nearest pixel.
    pub(super) fn at(self, [u, v]: [f32; 2]) -> [f32; 4] {
        let Self { pixels, wrap } = self;
        let index = |coordinate: f32, wrap: WrappingMode, size: usize| {
            ((within(coordinate, wrap) * size as f32) as usize).min(size.saturating_sub(1))
        };
        let (column, row) = (index(u, wrap[0], pixels.width), index(v, wrap[1], pixels.height));
        let [r, g, b, alpha] = pixels
            .rgba
            .get(row * pixels.width + column)
            .copied()
            .unwrap_or([255; 4]);
        let light = |byte: u8| LIGHT[usize::from(byte)];
        [light(r), light(g), light(b), f32::from(alpha) / 255.0]
    }
}

/// Wraps a coordinate into the image, 0 to 1.
fn within(coordinate: f32, wrap: WrappingMode) -> f32 {
    match wrap {
        WrappingMode::Repeat => coordinate.rem_euclid(1.0),
        WrappingMode::ClampToEdge => coordinate.clamp(0.0, 1.0),
        WrappingMode::MirroredRepeat => {
            let coordinate = coordinate.rem_euclid(2.0);
            coordinate.min(2.0 - coordinate)
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn coordinates_beyond_the_image_are_wrapped() {
        #[track_caller]
        fn check(coordinate: f32, repeated: f32, clamped: f32, mirrored: f32) {
            let modes = [
                WrappingMode::Repeat,
                WrappingMode::ClampToEdge,
                WrappingMode::MirroredRepeat,
            ];
            assert_eq!(
                modes.map(|wrap| within(coordinate, wrap)),
                [repeated, clamped, mirrored],
                "{coordinate}"
            );
        }
        check(0.25, 0.25, 0.25, 0.25);
        check(1.25, 0.25, 1.0, 0.75);
        check(-0.25, 0.75, 0.0, 0.25);
        check(2.25, 0.25, 1.0, 0.25);
    }
}
