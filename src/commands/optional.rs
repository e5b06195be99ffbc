//! What a build may lack, because few need it and it takes long to build: each is a feature of Cargo. This file says so to a user.

#[cfg(any(test, not(feature = "gltf")))]
use super::Failure;

/// The optional parts: the feature, and whether this build has it.
pub(crate) const FEATURES: [(&str, bool); 3] = [
    ("gltf", cfg!(feature = "gltf")),
    ("gpu", cfg!(feature = "gpu")),
    ("line-editor", cfg!(feature = "line-editor")),
];

/// What is said where a build lacks a feature; `instead` says what can be done without it.
#[cfg(any(test, not(feature = "gltf")))]
pub(crate) fn missing(feature: &str, what: &str, instead: &str) -> Failure {
    Failure::input(format!(
        "{what} is not in this build: it lacks the feature `{feature}`; build with `--features {feature}` (or `full`){instead}"
    ))
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn what_a_build_lacks_is_said_with_the_way_to_have_it() {
        let said = format!("{:?}", missing("no-such", "reading glTF", ", or do without"));
        let expected = "reading glTF is not in this build: it lacks the feature `no-such`; build with `--features no-such` (or \
                        `full`), or do without";
        assert!(said.contains(expected), "{said}");
    }
}
