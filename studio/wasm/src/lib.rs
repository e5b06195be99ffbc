//! Driftworld for a browser: a [`Session`] answers calls in JSON with optional bytes. `abi.rs` has the C functions that
//! WebAssembly exports.

#[cfg(target_family = "wasm")]
mod abi;
mod call;
mod compare;
mod episode;
mod fault;
mod link;
mod log;
mod request;
mod session;
mod tasks;

pub use session::Session;
