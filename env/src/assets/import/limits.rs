//! How large a glTF file may be, and what it names.

/// The largest glTF file, and the largest of each file that it names, in bytes.
pub const MAX_IMPORT_BYTES: usize = 64 << 20;

/// The most nodes of a glTF file.
pub const MAX_IMPORT_NODES: usize = 10_000;

/// How deep nodes may lie in each other, and objects and lists of JSON.
pub const MAX_IMPORT_DEPTH: usize = 64;

/// The most pixels of a texture along each side.
pub const MAX_TEXTURE_SIDE: u32 = 4096;
