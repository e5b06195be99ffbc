//! Parses models from untrusted bytes. Never panics, and allocates only what the remaining bytes can fill.

use super::MAX_HULL_POINTS;
use super::model::{Detail, LibraryModel};
use crate::EnvError;
use crate::assets::{ColliderShape, Paint};

/// Maximum number of corners of a model whose triangles are stored as 16-bit indices.
pub(super) const MAX_SMALL_CORNERS: usize = 1 << 16;

/// A position in untrusted bytes.
pub(super) struct Reader<'a> {
    bytes: &'a [u8],
    /// Number of bytes read so far.
    pub(super) at: usize,
}

impl<'a> Reader<'a> {
    pub(super) fn new(bytes: &'a [u8]) -> Self {
        Self { bytes, at: 0 }
    }

    pub(super) fn take(&mut self, count: usize) -> Result<&'a [u8], EnvError> {
        let left = &self.bytes[self.at..];
        let Some(taken) = left.get(..count) else {
            let found = format!("{} bytes before the end", left.len());
            return Err(bad(self.at, &found, &format!("{count}")));
        };
        self.at += count;
        Ok(taken)
    }

    fn array<const N: usize>(&mut self) -> Result<[u8; N], EnvError> {
        let mut array = [0; N];
        array.copy_from_slice(self.take(N)?);
        Ok(array)
    }

    fn u8(&mut self) -> Result<u8, EnvError> {
        self.array::<1>().map(|[byte]| byte)
    }

    fn u16(&mut self) -> Result<u16, EnvError> {
        self.array().map(u16::from_le_bytes)
    }

    pub(super) fn u32(&mut self) -> Result<u32, EnvError> {
        self.array().map(u32::from_le_bytes)
    }

    pub(super) fn u64(&mut self) -> Result<u64, EnvError> {
        self.array().map(u64::from_le_bytes)
    }

    fn numbers<const N: usize>(&mut self) -> Result<[f32; N], EnvError> {
        let mut numbers = [0.0; N];
        for number in &mut numbers {
            *number = f32::from_le_bytes(self.array()?);
        }
        Ok(numbers)
    }

    /// Refuses a count that the remaining bytes cannot hold, before anything is allocated.
    pub(super) fn expect_room(&self, count: usize, each: usize, what: &str) -> Result<(), EnvError> {
        let left = self.bytes.len() - self.at;
        if count.checked_mul(each).is_some_and(|bytes| bytes <= left) {
            return Ok(());
        }
        let found = format!("{count} {what} in {left} bytes");
        Err(bad(self.at, &found, &format!("at most {}", left / each)))
    }

    fn text(&mut self) -> Result<String, EnvError> {
        let (at, length) = (self.at, self.u16()?);
        let bytes = self.take(usize::from(length))?;
        let text = std::str::from_utf8(bytes).map_err(|_| bad(at, "a name that is not UTF-8", "UTF-8"))?;
        Ok(text.to_owned())
    }

    fn points(&mut self, count: usize, what: &str) -> Result<Vec<[f32; 3]>, EnvError> {
        self.expect_room(count, 12, what)?;
        (0..count).map(|_| self.numbers()).collect()
    }

    pub(super) fn model(&mut self) -> Result<LibraryModel, EnvError> {
        let at = self.at;
        let (class, name) = (self.text()?, self.text()?);
        let collider = self.collider()?;
        let count = self.u32()? as usize;
        let corners = self.points(count, "corners")?;
        let count = usize::from(self.u16()?);
        self.expect_room(count, 13, "colours")?;
        let paints: Vec<Paint> = (0..count).map(|_| self.paint()).collect::<Result<_, _>>()?;
        let num_levels = self.u8()?;
        let mut levels = Vec::new();
        for _ in 0..num_levels {
            let [error] = self.numbers()?;
            let lists = paints.iter().map(|_| self.triangles(corners.len()));
            levels.push(Detail {
                error,
                triangles: lists.collect::<Result<_, _>>()?,
            });
        }
        let checked = LibraryModel::checked(class, name, collider, corners, paints, levels);
        checked.map_err(|(found, expected)| bad(at, &format!("a model with {found}"), &expected))
    }

    fn collider(&mut self) -> Result<ColliderShape, EnvError> {
        let (at, tag) = (self.at, self.u8()?);
        Ok(match tag {
            0 => ColliderShape::Box { half: self.numbers()? },
            1 => {
                let [radius] = self.numbers()?;
                ColliderShape::Ball { radius }
            }
            2 | 3 => {
                let [radius, half_height] = self.numbers()?;
                if tag == 2 {
                    ColliderShape::Cylinder { radius, half_height }
                } else {
                    ColliderShape::Capsule { radius, half_height }
                }
            }
            4 => {
                let count = usize::from(self.u8()?).min(MAX_HULL_POINTS + 1);
                let points = self.points(count, "points of a hull")?;
                ColliderShape::Hull { points }
            }
            _ => return Err(bad(at, &format!("collider {tag}"), "0 to 4")),
        })
    }

    fn paint(&mut self) -> Result<Paint, EnvError> {
        let (at, tag) = (self.at, self.u8()?);
        let color = self.numbers()?;
        match tag {
            0 => Ok(Paint::Fixed(color)),
            1 => Ok(Paint::Main(color)),
            _ => Err(bad(at, &format!("colour {tag}"), "0 or 1")),
        }
    }

    fn triangles(&mut self, num_corners: usize) -> Result<Vec<[u32; 3]>, EnvError> {
        let count = self.u32()? as usize;
        let is_small = num_corners <= MAX_SMALL_CORNERS;
        self.expect_room(count, if is_small { 6 } else { 12 }, "triangles")?;
        let mut triangles = Vec::with_capacity(count);
        for _ in 0..count {
            triangles.push(if is_small {
                [self.u16()?, self.u16()?, self.u16()?].map(u32::from)
            } else {
                [self.u32()?, self.u32()?, self.u32()?]
            });
        }
        Ok(triangles)
    }
}

/// An error about the byte at an offset: what was found there, and what was expected.
pub(super) fn bad(byte: usize, found: &str, expected: &str) -> EnvError {
    EnvError::BadLibrary {
        byte,
        found: found.to_owned(),
        expected: expected.to_owned(),
    }
}
