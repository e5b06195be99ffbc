//! Variant, seed and index to a concrete world.
