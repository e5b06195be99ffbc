//! Limits on glTF files and the files that they refer to.

/// Maximum size in bytes of a glTF file, and of each file that it refers to.
pub const MAX_IMPORT_BYTES: usize = 64 << 20;

/// Maximum number of nodes in a glTF file.
pub const MAX_IMPORT_NODES: usize = 10_000;

/// Maximum nesting depth of nodes, and of objects and arrays in JSON.
pub const MAX_IMPORT_DEPTH: usize = 64;

/// Maximum number of pixels along each side of a texture.
pub const MAX_TEXTURE_SIDE: u32 = 4096;
