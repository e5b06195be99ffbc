//! Optional features of a build: few users need them, and they are slow to compile.

/// The features, and whether this build has them.
pub(crate) const FEATURES: [(&str, bool); 3] = [
    ("gltf", cfg!(feature = "gltf")),
    ("gpu", cfg!(feature = "gpu")),
    ("line-editor", cfg!(feature = "line-editor")),
];
