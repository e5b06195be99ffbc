//! Runs the built executable against simulated clients: how sessions begin and end. `cargo xtask unity` tests real clients.

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
    let arguments_with_port = [&["--mlagents-port", &port], arguments].concat();
    Executable::start(&arguments_with_port, folder)
}

/// Runs a whole session with a client that gives these answers in order; returns the executable's result and the client.
fn session(answers: Vec<Answer>, arguments: &[&str]) -> (Ended, Client) {
    let folder = tempfile::tempdir().expect("a temporary folder can be created");
    let client = Client::new(answers);
    let ended = start(&client, arguments, folder.path()).ended();
    (ended, client)
}
