//! [`UnityError`]: errors that end a session. Refused messages are answered instead, and do not end it.

use std::path::PathBuf;

use driftworld_env::EnvError;
use driftworld_files::FileError;
use driftworld_spec::SpecError;
use driftworld_text::{ShownPath, one_line};

use crate::behavior::BEHAVIOR;
use crate::outbox::MAX_OUTGOING_BYTES;

/// Errors that end a session.
#[derive(Debug, thiserror::Error, strum::IntoStaticStr, strum::VariantNames)]
#[strum(prefix = "unity/", serialize_all = "kebab-case")]
#[non_exhaustive]
pub enum UnityError {
    /// Invalid arguments: what was found where, and what was expected.
    #[error("{}", one_line(.0))]
    Arguments(String),
    /// A file cannot be read: it is not a regular file, too large, or not text.
    #[strum(serialize = "file")]
    #[error("{option} {source}")]
    Reading {
        /// The option that named it.
        option: &'static str,
        /// The underlying error.
        source: FileError,
    },
    /// A file cannot be written.
    #[strum(serialize = "unwritable")]
    #[error("{option} {}: cannot be written: {source}", path.shown(), source = one_line(source))]
    Writing {
        /// The option that named it.
        option: &'static str,
        /// Its path.
        path: PathBuf,
        /// The system's error.
        source: std::io::Error,
    },
    /// A recordings file has other contents, or is damaged.
    #[error("--record {}: {source}", path.shown())]
    Recording {
        /// Its path.
        path: PathBuf,
        /// The place and the problem.
        source: EnvError,
    },
    /// The system provides no network: its error.
    #[error("network: cannot be used: {}", one_line(.0))]
    Network(#[source] std::io::Error),
    /// A world or maps file has problems.
    #[error(transparent)]
    Document(#[from] SpecError),
    /// Nothing listens at the client's address.
    #[error(
        "{address}: no client within {seconds} s; start it first, or name its port with --mlagents-port (5004 in editor mode, else 5005 + worker id)",
        address = one_line(address)
    )]
    NoClient {
        /// Host and port.
        address: String,
        /// Seconds waited.
        seconds: f64,
    },
    /// Host and port are not a valid address.
    #[error("{}: expected the name or address of a machine, such as 127.0.0.1", one_line(.0))]
    NoAddress(String),
    /// The server does not speak the protocol.
    #[error("{address}: the server there does not answer like an ML-Agents client: {reason}", address = one_line(address), reason = one_line(reason))]
    NotAClient {
        /// Host and port.
        address: String,
        /// What it did.
        reason: String,
    },
    /// The client uses an unsupported version of the protocol.
    #[error("client: found version {0:?} of the protocol, expected 1.x, which mlagents-envs 0.16 to 1.1 speak")]
    ClientVersion(String),
    /// A message is invalid or too long: the reason, with the limit if it is too long.
    #[error("client: a message cannot be read: {}", one_line(.0))]
    Unreadable(String),
    /// A message lacks this required part.
    #[error("client: found a message without {0}")]
    Incomplete(&'static str),
    /// The command's number is unknown.
    #[error("client: found command {0}, expected 0 (step), 1 (reset) or 2 (quit)")]
    UnknownCommand(i32),
    /// The client reports a failure.
    #[error("client: it ended with status {status}: {text:?}")]
    ClientFailed {
        /// Its status.
        status: i32,
        /// Its message.
        text: String,
    },
    /// Actions for an unknown agent, or not exactly one for the only agent.
    #[error("actions: found {found} for behaviour {behavior:?}, expected exactly one, for {BEHAVIOR:?}")]
    WrongAgent {
        /// The behaviour of the actions.
        behavior: String,
        /// Number of actions.
        found: usize,
    },
    /// An action has the wrong length.
    #[error("action: found {found} numbers, expected {expected}")]
    ActionLength {
        /// Length of the action.
        found: usize,
        /// Expected length: 3, or 1 if the world has an action table.
        expected: usize,
    },
    /// A discrete action is not a row of the world's table.
    #[error("action: found {found}, expected the number of a row of the world's action table, 0 to {last}", found = one_line(found))]
    ActionRow {
        /// The number.
        found: String,
        /// The last row.
        last: usize,
    },
    /// A library of models is invalid.
    #[error("--assets {}: {source}", path.shown())]
    Library {
        /// Its path.
        path: PathBuf,
        /// The problem.
        source: EnvError,
    },
    /// An answer is longer than clients accept: its length in bytes.
    #[error(
        "observation: found {0} bytes in a message, expected at most {MAX_OUTGOING_BYTES}, which clients accept; reset to a smaller observation_size, or leave out --raw-observations"
    )]
    TooLarge(usize),
    /// An image cannot be encoded: the reason.
    #[error("picture: {}", one_line(.0))]
    Picture(String),
    /// An error of the environment.
    #[error(transparent)]
    Env(#[from] EnvError),
}

impl UnityError {
    /// The stable name of this kind of error, for programs.
    pub fn code(&self) -> &'static str {
        self.into()
    }

    /// The exit status of the executable.
    pub fn exit_code(&self) -> u8 {
        match self {
            Self::Arguments(_) | Self::NoAddress(_) => 2,
            Self::NoClient { .. } => 3,
            _ => 1,
        }
    }
}
