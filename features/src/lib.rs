//! Holds no code: its `Cargo.toml` asks the same features of shared dependencies, whatever part of Driftworld is built.
