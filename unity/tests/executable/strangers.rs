//! Servers at the client's address that are not clients, and addresses without a server.

use std::io::{Read, Write};
use std::net::TcpListener;

use driftworld_unity::protocol::CommandProto;

use super::played::{Client, command, free_port, who};
use super::process::{Ended, Executable};
use super::{session, start};

fn run(listener: &TcpListener, arguments: &[&str]) -> Executable {
    let port = listener.local_addr().expect("the listener is bound").port().to_string();
    let folder = std::env::temp_dir();
    Executable::start(&[&["--mlagents-port", &port], arguments].concat(), &folder)
}

fn assert_no_client(ended: &Ended, reason: &str) {
    assert_eq!(ended.code, Some(1), "{ended:?}");
    let expected = "the server there does not answer like an ML-Agents client: ";
    let (_, found) = ended.stderr.split_once(expected).unwrap_or_else(|| panic!("{ended:?}"));
    assert!(found.contains(reason), "{ended:?}");
}

#[test]
fn waiting_without_a_server_times_out() {
    let listener = free_port();
    let port = listener.local_addr().expect("the listener is bound").port().to_string();
    drop(listener);
    let ended = Executable::start(&["--wait", "0.2", "--mlagents-port", &port], &std::env::temp_dir()).ended();
    assert_eq!(ended.code, Some(3), "{ended:?}");
    assert_eq!(
        ended.stderr,
        format!(
            "driftworld-unity: 127.0.0.1:{port}: no client within 0.2 s; start it first, or name its port with --mlagents-port (5004 in editor mode, else 5005 + worker id)\n"
        )
    );
}

#[test]
fn client_that_starts_later_is_found() {
    let listener = free_port();
    let port = listener.local_addr().expect("the listener is bound").port();
    drop(listener);
    let executable = Executable::start(&["--mlagents-port", &port.to_string()], &std::env::temp_dir());
    let listener = TcpListener::bind(("127.0.0.1", port)).expect("the port is still free");
    let client = Client::listening(listener, [who("1.0.0"), command(CommandProto::Quit)]);
    let ended = executable.ended();
    assert_eq!(ended.code, Some(0), "{ended:?}");
    assert_eq!(client.calls().len(), 2);
}

#[test]
fn silent_listener_is_not_a_client() {
    let listener = free_port();
    let ended = run(&listener, &["--wait", "0.5"]).ended();
    assert_no_client(&ended, "silence for 0.5 s");
}

#[test]
fn client_without_a_first_answer_is_not_a_client() {
    let (ended, client) = session(vec![], &["--wait", "0.5"]);
    assert_no_client(&ended, "silence for 0.5 s");
    assert_eq!(client.calls().len(), 1, "the client was called once");
}

#[test]
fn server_with_a_different_service_is_not_a_client() {
    let client = Client::of_another_kind();
    let ended = start(&client, &[], &std::env::temp_dir()).ended();
    assert_no_client(&ended, "Unimplemented");
}

#[test]
fn web_server_is_not_a_client() {
    let listener = free_port();
    let executable = run(&listener, &[]);
    let (mut stream, _) = listener.accept().expect("the executable connects");
    stream
        .read_exact(&mut [0; 24])
        .expect("the executable sends the HTTP/2 preface");
    stream
        .write_all(b"HTTP/1.1 400 Bad Request\r\nConnection: close\r\n\r\n")
        .expect("the executable is still connected");
    drop(stream);
    let ended = executable.ended();
    assert_no_client(&ended, "");
}

#[test]
fn listener_that_hangs_up_is_not_a_client() {
    let listener = free_port();
    let executable = run(&listener, &[]);
    let (mut stream, _) = listener.accept().expect("the executable connects");
    // The call has begun.
    stream
        .read_exact(&mut [0; 24])
        .expect("the executable sends the HTTP/2 preface");
    drop(stream);
    let ended = executable.ended();
    assert_no_client(&ended, "");
}

#[test]
fn invalid_host_is_reported() {
    let ended = Executable::start(&["--host", "not a machine"], &std::env::temp_dir()).ended();
    assert_eq!(ended.code, Some(2), "{ended:?}");
    let expected =
        "driftworld-unity: not a machine:5004: expected the name or address of a machine, such as 127.0.0.1\n";
    assert_eq!(ended.stderr, expected);
    // Follow the advice in the message.
    let client = Client::new([who("1.0.0"), command(CommandProto::Quit)]);
    let ended = start(&client, &["--host", "127.0.0.1"], &std::env::temp_dir()).ended();
    assert_eq!(ended.code, Some(0), "{ended:?}");
}
