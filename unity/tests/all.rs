//! All integration tests of this crate, in one program, so that it is linked only once.

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
