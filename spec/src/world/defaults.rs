//! Defaults of fields that serde asks for by name, and what is not written because it is one.

use super::StateFeature;

pub(super) fn one() -> f64 {
    1.0
}

pub(super) fn two() -> f64 {
    2.0
}

pub(super) fn is_two<T: From<u8> + PartialEq>(value: &T) -> bool {
    *value == T::from(2)
}

pub(super) fn half() -> f64 {
    0.5
}

pub(super) fn yes() -> bool {
    true
}

/// Whether a value is 0, false, or whatever else its type begins with.
pub(super) fn is_default<T: Default + PartialEq>(value: &T) -> bool {
    *value == T::default()
}

pub(super) fn is_one<T: From<u8> + PartialEq>(value: &T) -> bool {
    *value == T::from(1)
}

#[expect(clippy::trivially_copy_pass_by_ref, reason = "serde hands the field by reference")]
pub(super) fn is_true(value: &bool) -> bool {
    *value
}

pub(super) fn is_classic(features: &[StateFeature]) -> bool {
    features == StateFeature::CLASSIC
}
