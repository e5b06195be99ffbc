//! Clients that violate the protocol: the executable sends them the reason, writes it to the terminal, and ends.

use driftworld_spec::World;
use driftworld_unity::protocol::ListAgentActionProto;
use driftworld_unity::protocol::{
    AgentActionProto, CommandProto, HeaderProto, UnityInputProto, UnityMessageProto, UnityRlInputProto,
};
use driftworld_unity::{BEHAVIOR, MAX_INCOMING_BYTES};

use super::played::{Answer, command, says, status, who};
use super::session;

/// Checks that a client that sends invalid answers gets this message, and that the terminal shows it as well.
fn check(last: Vec<Answer>, expected: &str) {
    let (ended, client) = session([vec![who("1.0.0")], last].concat(), &[]);
    assert_eq!(ended.code, Some(1), "{ended:?}");
    let last_line = ended.stderr.lines().last().unwrap_or_default();
    assert_eq!(last_line, format!("driftworld-unity: {expected}"));
    let reply = client.calls().pop().expect("the executable made a call").header;
    let header = HeaderProto {
        status: 500,
        message: expected.to_owned(),
    };
    assert_eq!(reply, Some(header));
}

fn step(actions: &[(&str, &[&[f32]])]) -> Answer {
    let action = |numbers: &[f32]| AgentActionProto {
        vector_actions: numbers.to_vec(),
        ..AgentActionProto::default()
    };
    let list = |agents: &[&[f32]]| ListAgentActionProto {
        value: agents.iter().map(|numbers| action(numbers)).collect(),
    };
    says(UnityRlInputProto {
        agent_actions: actions
            .iter()
            .map(|(behavior, agents)| ((*behavior).to_owned(), list(agents)))
            .collect(),
        ..UnityRlInputProto::default()
    })
}

#[test]
fn failure_reported_by_the_client_ends_the_session() {
    check(vec![status(500)], "client: it ended with status 500: \"words\"");
    check(
        vec![command(CommandProto::Reset), status(503)],
        "client: it ended with status 503: \"words\"",
    );
}

#[test]
fn incomplete_messages_are_refused() {
    let check = |message: UnityMessageProto, missing: &str| {
        check(
            vec![message.into()],
            &format!("client: found a message without {missing}"),
        );
    };
    let header = Some(HeaderProto {
        status: 200,
        message: String::new(),
    });
    let headed = |unity_input| UnityMessageProto {
        header: header.clone(),
        unity_input,
        unity_output: None,
    };
    check(UnityMessageProto::default(), "a header");
    check(headed(None), "a unity_input");
    check(headed(Some(UnityInputProto::default())), "an rl_input");
}

#[test]
fn malformed_messages_are_refused() {
    check(
        vec![Answer::Bytes(b"\x0a\xff\xff\xff".to_vec())],
        "client: a message cannot be read: failed to decode Protobuf message: UnityMessageProto.header: invalid varint",
    );
}

#[test]
fn too_long_messages_are_refused_before_reading() {
    for length in [MAX_INCOMING_BYTES + 1, 100_000_000] {
        let expected = format!(
            "client: a message cannot be read: Error, decoded message length too large: found {length} bytes, the limit is: 50331648 bytes"
        );
        check(vec![Answer::Bytes(vec![b' '; length])], &expected);
    }
}

#[test]
fn client_with_a_different_version_gets_the_reason_if_it_listens() {
    let expected =
        "client: found version \"2.0.0\" of the protocol, expected 1.x, which mlagents-envs 0.16 to 1.1 speak";
    // A client that quits before its first command does not listen: only the terminal gets the reason.
    for (first_command, is_told) in [
        (command(CommandProto::Reset), true),
        (status(400), true),
        (Answer::Fail(tonic::Status::cancelled("CANCELLED")), false),
    ] {
        let (ended, client) = session(vec![who("2.0.0"), first_command], &[]);
        assert_eq!(ended.code, Some(1), "{ended:?}");
        assert!(
            ended.stderr.ends_with(&format!("driftworld-unity: {expected}\n")),
            "{ended:?}"
        );
        let reply = client.calls().pop().and_then(|call| call.header);
        assert_eq!(
            reply.is_some_and(|reply| reply.status == 500 && reply.message == expected),
            is_told
        );
    }
}

#[test]
fn unknown_commands_and_actions_are_refused() {
    let unknown = says(UnityRlInputProto {
        command: 7,
        ..UnityRlInputProto::default()
    });
    check(
        vec![unknown],
        "client: found command 7, expected 0 (step), 1 (reset) or 2 (quit)",
    );
    let valid: &[f32] = &[0.0, 0.0, 0.0];
    check(
        vec![step(&[("Walker?team=0", &[valid])])],
        "actions: found 1 for behaviour \"Walker?team=0\", expected exactly one, for \"L2Explorer?team=0\"",
    );
    check(
        vec![step(&[(BEHAVIOR, &[valid, valid])])],
        "actions: found 2 for behaviour \"L2Explorer?team=0\", expected exactly one, for \"L2Explorer?team=0\"",
    );
    check(
        vec![command(CommandProto::Reset), step(&[(BEHAVIOR, &[&[1.0, 2.0]])])],
        "action: found 2 numbers, expected 3",
    );
}

#[test]
fn non_finite_actions_are_refused() {
    for number in [f32::NAN, f32::INFINITY] {
        let numbers: &[f32] = &[0.0, number, 0.0];
        let expected = format!(
            "action: found [0.0, {:?}, 0.0], expected three finite numbers; nothing was changed",
            f64::from(number)
        );
        check(
            vec![command(CommandProto::Reset), step(&[(BEHAVIOR, &[numbers])])],
            &expected,
        );
    }
}

/// A folder with a world of this observation size.
fn world(observation_size: u32) -> (tempfile::TempDir, String) {
    let folder = tempfile::tempdir().expect("a temporary folder can be created");
    let file = folder.path().join("world.json");
    let world = World::default().edit(|world| world.agent_params.observation_size = observation_size);
    let world = world.expect("the size is valid");
    std::fs::write(&file, world.to_json()).expect("the folder can be written");
    let file = file.display().to_string();
    (folder, file)
}

#[test]
fn too_large_observations_are_refused_with_helpful_advice() {
    let (_folder, large) = world(512);
    let answers = || vec![who("1.0.0"), command(CommandProto::Reset), command(CommandProto::Quit)];
    let (ended, client) = session(answers(), &["--raw-observations", "--world", &large]);
    assert_eq!(ended.code, Some(1), "{ended:?}");
    let last_line = ended.stderr.lines().last().unwrap_or_default();
    let text = last_line.strip_prefix("driftworld-unity: ").unwrap_or_default();
    assert!(text.starts_with("observation: found 94") && text.contains(" bytes in a message, expected at most 4194304, which clients accept; reset to a smaller observation_size, or leave out --raw-observations"), "{ended:?}");
    let reply = client.calls().pop().and_then(|call| call.header);
    assert_eq!(reply.expect("the last call has a header").message, text);

    let (_folder, small) = world(256);
    for arguments in [
        ["--raw-observations", "--world", &small].as_slice(),
        &["--world", &large],
    ] {
        let (ended, client) = session(answers(), arguments);
        assert_eq!(ended.code, Some(0), "{ended:?}");
        assert_eq!(client.calls().len(), 3);
    }
}
