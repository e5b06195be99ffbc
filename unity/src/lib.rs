//! Replaces L2Explorer's Unity executable: runs worlds for clients that speak the ML-Agents protocol.
//!
//! A [`Session`] answers a client's messages, without using the network or the clock; [`run`] connects it over gRPC.
//! `driftworld-env` implements L2Explorer's messages.

mod arguments;
mod behavior;
mod client;
mod connection;
mod error;
mod journal;
mod observation;
mod outbox;
mod parameters;
mod recordings;
mod remarks;
mod screenshots;
mod serve;
mod session;
mod side_channel;

pub mod protocol;

pub use arguments::{HELP, MARK, Options, Request};
pub use behavior::BEHAVIOR;
pub use connection::MAX_INCOMING_BYTES;
pub use error::UnityError;
pub use journal::Journal;
pub use observation::PictureForm;
pub use recordings::RecordingFile;
pub use screenshots::Screenshots;
pub use serve::run;
pub use session::{Session, Setup, Turn};
