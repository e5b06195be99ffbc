//! Contains no code: its `Cargo.toml` enables the same features of shared dependencies, whichever part of Driftworld is built.
