//! Limits on glTF files and the files that they refer to.

/// Largest size in bytes of a glTF file, and of each file that it refers to.
pub const MAX_IMPORT_BYTES: usize = 64 << 20;

/// Most nodes of a glTF file.
pub const MAX_IMPORT_NODES: usize = 10_000;

/// Deepest nesting of nodes, and of objects and lists in JSON.
pub const MAX_IMPORT_DEPTH: usize = 64;

/// Most pixels along each side of a texture.
pub const MAX_TEXTURE_SIDE: u32 = 4096;
