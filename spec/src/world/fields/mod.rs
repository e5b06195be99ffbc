//! The table of fields: [`fields!`], used in `world/` and `layout/`, declares each part of a world once. Each field has its
//! unit, whether the original has it, how it is compared, and whether it can be a parameter. The setters of templates, the keys
//! of the L2Explorer dialect, the comparison of worlds and `docs/reference/` are derived from it. Types, ranges and defaults
//! come from the schema of the same declaration. A [`Place`] is what values can fill; types that are filled as a whole are in
//! `leaves.rs`.

mod comparison;
mod field;
mod leaves;

use serde::Serialize;
use serde::de::DeserializeOwned;
use serde_json::Value as Json;

use crate::value::{ParameterType, Value};
pub use comparison::Comparison;
pub use field::{Compared, Field};

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

impl Field {
    /// The type of parameter for the whole of it, or for a place in it, given the type for its Rust type.
    fn kind(&self, kind: ParameterType, is_whole: bool) -> ParameterType {
        match kind {
            _ if is_whole && self.is_layout => ParameterType::Layout,
            ParameterType::Number if self.is_heading => ParameterType::Heading,
            kind => kind,
        }
    }
}

/// Sets the value of the place in a `T` that the steps lead to. `None` if the value is not allowed there.
pub(crate) type Setter<T> = fn(&mut T, &[usize], &Value) -> Option<()>;

/// A place in a world that can be set from a parameter's value, as a whole or in parts.
pub(crate) trait Place: DeserializeOwned {
    /// The type of parameter for the whole of it; JSON, which fits everywhere, if there is no more specific type.
    const KIND: ParameterType = ParameterType::Json;

    /// Builds the whole of it from a value of that type. `None` if the value is not allowed here.
    fn from_value(value: &Value) -> Option<Self> {
        match value.cast(ParameterType::Json)? {
            Value::Json(json) => Self::from_json(&json),
            _ => None,
        }
    }

    /// Builds the whole of it from JSON that is valid here.
    fn from_json(json: &Json) -> Option<Self> {
        Self::deserialize(json).ok()
    }

    /// The type of value for a place in it; adds the steps that lead there. `None` if the place cannot vary.
    fn find_inside(_words: &[&str], _steps: &mut Vec<usize>) -> Option<ParameterType> {
        None
    }

    /// Sets the value of a place in it.
    fn set_inside(&mut self, _steps: &[usize], _value: &Value) -> Option<()> {
        None
    }

    /// Adds the places in it; they take unset properties from `field`, their parent.
    fn list_inside(_pointer: &str, _field: &Field, _found: &mut Vec<FieldPlace>) {}

    fn find(words: &[&str], steps: &mut Vec<usize>) -> Option<ParameterType> {
        if words.is_empty() {
            Some(Self::KIND)
        } else {
            Self::find_inside(words, steps)
        }
    }

    #[inline]
    fn set(&mut self, steps: &[usize], value: &Value) -> Option<()> {
        if !steps.is_empty() {
            return self.set_inside(steps, value);
        }
        *self = match value {
            Value::Json(json) => Self::from_json(json)?,
            _ => Self::from_value(value)?,
        };
        Some(())
    }

    /// A setter for the place that the steps lead to, with the steps to pass to it: it may handle the first one itself.
    fn setter(steps: Vec<usize>) -> (Setter<Self>, Vec<usize>) {
        (Self::set, steps)
    }

    fn list(pointer: String, field: &Field, is_key: bool, found: &mut Vec<FieldPlace>) {
        let is_open = field.fixed.is_none() && field.in_parts.is_none();
        found.push(FieldPlace {
            pointer: pointer.clone(),
            kind: is_open.then(|| field.kind(Self::KIND, true)),
            field: *field,
            is_key,
        });
        Self::list_inside(&pointer, field, found);
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

/// Lets a string set a type that documents write as a word.
macro_rules! word {
    ($type:ty) => {
        impl $crate::world::fields::Place for $type {
            const KIND: $crate::value::ParameterType = $crate::value::ParameterType::String;

            fn from_value(value: &$crate::value::Value) -> Option<Self> {
                serde_json::from_value(value.to_json()).ok()
            }
        }
    };
}
pub(crate) use word;

/// A part of a world with fields in the table: as a whole, as JSON, or key by key.
impl<T: Fields> Place for T {
    fn find_inside(words: &[&str], steps: &mut Vec<usize>) -> Option<ParameterType> {
        let (word, rest) = words.split_first()?;
        let number = T::ROWS.iter().position(|row| row.field.key == *word)?;
        let row = &T::ROWS[number];
        steps.push(number);
        let is_whole = rest.is_empty() && row.field.in_parts.is_some();
        let kind = (row.find)(rest, steps).filter(|_| row.field.fixed.is_none() && !is_whole)?;
        Some(row.field.kind(kind, rest.is_empty()))
    }

    #[inline]
    fn set_inside(&mut self, steps: &[usize], value: &Value) -> Option<()> {
        let (number, rest) = steps.split_first()?;
        (T::ROWS.get(*number)?.set)(self, rest, value)
    }

    fn setter(mut steps: Vec<usize>) -> (Setter<Self>, Vec<usize>) {
        // There is always a first step, because no value fills a whole world or object.
        (T::ROWS[steps.remove(0)].set, steps)
    }

    fn list_inside(pointer: &str, whole: &Field, found: &mut Vec<FieldPlace>) {
        for row in T::ROWS {
            let field = row.field.inherit(whole);
            (row.list)(format!("{pointer}/{}", field.key), &field, true, found);
        }
    }
}

/// A list: as a whole, as JSON, or item by item.
impl<T: Place> Place for Vec<T> {
    fn find_inside(words: &[&str], steps: &mut Vec<usize>) -> Option<ParameterType> {
        let (index, rest) = words.split_first()?;
        steps.push(index.parse().ok()?);
        T::find(rest, steps)
    }

    fn set_inside(&mut self, steps: &[usize], value: &Value) -> Option<()> {
        let (index, rest) = steps.split_first()?;
        self.get_mut(*index)?.set(rest, value)
    }

    fn list_inside(pointer: &str, field: &Field, found: &mut Vec<FieldPlace>) {
        T::list(format!("{pointer}/*"), field, false, found);
    }
}

impl<T: Place> Place for Option<T> {
    const KIND: ParameterType = T::KIND;

    fn from_value(value: &Value) -> Option<Self> {
        T::from_value(value).map(Some)
    }

    fn from_json(json: &Json) -> Option<Self> {
        if json.is_null() {
            return Some(None);
        }
        T::from_json(json).map(Some)
    }

    fn find_inside(words: &[&str], steps: &mut Vec<usize>) -> Option<ParameterType> {
        T::find_inside(words, steps)
    }

    fn set_inside(&mut self, steps: &[usize], value: &Value) -> Option<()> {
        self.as_mut()?.set_inside(steps, value)
    }

    fn list_inside(pointer: &str, field: &Field, found: &mut Vec<FieldPlace>) {
        T::list_inside(pointer, field, found);
    }
}
