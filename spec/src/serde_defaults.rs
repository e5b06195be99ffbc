//! Default values for serde, and predicates that skip defaults when documents are written.

pub(crate) fn one() -> f64 {
    1.0
}

pub(crate) fn two() -> f64 {
    2.0
}

pub(crate) fn is_two<T: From<u8> + PartialEq>(value: &T) -> bool {
    *value == T::from(2)
}

pub(crate) fn half() -> f64 {
    0.5
}

pub(crate) fn yes() -> bool {
    true
}

/// Whether a value is its type's default.
pub(crate) fn is_default<T: Default + PartialEq>(value: &T) -> bool {
    *value == T::default()
}

pub(crate) fn is_one<T: From<u8> + PartialEq>(value: &T) -> bool {
    *value == T::from(1)
}

#[expect(clippy::trivially_copy_pass_by_ref, reason = "serde passes the field by reference")]
pub(crate) fn is_true(value: &bool) -> bool {
    *value
}
