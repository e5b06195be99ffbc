//! [`run`]: a session over a connection, from the first look for a client to its end. What is said is decided in `session/mod.rs`.

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

/// The states of a sender.
const WELL: i32 = 200;
const END: i32 = 400;
const FAILED: i32 = 500;

/// The largest library of assets that is read, in bytes, as for the command.
const MAX_LIBRARY_BYTES: u64 = 1 << 30;

/// How long a client has to hear why we end.
const FAREWELL: Duration = Duration::from_millis(500);

/// Looks for a client, and does what it says until it ends.
///
/// # Errors
/// [`UnityError`] for files that cannot be used, without a client, and for a client that breaks the protocol, which is told so
/// before. A client that ends or goes away is no error.
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
    // Always with three digits of the second: readers of one fixed form do not take fewer.
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
    let ended = runtime.block_on(serve(&mut session, options, journal, recordings.as_mut()));
    // However it ended: the episode under way is kept, too.
    session.end_recording();
    let kept = write(&mut session, recordings.as_mut());
    // What the network still has to do for a client that is gone is not waited for.
    runtime.shutdown_background();
    ended.and(kept)
}

/// Writes down the episodes that are over.
fn write(session: &mut Session, recordings: Option<&mut RecordingFile>) -> Result<(), UnityError> {
    let Some(recordings) = recordings else { return Ok(()) };
    session
        .take_recordings()
        .into_iter()
        .try_for_each(|recording| recordings.write(recording))
}

/// A world file, in our form or in the original's. What the original's reader made sense of is noted: a misspelt key reads as one
/// that means nothing.
fn world(path: &Path, maps: &MapLibrary, journal: &mut Journal) -> Result<World, UnityError> {
    let text = read("--world", path)?;
    let name = path.display().to_string();
    let error = match World::from_json(&name, &text) {
        Ok(world) => return Ok(world),
        Err(error) => error,
    };
    // Only ours has a version; where neither form reads, the complaints of ours are the stricter ones.
    let is_ours = serde_json::from_str::<Ours>(&text).is_ok_and(|ours| ours.version.is_some());
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

/// What only our form has; everything else is passed over, however much it is.
#[derive(Deserialize)]
struct Ours {
    version: Option<IgnoredAny>,
}

/// The built-in models with those of libraries in front.
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
    let Some(who) = input(first, journal)? else {
        return Ok(());
    };
    let Some(said) = who.rl_initialization_input else {
        return Err(UnityError::Incomplete("an rl_initialization_input"));
    };
    journal.note(&format!(
        "a client at {}: package {:?}, protocol {:?}",
        connection.address(),
        said.package_version,
        said.communication_version
    ));
    let mut next = session.begin(&said).map(|()| UnityOutputProto::default());
    if next.is_err() {
        // Clients do not look at the answer to who they are; what comes before their first command is lost on them.
        let reply = connection.exchange(message(UnityOutputProto::default())).await?;
        if matches!(reply, Reply::Gone(_)) {
            return next.map(drop);
        }
    }
    loop {
        let message = match next.and_then(fitting) {
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

/// What the client says, or nothing at its end.
fn input(reply: Reply, journal: &mut Journal) -> Result<Option<UnityInputProto>, UnityError> {
    let message = match reply {
        Reply::Message(message) => message,
        Reply::Gone(reason) => {
            journal.note(&format!("the client is gone ({})", printable(&reason)));
            return Ok(None);
        }
    };
    match message.header {
        Some(HeaderProto { status: WELL, .. }) => {
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

/// An output as a message that clients accept.
fn fitting(output: UnityOutputProto) -> Result<UnityMessageProto, UnityError> {
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
            status: WELL,
            message: String::new(),
        }),
        unity_output: Some(output),
        unity_input: None,
    }
}

/// Tells the client why we end; whether it listens is its own affair.
async fn farewell(connection: &mut Connection, error: &UnityError) {
    let last = UnityMessageProto {
        header: Some(HeaderProto {
            status: FAILED,
            message: error.to_string(),
        }),
        ..UnityMessageProto::default()
    };
    let _ = timeout(FAREWELL, connection.exchange(last)).await;
}
