//! The places that values fill as a whole: numbers, words, colours, and lists of fixed length.

use serde::Deserialize;
use serde_json::Value as Json;

use super::{Field, FieldPlace, Place};
use crate::color::Color;
use crate::value::{ParameterType, Value};

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
