//! The built executable against simulated clients: how sessions begin and end. `cargo xtask unity` tests real clients.

mod arguments;
mod breaches;
mod endings;
mod played;
mod process;
mod strangers;

use std::path::Path;

use played::{Answer, Client};
use process::{Ended, Executable};

/// Starts the executable for a client.
fn start(client: &Client, arguments: &[&str], folder: &Path) -> Executable {
    let port = client.port.to_string();
    let all = [&["--mlagents-port", &port], arguments].concat();
    Executable::start(&all, folder)
}

/// A whole session with a client that gives these answers in order; returns how it ended, and the client.
fn session(answers: Vec<Answer>, arguments: &[&str]) -> (Ended, Client) {
    let folder = tempfile::tempdir().expect("the machine has a folder for temporary files");
    let client = Client::new(answers);
    let ended = start(&client, arguments, folder.path()).ended();
    (ended, client)
}
