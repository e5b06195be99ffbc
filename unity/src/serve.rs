//! [`run`]: runs a session over a connection, from the first attempt to connect to its end.

use std::path::{Path, PathBuf};
use std::time::Duration;

use driftworld_env::{Catalogue, Library};
use driftworld_spec::maps::MapLibrary;
use driftworld_spec::{MAX_BYTES, World};
use driftworld_text::{ShownPath, printable};
use prost::Message;
use serde::Deserialize;
use serde::de::IgnoredAny;
use tokio::runtime;
use tokio::time::timeout;

use crate::arguments::Options;
use crate::connection::{Connection, Reply};
use crate::error::UnityError;
use crate::journal::Journal;
use crate::outbox::MAX_OUTGOING_BYTES;
use crate::protocol::{HeaderProto, UnityInputProto, UnityMessageProto, UnityOutputProto};
use crate::recordings::RecordingFile;
use crate::screenshots::Screenshots;
use crate::session::{Session, Setup, Turn};

/// Status codes in message headers.
const OK: i32 = 200;
const END: i32 = 400;
const ERROR: i32 = 500;

/// Maximum size of an asset library, in bytes, as in the `driftworld` command.
const MAX_LIBRARY_BYTES: u64 = 1 << 30;

/// Time that a client has to receive the reason why the session ends.
const FAREWELL: Duration = Duration::from_millis(500);

/// Connects to a client, and follows its commands until it quits or disconnects, neither of which is an error.
///
/// # Errors
/// [`UnityError`] for unusable files, for a missing client, and for a client that violates the protocol; that client is sent the
/// error before the session ends.
pub fn run(options: &Options, journal: &mut Journal) -> Result<(), UnityError> {
    let maps = match &options.maps {
        Some(path) => MapLibrary::from_json(&path.display().to_string(), &read("--maps", path)?)?,
        None => MapLibrary::default(),
    };
    let setup = Setup {
        world: match &options.world {
            Some(path) => world(path, &maps, journal)?,
            None => World::default(),
        },
        maps,
        catalogue: catalogue(&options.assets)?,
        pictures: options.pictures,
    };
    // Always includes milliseconds, which parsers with a fixed format require.
    let clock = || format!("{:.3}", jiff::Timestamp::now());
    let mut session = Session::new(setup, Screenshots::new(&options.screenshots), clock);
    let mut recordings = options.record.as_deref().map(RecordingFile::open).transpose()?;
    if recordings.is_some() {
        session.record();
    }
    for remark in session.take_remarks() {
        journal.note(&remark);
    }
    let runtime = runtime::Builder::new_current_thread()
        .enable_all()
        .build()
        .map_err(UnityError::Network)?;
    let outcome = runtime.block_on(serve(&mut session, options, journal, recordings.as_mut()));
    // The current episode is stored in any case.
    session.end_recording();
    let stored = write(&mut session, recordings.as_mut());
    // Does not wait for network operations with a client that is gone.
    runtime.shutdown_background();
    outcome.and(stored)
}

/// Writes finished episodes.
fn write(session: &mut Session, recordings: Option<&mut RecordingFile>) -> Result<(), UnityError> {
    let Some(recordings) = recordings else { return Ok(()) };
    session
        .take_recordings()
        .into_iter()
        .try_for_each(|recording| recordings.write(recording))
}

/// Reads a world file in our format or the original's. Passes on the warnings of the original format's reader, which only warns
/// about misspelt keys.
fn world(path: &Path, maps: &MapLibrary, journal: &mut Journal) -> Result<World, UnityError> {
    let text = read("--world", path)?;
    let name = path.display().to_string();
    let error = match World::from_json(&name, &text) {
        Ok(world) => return Ok(world),
        Err(error) => error,
    };
    // Only our format has a version. If neither format fits, report the errors of our reader, which is stricter.
    let is_ours = serde_json::from_str::<VersionKey>(&text).is_ok_and(|key| key.version.is_some());
    match World::from_l2explorer_with(&name, &text, maps) {
        Ok((world, warnings)) if !is_ours => {
            journal.note(&format!("{}: read as a reset file of L2Explorer", path.shown()));
            for warning in warnings {
                journal.note(&warning.to_string());
            }
            Ok(world)
        }
        _ => Err(error.into()),
    }
}

/// The key that only our format has. All other keys are ignored, however large their values are.
#[derive(Deserialize)]
struct VersionKey {
    version: Option<IgnoredAny>,
}

/// The built-in models, overridden by those of libraries.
fn catalogue(paths: &[PathBuf]) -> Result<Catalogue, UnityError> {
    let mut catalogue = Catalogue::default();
    for path in paths {
        let bytes = driftworld_files::read(path, MAX_LIBRARY_BYTES);
        let bytes = bytes.map_err(|source| UnityError::Reading {
            option: "--assets",
            source,
        })?;
        let library = Library::from_bytes(&bytes).map_err(|source| UnityError::Library {
            path: path.clone(),
            source,
        })?;
        catalogue = catalogue.with_library(&library);
    }
    Ok(catalogue)
}

fn read(option: &'static str, path: &Path) -> Result<String, UnityError> {
    driftworld_files::text(path, MAX_BYTES as u64).map_err(|source| UnityError::Reading { option, source })
}

async fn serve(
    session: &mut Session,
    options: &Options,
    journal: &mut Journal,
    mut recordings: Option<&mut RecordingFile>,
) -> Result<(), UnityError> {
    let mut connection = Connection::open(&options.host, options.port, options.wait).await?;
    let greeting = message(Session::greeting());
    let first = connection.greet(greeting, options.wait).await?;
    let Some(first_input) = input(first, journal)? else {
        return Ok(());
    };
    let Some(identity) = first_input.rl_initialization_input else {
        return Err(UnityError::Incomplete("an rl_initialization_input"));
    };
    journal.note(&format!(
        "a client at {}: package {:?}, protocol {:?}",
        connection.address(),
        identity.package_version,
        identity.communication_version
    ));
    let mut next = session.begin(&identity).map(|()| UnityOutputProto::default());
    if next.is_err() {
        // Clients ignore the answer to their first message, so an error sent before their first command would be lost.
        let reply = connection.exchange(message(UnityOutputProto::default())).await?;
        if matches!(reply, Reply::Gone(_)) {
            return next.map(drop);
        }
    }
    loop {
        let message = match next.and_then(message_within_limit) {
            Ok(message) => message,
            Err(error) => {
                farewell(&mut connection, &error).await;
                return Err(error);
            }
        };
        let reply = connection.exchange(message).await;
        let turn = match reply.and_then(|reply| input(reply, journal)) {
            Ok(None) => return Ok(()),
            Ok(Some(input)) => match input.rl_input {
                Some(command) => session.answer(&command),
                None => Err(UnityError::Incomplete("an rl_input")),
            },
            Err(error) => Err(error),
        };
        for remark in session.take_remarks() {
            journal.note(&printable(&remark));
        }
        let turn = write(session, recordings.as_deref_mut()).and(turn);
        next = match turn {
            Ok(Turn::Output(output)) => Ok(*output),
            Ok(Turn::Quit) => return Ok(()),
            Err(error) => Err(error),
        };
    }
}

/// The client's input, or `None` if the client has ended the session.
fn input(reply: Reply, journal: &mut Journal) -> Result<Option<UnityInputProto>, UnityError> {
    let message = match reply {
        Reply::Message(message) => message,
        Reply::Gone(reason) => {
            journal.note(&format!("the client is gone ({})", printable(&reason)));
            return Ok(None);
        }
    };
    match message.header {
        Some(HeaderProto { status: OK, .. }) => {
            let missing = UnityError::Incomplete("a unity_input");
            message.unity_input.map(Some).ok_or(missing)
        }
        Some(HeaderProto { status: END, .. }) => Ok(None),
        Some(HeaderProto { status, message }) => Err(UnityError::ClientFailed {
            status,
            text: message.chars().take(200).collect(),
        }),
        None => Err(UnityError::Incomplete("a header")),
    }
}

/// Wraps an output in a message, and checks that clients accept its size.
fn message_within_limit(output: UnityOutputProto) -> Result<UnityMessageProto, UnityError> {
    let message = message(output);
    let found = message.encoded_len();
    if found > MAX_OUTGOING_BYTES {
        return Err(UnityError::TooLarge(found));
    }
    Ok(message)
}

fn message(output: UnityOutputProto) -> UnityMessageProto {
    UnityMessageProto {
        header: Some(HeaderProto {
            status: OK,
            message: String::new(),
        }),
        unity_output: Some(output),
        unity_input: None,
    }
}

/// Sends the client the reason why the session ends; its answer does not matter.
async fn farewell(connection: &mut Connection, error: &UnityError) {
    let last = UnityMessageProto {
        header: Some(HeaderProto {
            status: ERROR,
            message: error.to_string(),
        }),
        ..UnityMessageProto::default()
    };
    let _ = timeout(FAREWELL, connection.exchange(last)).await;
}
