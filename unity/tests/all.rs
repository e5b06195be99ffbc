//! All integration tests of this crate, as one program: it is linked once.

mod conversation;
mod error_messages;
mod executable;
mod hostile;
mod recorded;
mod recordings;
#[path = "../../tests/tier.rs"]
mod tier;
mod wire;
mod worlds;
