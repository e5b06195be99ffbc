//! Optional features of a build: few users need them, and they are slow to compile.

#[cfg(any(test, not(feature = "gltf")))]
use crate::Failure;

/// The features, and whether this build has them.
pub(crate) const FEATURES: [(&str, bool); 3] = [
    ("gltf", cfg!(feature = "gltf")),
    ("gpu", cfg!(feature = "gpu")),
    ("line-editor", cfg!(feature = "line-editor")),
];

/// The error for a feature that this build lacks; `instead` suggests an alternative.
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
    fn missing_feature_names_the_cargo_feature() {
        let error = format!("{:?}", missing("no-such", "reading glTF", ", or do without"));
        let expected = "reading glTF is not in this build: it lacks the feature `no-such`; build with `--features no-such` (or \
                        `full`), or do without";
        assert!(error.contains(expected), "{error}");
    }
}
