//! `driftworld studio`: the page is served below an address that nobody can guess, and nothing else is; or written into a folder.

use std::io::{BufRead, BufReader, Read, Write};
use std::net::TcpStream;
use std::path::Path;
use std::process::{Child, Command, Stdio};

use super::terminal::{driftworld_in, output, scratch};

/// Creates a folder that looks like a page, and beside it a file that must not be served.
fn page(root: &Path) -> std::path::PathBuf {
    let folder = root.join("page");
    std::fs::create_dir_all(folder.join("networks")).expect("the folder is writable");
    for (name, text) in [
        ("index.html", "<p>page</p>"),
        ("networks/index.json", "[]"),
        ("../secret.txt", "secret"),
    ] {
        std::fs::write(folder.join(name), text).expect("the folder is writable");
    }
    folder
}

fn studio(folder: &Path, arguments: &[&str]) -> Command {
    let mut command = driftworld_in(folder, &[&["studio"], arguments].concat());
    command.env("DRIFTWORLD_STUDIO", folder.join("page"));
    command
}

/// A server that is killed at the end of its test, however the test ends.
struct Serving(Child);

impl Drop for Serving {
    fn drop(&mut self) {
        let _ = self.0.kill();
        let _ = self.0.wait();
    }
}

/// Starts a server and returns it with the address that it printed.
fn served(folder: &Path, arguments: &[&str]) -> (Serving, String) {
    let mut command = studio(folder, arguments);
    let mut child = command
        .arg("--no-open")
        .stdout(Stdio::piped())
        .stderr(Stdio::null())
        .spawn()
        .expect("it starts");
    let mut address = String::new();
    let stdout = child.stdout.take().expect("it was piped");
    BufReader::new(stdout)
        .read_line(&mut address)
        .expect("it prints its address");
    (Serving(child), address.trim().to_owned())
}

/// The host of an address, the token of its path, and its fragment.
fn parts(address: &str) -> (&str, &str, &str) {
    let (before, fragment) = address.split_once('#').expect("a task is shown");
    let host_and_token = before.trim_start_matches("http://").split_once('/');
    let (host, token) = host_and_token.expect("it has a path");
    (host, token, fragment)
}

/// Requests a path from a host; returns the status and the body.
fn get(host: &str, path: &str) -> (u16, String) {
    let mut stream = TcpStream::connect(host).expect("it listens");
    write!(stream, "GET {path} HTTP/1.1\r\nHost: {host}\r\n\r\n").expect("it listens");
    let mut answer = String::new();
    stream.read_to_string(&mut answer).expect("the page is text");
    let (head, body) = answer.split_once("\r\n\r\n").expect("an answer has a head");
    assert!(head.contains("Content-Security-Policy: default-src 'none'"), "{head}");
    let status = head
        .split(' ')
        .nth(1)
        .and_then(|word| word.parse().ok())
        .expect("it has a status");
    (status, body.to_owned())
}

#[test]
fn only_the_page_is_served_and_only_below_its_token() {
    let folder = scratch();
    page(folder.path());
    let (_serving, address) = served(folder.path(), &["find_objects#red"]);
    let (host, token, fragment) = parts(&address);
    assert_eq!(fragment, "/play/find_objects?variant=red");
    assert!(host.starts_with("127.0.0.1:") && token.len() > 32, "{address}");
    assert_eq!(get(host, &format!("/{token}")), (200, "<p>page</p>".to_owned()));
    assert_eq!(get(host, &format!("/{token}networks/index.json")).0, 200);
    for path in [
        "/",
        "/index.html",
        &format!("/{token}../secret.txt"),
        &format!("/{token}%2e%2e/secret.txt"),
        "//etc/passwd",
    ] {
        assert_eq!(get(host, path).0, 404, "{path}");
    }
}

#[test]
fn task_from_a_file_is_served_beside_the_page() {
    let folder = scratch();
    page(folder.path());
    let text = "{ \"name\": \"mine\", \"world\": {} }";
    std::fs::write(folder.path().join("mine.json"), text).expect("the folder is writable");
    let (_serving, address) = served(folder.path(), &["mine.json"]);
    let (host, token, fragment) = parts(&address);
    assert_eq!(fragment, "/author/draft?file=task.json");
    assert_eq!(get(host, &format!("/{token}task.json")), (200, text.to_owned()));
}

#[test]
fn page_is_written_into_a_folder() {
    let folder = scratch();
    page(folder.path());
    let done = output(&mut studio(folder.path(), &["--export", "out"]));
    assert!(done.status.success(), "{done:?}");
    let read = |name: &str| std::fs::read_to_string(folder.path().join("out").join(name)).expect("it was written");
    assert_eq!(
        (read("index.html"), read("networks/index.json")),
        ("<p>page</p>".to_owned(), "[]".to_owned())
    );
    assert!(!folder.path().join("out/secret.txt").exists());
}

#[test]
fn error_for_a_missing_page_or_task_says_what_to_do() {
    let folder = scratch();
    let error = |arguments: &[&str]| {
        let done = output(studio(folder.path(), arguments).arg("--no-open"));
        assert_eq!(done.status.code(), Some(1), "{done:?}");
        String::from_utf8_lossy(&done.stderr).into_owned()
    };
    assert!(error(&[]).contains("cannot be read"), "{}", error(&[]));
    std::fs::create_dir(folder.path().join("page")).expect("the folder is writable");
    assert!(error(&[]).contains("cargo xtask studio"), "{}", error(&[]));
    page(folder.path());
    assert!(
        error(&["no_such_task"]).contains("found task"),
        "{}",
        error(&["no_such_task"])
    );
}
