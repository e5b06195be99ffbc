//! [`Place`]: the places in a world that values can fill, derived from the types of its fields.

use serde::Deserialize;
use serde::de::DeserializeOwned;
use serde_json::Value as Json;

use super::{Field, FieldPlace, Fields};
use crate::color::Color;
use crate::value::{ParameterType, Value};

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
            kind: is_open.then(|| field.whole_kind(Self::KIND)),
            field: *field,
            is_key,
        });
        Self::list_inside(&pointer, field, found);
    }
}

/// A part of a world with fields in the table: as a whole, as JSON, or key by key.
impl<T: Fields> Place for T {
    fn find_inside(words: &[&str], steps: &mut Vec<usize>) -> Option<ParameterType> {
        let (word, rest) = words.split_first()?;
        let number = T::ROWS.iter().position(|row| row.field.key == *word)?;
        let row = &T::ROWS[number];
        steps.push(number);
        let is_whole = rest.is_empty() && row.field.in_parts.is_some();
        let kind = (row.find)(rest, steps).filter(|_| row.field.fixed.is_none() && !is_whole)?;
        Some(if rest.is_empty() {
            row.field.whole_kind(kind)
        } else {
            row.field.kind(kind)
        })
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

/// The places in a list of fixed length: its numbers.
macro_rules! number_by_number {
    ($number:ty) => {
        fn find_inside(words: &[&str], steps: &mut Vec<usize>) -> Option<ParameterType> {
            let [index] = words else { return None };
            steps.push(index.parse().ok()?);
            Some(<$number as Place>::KIND)
        }

        fn set_inside(&mut self, steps: &[usize], value: &Value) -> Option<()> {
            let (index, rest) = steps.split_first()?;
            self.get_mut(*index)?.set(rest, value)
        }

        fn list_inside(pointer: &str, field: &Field, found: &mut Vec<FieldPlace>) {
            <$number as Place>::list(format!("{pointer}/*"), field, false, found);
        }
    };
}

/// Points and directions: as a whole, or number by number.
macro_rules! numbers {
    ($length:literal, $kind:ident, $is_sound:expr) => {
        impl Place for [f64; $length] {
            const KIND: ParameterType = ParameterType::$kind;

            fn from_value(value: &Value) -> Option<Self> {
                value.as_vector()?.try_into().ok().filter($is_sound)
            }

            fn from_json(json: &Json) -> Option<Self> {
                Self::deserialize(json).ok().filter($is_sound)
            }

            number_by_number!(f64);
        }
    };
}

numbers!(2, Point, |_| true);
// A direction must not have length 0.
numbers!(3, Vector, |direction| *direction != [0.0; 3]);

/// Counts along x and y: as a whole, rounded, or number by number.
impl Place for [u32; 2] {
    const KIND: ParameterType = ParameterType::Vector;

    fn from_value(value: &Value) -> Option<Self> {
        let [x, y] = *value.as_vector()? else { return None };
        let is_count = |number: f64| (0.0..=f64::from(u32::MAX)).contains(&number.round());
        (is_count(x) && is_count(y)).then(|| [x.round() as u32, y.round() as u32])
    }

    number_by_number!(u32);
}

/// Implements `Place` for a type that is set as a whole, given a function that reads it.
macro_rules! leaf {
    ($type:ty, $kind:ident, $read:expr) => {
        impl Place for $type {
            const KIND: ParameterType = ParameterType::$kind;

            #[inline]
            fn from_value(value: &Value) -> Option<Self> {
                $read(value)
            }
        }
    };
}

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

leaf!(f64, Number, Value::as_number);
leaf!(u8, Integer, whole);
leaf!(u32, Integer, whole);
leaf!(u64, Integer, whole);
leaf!(bool, Boolean, truth);
leaf!(Color, Color, Value::as_color);
leaf!(String, String, text);

fn whole<T: TryFrom<i64>>(value: &Value) -> Option<T> {
    value.as_integer().and_then(|whole| T::try_from(whole).ok())
}

fn truth(value: &Value) -> Option<bool> {
    match value {
        Value::Boolean(truth) => Some(*truth),
        _ => None,
    }
}

fn text(value: &Value) -> Option<String> {
    let text = value.as_text().filter(|text| (1..=100).contains(&text.chars().count()));
    text.map(str::to_owned)
}
