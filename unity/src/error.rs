//! What can go wrong with a client or before one came. What a single message is refused for is answered, and is no error here.

use std::path::PathBuf;

use driftworld_env::EnvError;
use driftworld_files::FileError;
use driftworld_spec::SpecError;
use driftworld_text::{ShownPath, one_line};

use crate::behavior::BEHAVIOR;
use crate::outbox::MAX_OUTGOING_BYTES;

/// Everything that ends a session before its client does.
#[derive(Debug, thiserror::Error, strum::IntoStaticStr, strum::VariantNames)]
#[strum(prefix = "unity/", serialize_all = "kebab-case")]
#[non_exhaustive]
pub enum UnityError {
    /// Arguments that cannot be: what was found where, and what was expected.
    #[error("{}", one_line(.0))]
    Arguments(String),
    /// A file that cannot be read, is no regular file, is too large or is no text.
    #[strum(serialize = "file")]
    #[error("{option} {source}")]
    Reading {
        /// The option that named it.
        option: &'static str,
        /// Why not.
        source: FileError,
    },
    /// A file that cannot be written.
    #[strum(serialize = "unwritable")]
    #[error("{option} {}: cannot be written: {source}", path.shown(), source = one_line(source))]
    Writing {
        /// The option that named it.
        option: &'static str,
        /// Its path.
        path: PathBuf,
        /// What the system says.
        source: std::io::Error,
    },
    /// A file of recordings that holds something else, or is damaged.
    #[error("--record {}: {source}", path.shown())]
    Recording {
        /// Its path.
        path: PathBuf,
        /// Where, and what was found.
        source: EnvError,
    },
    /// The system gives us no network: what it says.
    #[error("network: cannot be used: {}", one_line(.0))]
    Network(#[source] std::io::Error),
    /// A world or a maps file with problems.
    #[error(transparent)]
    Document(#[from] SpecError),
    /// Nobody listens where the client should be.
    #[error(
        "{address}: no client within {seconds} s; start it first, or name its port by --mlagents-port (5004 in editor mode, else 5005 + worker id)",
        address = one_line(address)
    )]
    NoClient {
        /// Machine and port.
        address: String,
        /// How long was waited.
        seconds: f64,
    },
    /// Machine and port that make no address.
    #[error("{}: expected the name or address of a machine, such as 127.0.0.1", one_line(.0))]
    NoAddress(String),
    /// Something listens that does not speak the protocol.
    #[error("{address}: what listens there does not answer as an ML-Agents client does: {reason}", address = one_line(address), reason = one_line(reason))]
    NotAClient {
        /// Machine and port.
        address: String,
        /// What it did.
        reason: String,
    },
    /// A client of another major version of the protocol, which it says.
    #[error("client: found version {0:?} of the protocol, expected 1.x, which mlagents-envs 0.16 to 1.1 speak")]
    ClientVersion(String),
    /// A message that is no message of the protocol, or too long: why; of one that is too long, this says the limit.
    #[error("client: a message cannot be read: {}", one_line(.0))]
    Unreadable(String),
    /// A message without this, which it has to say.
    #[error("client: found a message without {0}")]
    Incomplete(&'static str),
    /// The number of a command that there is not.
    #[error("client: found command {0}, expected 0 (step), 1 (reset) or 2 (quit)")]
    UnknownCommand(i32),
    /// The client says that it has failed.
    #[error("client: it ended with status {status}: {text:?}")]
    ClientFailed {
        /// Its status.
        status: i32,
        /// Its words.
        text: String,
    },
    /// Actions for other agents than the one there is.
    #[error("actions: found {found} for behaviour {behavior:?}, expected exactly one, for {BEHAVIOR:?}")]
    WrongAgent {
        /// The behaviour that they are for.
        behavior: String,
        /// How many there are.
        found: usize,
    },
    /// An action of another length.
    #[error("action: found {found} numbers, expected {expected}")]
    ActionLength {
        /// How many numbers it has.
        found: usize,
        /// How many it should have: 3, or 1 where the world has a table of actions.
        expected: usize,
    },
    /// A discrete action that the world's table does not have.
    #[error("action: found {found}, expected the number of a row of the world's table of actions, 0 to {last}", found = one_line(found))]
    ActionRow {
        /// The number.
        found: String,
        /// The last row.
        last: usize,
    },
    /// A library of models that is none.
    #[error("--assets {}: {source}", path.shown())]
    Library {
        /// Its path.
        path: PathBuf,
        /// What is wrong with it.
        source: EnvError,
    },
    /// An answer that is longer, by its bytes, than clients accept.
    #[error(
        "observation: {0} bytes in a message, of which clients accept {MAX_OUTGOING_BYTES}; reset to a smaller observation_size, or leave out --raw-observations"
    )]
    TooLarge(usize),
    /// A picture that cannot be made into a file: why.
    #[error("picture: {}", one_line(.0))]
    Picture(String),
    /// What the world says.
    #[error(transparent)]
    Env(#[from] EnvError),
}

impl UnityError {
    /// A name for programs, which stays as it is.
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
