//! Reads numbers from buffers: positions, texture coordinates, colours, indices. Every count and range is checked before
//! anything is read or allocated.

use gltf_json::Index;
use gltf_json::accessor::{Accessor, ComponentType, GenericComponentType, Type};
use gltf_json::validation::Checked;

use super::buffers::Buffers;
use super::refusal::{named, one_of, refuse};
use crate::EnvError;
use crate::assets::library::{MAX_MODEL_TRIANGLES, MAX_MODEL_VERTICES};

/// The purpose of an accessor, which decides the types that it may have.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(super) enum Use {
    Positions,
    TextureCoordinates,
    Colors,
    Indices,
}

/// A checked accessor.
struct CheckedAccessor<'a> {
    accessor: &'a Accessor,
    place: String,
    component: ComponentType,
    width: usize,
    count: usize,
}

impl Buffers<'_> {
    /// Number of elements of an accessor; at most a million vertices, or indices for a million triangles.
    pub(super) fn count(&self, index: Index<Accessor>, for_use: Use, place: &str) -> Result<usize, EnvError> {
        self.checked(index, for_use, place).map(|checked| checked.count)
    }

    /// The first three numbers of each element of an accessor; missing ones are 0.
    pub(super) fn vectors(&self, index: Index<Accessor>, for_use: Use, place: &str) -> Result<Vec<[f32; 3]>, EnvError> {
        let checked = self.checked(index, for_use, place)?;
        let (bytes, stride, size) = checked.bytes(self)?;
        let mut vectors = Vec::with_capacity(checked.count);
        for element in 0..checked.count {
            let bytes = &bytes[element * stride..];
            let mut vector = [0.0; 3];
            for (k, number) in vector.iter_mut().enumerate().take(checked.width) {
                *number = match (checked.component, &bytes[k * size..]) {
                    (ComponentType::F32, [a, b, c, d, ..]) => f32::from_le_bytes([*a, *b, *c, *d]),
                    (ComponentType::U16, [a, b, ..]) => f32::from(u16::from_le_bytes([*a, *b])) / 65_535.0,
                    (_, [byte, ..]) => f32::from(*byte) / 255.0,
                    (_, []) => 0.0,
                };
            }
            if !vector.iter().all(|number| number.is_finite()) {
                let place = format!("{}, element {element}", checked.place);
                return Err(refuse(place, format!("{vector:?}"), "finite numbers"));
            }
            vectors.push(vector);
        }
        Ok(vectors)
    }

    /// Indices of corners, all below `num_corners`.
    pub(super) fn indices(
        &self,
        index: Index<Accessor>,
        num_corners: usize,
        place: &str,
    ) -> Result<Vec<u32>, EnvError> {
        let checked = self.checked(index, Use::Indices, place)?;
        let (bytes, stride, _) = checked.bytes(self)?;
        let mut indices = Vec::with_capacity(checked.count);
        for element in 0..checked.count {
            let corner = match (checked.component, &bytes[element * stride..]) {
                (ComponentType::U32, [a, b, c, d, ..]) => u32::from_le_bytes([*a, *b, *c, *d]),
                (ComponentType::U16, [a, b, ..]) => u32::from(u16::from_le_bytes([*a, *b])),
                (_, [byte, ..]) => u32::from(*byte),
                (_, []) => 0,
            };
            if corner as usize >= num_corners {
                let place = format!("{}, element {element}", checked.place);
                return Err(refuse(place, format!("corner {corner}"), one_of(num_corners)));
            }
            indices.push(corner);
        }
        Ok(indices)
    }

    fn checked(&self, index: Index<Accessor>, for_use: Use, from: &str) -> Result<CheckedAccessor<'_>, EnvError> {
        let accessor = named(&self.root.accessors, index.value(), "accessor", from)?;
        let place = format!("/accessors/{}", index.value());
        if accessor.sparse.is_some() {
            let found = "a sparse accessor";
            return Err(refuse(place, found, "plain ones; export without sparse accessors"));
        }
        let (Checked::Valid(GenericComponentType(component)), Checked::Valid(shape)) =
            (accessor.component_type, accessor.type_)
        else {
            return Err(refuse(place, "an unknown type or componentType", for_use.expected()));
        };
        let width = match shape {
            Type::Scalar => 1,
            Type::Vec2 => 2,
            Type::Vec3 => 3,
            _ => 4,
        };
        if !for_use.allows(component, shape, accessor.normalized) {
            let normalized = if accessor.normalized { ", normalized" } else { "" };
            let found = format!("{shape:?} of {component:?}{normalized}");
            return Err(refuse(place, found, for_use.expected()));
        }
        let most = match for_use {
            Use::Indices => 3 * MAX_MODEL_TRIANGLES,
            _ => MAX_MODEL_VERTICES,
        };
        let count = accessor.count.0;
        if count > most as u64 {
            return Err(refuse(
                format!("{place}/count"),
                count.to_string(),
                format!("at most {most}"),
            ));
        }
        Ok(CheckedAccessor {
            accessor,
            place,
            component,
            width,
            count: count as usize,
        })
    }
}

impl CheckedAccessor<'_> {
    /// The bytes starting at the first element, the stride, and the size of a number. Guarantees that all elements are within
    /// bounds.
    fn bytes<'b>(&self, buffers: &'b Buffers) -> Result<(&'b [u8], usize, usize), EnvError> {
        let Some(view) = self.accessor.buffer_view else {
            return Err(refuse(
                self.place.as_str(),
                "no bufferView",
                "one: without it there is nothing to read",
            ));
        };
        let view = buffers.view(view, &self.place)?;
        let size = self.component.size();
        let element = size * self.width;
        let stride = view.stride.unwrap_or(element);
        if stride < element {
            let found = format!("elements of {element} bytes, {stride} apart");
            return Err(refuse(self.place.as_str(), found, "a byteStride of that size or more"));
        }
        let offset = self.accessor.byte_offset.map_or(0, |offset| offset.0);
        // The count and the stride are bounded by now; only the offset may be arbitrary.
        let span = self.count.checked_sub(1).map_or(0, |last| last * stride + element) as u64;
        let fits = offset
            .checked_add(span)
            .is_some_and(|end| end <= view.bytes.len() as u64);
        if !fits {
            let found = format!("{} elements in {span} bytes starting at byte {offset}", self.count);
            let expected = format!("a range in the view's {} bytes", view.bytes.len());
            return Err(refuse(self.place.as_str(), found, expected));
        }
        Ok((&view.bytes[offset as usize..], stride, size))
    }
}

impl Use {
    fn allows(self, component: ComponentType, shape: Type, normalized: bool) -> bool {
        use ComponentType::{F32, U8, U16, U32};
        let is_fraction = component == F32 || (normalized && matches!(component, U8 | U16));
        match self {
            Self::Positions => component == F32 && shape == Type::Vec3,
            Self::TextureCoordinates => is_fraction && shape == Type::Vec2,
            Self::Colors => is_fraction && matches!(shape, Type::Vec3 | Type::Vec4),
            Self::Indices => matches!(component, U8 | U16 | U32) && shape == Type::Scalar,
        }
    }

    fn expected(self) -> &'static str {
        match self {
            Self::Positions => "VEC3 of float for positions; export without quantization",
            Self::TextureCoordinates => {
                "VEC2 of float, or of normalized unsigned bytes or shorts, for texture coordinates"
            }
            Self::Colors => "VEC3 or VEC4 of float, or of normalized unsigned bytes or shorts, for colours",
            Self::Indices => "SCALAR of unsigned bytes, shorts or ints for indices",
        }
    }
}
