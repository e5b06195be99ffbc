//! The table of fields: [`fields!`], used in `world/` and `layout/`, declares each part of a world once. Each field has its
//! unit, whether the original has it, how it is compared, and whether it can be a parameter. The setters of templates, the keys
//! of the L2Explorer dialect, the comparison of worlds and `docs/reference/` are derived from it. Types, ranges and defaults
//! come from the schema of the same declaration.

mod comparison;
mod place;

use serde::Serialize;
use serde::de::DeserializeOwned;

use crate::value::ParameterType;
pub use comparison::Comparison;
pub(crate) use place::{Place, Setter, word};

/// The properties of a field in the table.
#[derive(Clone, Copy, Debug)]
pub struct Field {
    /// Its key.
    pub key: &'static str,
    /// The unit of its numbers, for display; `None` if they have none.
    pub unit: Option<&'static str>,
    /// Whether L2Explorer's reset files have it.
    pub is_original: bool,
    /// How it is compared between two worlds.
    pub compared: Compared,
    /// Why no parameter can set it; `None` if one can set it or its parts.
    pub fixed: Option<&'static str>,
    /// Why no parameter can set the whole of it, although one can set its parts.
    pub in_parts: Option<&'static str>,
    /// The type of parameter that sets the whole of it, if it differs from the one for its Rust type.
    typed: Option<ParameterType>,
    is_heading: bool,
}

/// How a field is compared between two worlds.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Compared {
    /// Number by number and word by word, in the JSON of all fields of a comparison.
    Leaves(Comparison),
    /// By numbers that `similarity` computes for these comparisons.
    Measured(&'static [Comparison]),
    /// Like its parent field, or through each of its own fields.
    AsPart,
    /// Not compared, for this reason.
    Not(&'static str),
}

impl Compared {
    /// The comparisons that use the field.
    pub fn comparisons(&self) -> &[Comparison] {
        match self {
            Self::Leaves(comparison) => std::slice::from_ref(comparison),
            Self::Measured(comparisons) => comparisons,
            Self::AsPart | Self::Not(_) => &[],
        }
    }
}

impl Field {
    /// A field that only our worlds have.
    pub(crate) const fn ours(compared: Compared) -> Self {
        Self {
            key: "",
            unit: None,
            is_original: false,
            compared,
            fixed: None,
            in_parts: None,
            typed: None,
            is_heading: false,
        }
    }

    /// A field that L2Explorer's reset files have under the same key.
    pub(crate) const fn original(compared: Compared) -> Self {
        Self {
            is_original: true,
            ..Self::ours(compared)
        }
    }

    pub(crate) const fn unit(mut self, unit: &'static str) -> Self {
        self.unit = Some(unit);
        self
    }

    /// Marks its numbers as headings in degrees.
    pub(crate) const fn heading(mut self) -> Self {
        self.is_heading = true;
        self.unit("degrees")
    }

    /// Excludes it from parameters, for this reason.
    pub(crate) const fn fixed(mut self, reason: &'static str) -> Self {
        self.fixed = Some(reason);
        self
    }

    /// Marks the whole of it as a layout.
    pub(crate) const fn layout(mut self) -> Self {
        self.typed = Some(ParameterType::Layout);
        self
    }

    /// Excludes the whole of it from parameters, for this reason; its parts can be parameters.
    pub(crate) const fn in_parts(mut self, reason: &'static str) -> Self {
        self.in_parts = Some(reason);
        self
    }

    pub(crate) const fn named(self, key: &'static str) -> Self {
        Self { key, ..self }
    }

    /// Uses the name of the Rust field as the key, unless a key was given.
    pub(crate) const fn or_named(self, key: &'static str) -> Self {
        if self.key.is_empty() { self.named(key) } else { self }
    }

    /// The type of parameter for the whole of it, given the type for its Rust type.
    fn whole_kind(&self, kind: ParameterType) -> ParameterType {
        self.typed.unwrap_or(self.kind(kind))
    }

    /// The type of parameter for a place in the field, given the type for its Rust type.
    fn kind(&self, kind: ParameterType) -> ParameterType {
        match kind {
            ParameterType::Number if self.is_heading => ParameterType::Heading,
            kind => kind,
        }
    }

    /// Takes unset properties from the parent field.
    fn inherit(&self, whole: &Self) -> Self {
        Self {
            compared: match self.compared {
                Compared::AsPart => whole.compared,
                own => own,
            },
            fixed: self.fixed.or(whole.fixed),
            ..*self
        }
    }
}

/// A row of the table: a field, with its accessors in a `T`.
pub(crate) struct Row<T> {
    pub(crate) field: Field,
    /// Writes its value as JSON.
    pub(crate) write: fn(&T, &mut Vec<u8>),
    /// Sets the value of a place in it.
    pub(crate) set: Setter<T>,
    pub(crate) find: fn(&[&str], &mut Vec<usize>) -> Option<ParameterType>,
    pub(crate) list: fn(String, &Field, bool, &mut Vec<FieldPlace>),
}

/// A part of a world whose fields are in the table.
pub(crate) trait Fields: DeserializeOwned + 'static {
    /// The rows, in the order of the declaration.
    const ROWS: &'static [Row<Self>];
}

pub(crate) fn write(value: &impl Serialize, out: &mut Vec<u8>) {
    serde_json::to_writer(out, value).expect("parts of a world always serialise, and writing to memory does not fail");
}

/// Names used in the rows of the table.
pub(crate) mod rows {
    pub(crate) use super::Compared::*;
    pub(crate) use super::Comparison::*;
    pub(crate) use super::{Field, Place, Row, write};
}

/// Declares a part of a world: a struct with, after each field, its default and its row of the table. The defaults may be
/// omitted; the struct then has no `Default`.
macro_rules! fields {
    (
        $(#[$meta:meta])*
        pub struct $name:ident {
            $($(#[$field_meta:meta])* pub $field:ident: $type:ty = $default:expr => $row:expr,)+
        }
    ) => {
        fields! {
            $(#[$meta])*
            pub struct $name { $($(#[$field_meta])* pub $field: $type => $row,)+ }
        }

        impl Default for $name {
            fn default() -> Self {
                Self { $($field: $default,)+ }
            }
        }
    };
    (
        $(#[$meta:meta])*
        pub struct $name:ident { $($(#[$field_meta:meta])* pub $field:ident: $type:ty => $row:expr,)+ }
    ) => {
        $(#[$meta])*
        pub struct $name { $($(#[$field_meta])* pub $field: $type,)+ }

        impl $crate::world::fields::Fields for $name {
            const ROWS: &'static [$crate::world::fields::Row<Self>] = {
                use $crate::world::fields::rows::*;
                &[$(Row {
                    field: $row.or_named(stringify!($field)),
                    write: |part, out| write(&part.$field, out),
                    set: |part, steps, value| Place::set(&mut part.$field, steps, value),
                    find: <$type as Place>::find,
                    list: <$type as Place>::list,
                }),+]
            };
        }
    };
}
pub(crate) use fields;

/// A named place in a world: a key, or an item of a list.
#[derive(Clone, Debug)]
pub struct FieldPlace {
    /// JSON pointer from the world; `*` stands for the index of an item.
    pub pointer: String,
    /// The type of parameter that sets the whole of it; `None` if none can.
    pub kind: Option<ParameterType>,
    /// Its row of the table, completed from its parents.
    pub field: Field,
    /// Whether it is a key; otherwise it is an item of a list.
    pub is_key: bool,
}

/// All places in a part of a world.
pub(crate) fn places_of<T: Fields>() -> Vec<FieldPlace> {
    let mut found = Vec::new();
    T::list_inside("", &Field::ours(Compared::AsPart), &mut found);
    found
}
