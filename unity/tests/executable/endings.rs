//! Endings that are not errors: the client quits or disconnects.

use driftworld_unity::protocol::{CommandProto, HeaderProto, UnityInputProto, UnityMessageProto, UnityOutputProto};
use driftworld_unity::{Screenshots, Session, Setup, Turn};
use prost::Message;
use tonic::Status;

use super::played::{Answer, Client, command, status, who};
use super::{session, start};
use crate::recorded::{RELEASES, messages};

fn input(bytes: &[u8]) -> UnityInputProto {
    let message = UnityMessageProto::decode(bytes).expect("the recorded message is valid");
    message.unity_input.expect("every recorded message has an input")
}

/// The message's bytes, with every time replaced by a fixed one.
fn timeless(message: &UnityMessageProto) -> Vec<u8> {
    let mut bytes = message.encode_to_vec();
    let key = br#""msg_time":""#;
    let start = b"2026-01-01T00:00:00.000Z\"";
    for index in 0..bytes.len().saturating_sub(key.len() + start.len()) {
        if bytes[index..].starts_with(key) {
            bytes[index + key.len()..][..start.len()].copy_from_slice(start);
        }
    }
    bytes
}

#[test]
fn executable_sends_the_sessions_answers() {
    for release in RELEASES {
        let recorded = messages(release);
        let client = Client::new(recorded.iter().map(|(_, bytes)| Answer::Bytes(bytes.clone())));
        let folder = tempfile::tempdir().expect("a temporary folder can be created");
        let executable = start(&client, &[], folder.path());

        let twin_folder = tempfile::tempdir().expect("a temporary folder can be created");
        let clock = || "2026-01-01T00:00:00.000Z".to_owned();
        let mut twin = Session::new(Setup::default(), Screenshots::new(twin_folder.path()), clock);
        let greeting = client.call();
        let ok = HeaderProto {
            status: 200,
            message: String::new(),
        };
        assert_eq!(greeting.header, Some(ok.clone()), "{release}");
        assert_eq!(greeting.unity_output, Some(Session::greeting()), "{release}");
        let who = input(&recorded[0].1)
            .rl_initialization_input
            .expect("the first message identifies the client");
        twin.begin(&who).expect("the client's version is supported");
        assert_eq!(
            client.call().unity_output,
            Some(UnityOutputProto::default()),
            "{release}"
        );
        for (about, bytes) in &recorded[1..recorded.len() - 1] {
            let command = input(bytes).rl_input.expect("the message has a command");
            let Ok(Turn::Output(expected)) = twin.answer(&command) else {
                panic!("{release}: {about}")
            };
            let expected = UnityMessageProto {
                header: Some(ok.clone()),
                unity_output: Some(*expected),
                unity_input: None,
            };
            assert!(timeless(&client.call()) == timeless(&expected), "{release}: {about}");
        }
        let ended = executable.ended();
        assert_eq!(ended.code, Some(0), "{ended:?}");
        assert_eq!(ended.stdout, "");
        assert!(
            ended.stderr.starts_with("driftworld-unity: a client at 127.0.0.1:"),
            "{ended:?}"
        );
        assert!(folder.path().join("screenshots/view.png").exists());
        assert!(client.calls().is_empty(), "no call follows the end");
    }
}

#[test]
fn quit_ends_the_executable() {
    let (ended, client) = session(
        vec![who("1.0.0"), command(CommandProto::Reset), command(CommandProto::Quit)],
        &[],
    );
    assert_eq!(ended.code, Some(0), "{ended:?}");
    assert_eq!(client.calls().len(), 3, "a quit is not answered");
}

#[test]
fn client_may_quit_before_its_first_command_or_message() {
    for answers in [vec![status(400)], vec![who("1.0.0"), status(400)]] {
        let (ended, _) = session(answers, &[]);
        assert_eq!(ended.code, Some(0), "{ended:?}");
    }
}

#[test]
fn killed_client_gives_a_remark_and_no_error() {
    for calls in 2..5 {
        let before = [who("1.0.0"), command(CommandProto::Reset), command(CommandProto::Step)];
        let mut client = Client::new(before.into_iter().take(calls - 1));
        let folder = tempfile::tempdir().expect("a temporary folder can be created");
        let executable = start(&client, &[], folder.path());
        for _ in 0..calls {
            client.call();
        }
        client.leave();
        let ended = executable.ended();
        assert_eq!(ended.code, Some(0), "after {calls} calls: {ended:?}");
        let last = ended.stderr.lines().last().unwrap_or_default();
        assert!(last.starts_with("driftworld-unity: the client is gone ("), "{ended:?}");
    }
}

/// Python's servers answer like this while they are being closed, or on an interrupt.
#[test]
fn call_cancelled_by_the_client_ends_the_session() {
    for failure in [
        Status::cancelled("CANCELLED"),
        Status::unknown("Exception calling application: handle is closed"),
    ] {
        let words = failure.message().to_owned();
        let (ended, _) = session(
            vec![who("1.0.0"), command(CommandProto::Reset), Answer::Fail(failure)],
            &[],
        );
        assert_eq!(ended.code, Some(0), "{ended:?}");
        assert!(ended.stderr.contains(&words), "{ended:?}");
    }
}
