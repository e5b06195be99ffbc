//! A session refuses malicious and malformed messages with bounded answers, and continues.

use driftworld_spec::World;
use driftworld_unity::protocol::{
    AgentActionProto, CommandProto, ListAgentActionProto, UnityMessageProto, UnityOutputProto, UnityRlInputProto,
};
use driftworld_unity::{BEHAVIOR, Screenshots, Session, Setup, Turn, UnityError};
use proptest::prelude::*;
use prost::Message;

use crate::recorded::{RELEASES, messages};

/// The Reset channel's encoded identifier.
const RESET: [u8; 16] = [
    0x70, 0x0a, 0x1f, 0x62, 0x87, 0x4f, 0xea, 0x11, 0xa6, 0xbf, 0x78, 0x4f, 0x43, 0x87, 0xd1, 0xf7,
];

/// The default limit of gRPC servers.
const MAX_ANSWER_BYTES: usize = 4 << 20;

/// A session in a small world, with screenshots in a temporary folder.
fn session() -> (Session, tempfile::TempDir) {
    let folder = tempfile::tempdir().expect("a temporary folder can be created");
    let world = World::default().edit(|world| world.agent_params.observation_size = 8);
    let setup = Setup {
        world: world.expect("images may be this small"),
        ..Setup::default()
    };
    let clock = || "2026-01-01T00:00:00Z".to_owned();
    let session = Session::new(setup, Screenshots::new(folder.path()), clock);
    (session, folder)
}

fn record(guid: [u8; 16], length: i32, payload: &[u8]) -> Vec<u8> {
    [guid.as_slice(), &length.to_le_bytes(), payload].concat()
}

/// A message on the Reset channel with correct lengths.
fn reset_message(text: &str) -> Vec<u8> {
    let payload = [&(text.len() as i32).to_le_bytes(), text.as_bytes()].concat();
    record(RESET, payload.len() as i32, &payload)
}

fn step_with(side_channel: Vec<u8>) -> UnityRlInputProto {
    UnityRlInputProto {
        side_channel,
        ..UnityRlInputProto::default()
    }
}

fn answer(session: &mut Session, input: &UnityRlInputProto) -> Result<UnityOutputProto, UnityError> {
    match session.answer(input)? {
        Turn::Output(output) => {
            assert!(
                output.encoded_len() < MAX_ANSWER_BYTES,
                "{} bytes",
                output.encoded_len()
            );
            Ok(*output)
        }
        Turn::Quit => Ok(UnityOutputProto::default()),
    }
}

fn actions(lists: &[(&str, &[&[f32]])]) -> UnityRlInputProto {
    let action = |numbers: &&[f32]| AgentActionProto {
        vector_actions: numbers.to_vec(),
        ..AgentActionProto::default()
    };
    let entry = |(behavior, agents): &(&str, &[&[f32]])| {
        let value = agents.iter().map(action).collect();
        ((*behavior).to_owned(), ListAgentActionProto { value })
    };
    UnityRlInputProto {
        agent_actions: lists.iter().map(entry).collect(),
        ..UnityRlInputProto::default()
    }
}

/// Checks that the session still answers a reset and a step.
fn assert_session_works(session: &mut Session) {
    let reset = UnityRlInputProto {
        command: CommandProto::Reset.into(),
        ..UnityRlInputProto::default()
    };
    for command in [reset, actions(&[(BEHAVIOR, &[&[1.0, 0.0, 0.0]])])] {
        let output = answer(session, &command).expect("the session continues");
        let agents = &output.rl_output.expect("there is an agent").agent_infos[BEHAVIOR].value;
        assert_eq!(agents.last().map(|agent| agent.observations.len()), Some(4));
    }
}

/// Sends a message with a step; returns the session's answer and its remarks. The session must continue.
fn check(bytes: Vec<u8>) -> (String, Vec<String>) {
    let (mut session, _folder) = session();
    let output = answer(&mut session, &step_with(bytes)).expect("a message does not end a session");
    let remarks = session.take_remarks();
    let sent = output.rl_output.expect("there is an agent").side_channel;
    assert_session_works(&mut session);
    (String::from_utf8_lossy(&sent).into_owned(), remarks)
}

proptest! {
    #![proptest_config(ProptestConfig { cases: crate::tier::quick_or_full(24, 200), failure_persistence: None, ..ProptestConfig::default() })]

    #[test]
    fn arbitrary_bytes_never_panic(bytes in proptest::collection::vec(any::<u8>(), 0..400)) {
        check(bytes);
    }

    #[test]
    fn arbitrary_text_on_a_channel_is_answered(text in ".{0,200}") {
        let (sent, _) = check(reset_message(&text));
        prop_assert!(sent.contains("\"action\":\"error\""), "{sent}");
    }

    /// Invalid messages are refused by the decoder; valid ones are answered or refused, and the session continues.
    #[test]
    fn tampered_recorded_messages_never_panic(
        release in 0..RELEASES.len(),
        number in 1_usize..14,
        changes in proptest::collection::vec((any::<prop::sample::Index>(), any::<u8>()), 1..6),
        cut in proptest::option::of(any::<prop::sample::Index>()),
    ) {
        let recorded = messages(RELEASES[release]);
        let mut bytes = recorded[number % recorded.len()].1.clone();
        for (position, byte) in changes {
            let position = position.index(bytes.len());
            bytes[position] = byte;
        }
        if let Some(cut) = cut {
            bytes.truncate(cut.index(bytes.len()) + 1);
        }
        if let Ok(message) = UnityMessageProto::decode(bytes.as_slice())
            && let Some(input) = message.unity_input.and_then(|input| input.rl_input)
        {
            let (mut session, _folder) = session();
            // Any answer is fine.
            let _ = answer(&mut session, &input);
            assert_session_works(&mut session);
        }
    }
}

#[test]
fn wrong_lengths_are_refused_at_both_levels() {
    for length in [-1, i32::MIN, 0x7fff_ffff, 100] {
        let (_, remarks) = check(record(RESET, length, b"abc"));
        assert!(
            remarks[0].contains(&format!("claims {length} bytes, with 3 left")),
            "{remarks:?}"
        );
        let payload = [&length.to_le_bytes(), b"abc".as_slice()].concat();
        let (sent, _) = check(record(RESET, 7, &payload));
        assert!(sent.contains(&format!("claims {length} bytes, with 3 left")), "{sent}");
    }
}

/// Messages of more than 48 MiB never reach the session: the transport refuses them.
#[test]
fn text_of_40_megabytes_gets_a_short_answer() {
    let long = "x".repeat(40_000_000);
    for text in [
        long.clone(),
        format!("{{\"action\":\"{long}\"}}"),
        format!("{{\"token\":\"{long}\",\"action\":\"x\"}}"),
        format!("{{\"action\":\"reset_environment\",\"payload\":\"{long}\"}}"),
        format!("{{\"action\":\"object_create\",\"payload\":{{\"class\":\"{long}\",\"coordinates\":[0,0]}}}}"),
    ] {
        let (sent, remarks) = check(reset_message(&text));
        assert!(
            sent.contains("\"action\":\"error\"") && sent.len() < 2000,
            "{} bytes",
            sent.len()
        );
        assert!(remarks.iter().all(|remark| remark.len() < 2000));
    }
}

#[test]
fn json_bombs_are_refused_before_parsing() {
    let list = |value: &str| {
        format!(
            "[{}{value}]",
            format!("{value},").repeat(40_000_000 / (value.len() + 1))
        )
    };
    for value in ["[]", "{}", "1"] {
        let bomb = list(value);
        for text in [
            format!("{{\"action\":\"reset_environment\",\"payload\":{bomb}}}"),
            format!("{{\"action\":\"reset_environment\",\"payload\":{{\"objects\":{bomb}}}}}"),
        ] {
            let (sent, _) = check(reset_message(&text));
            assert!(
                sent.contains(" values, expected at most 400000 of the 400000 in one go"),
                "{sent}"
            );
        }
    }
}

/// Texts with tens of thousands of mistakes are read in one pass; each mistake gets a remark or a refusal.
#[test]
fn texts_with_many_mistakes_are_read_once() {
    let keys: Vec<String> = (0..50_000).map(|key| format!("\"k{key}\":1")).collect();
    let (sent, _) = check(reset_message(&format!(
        "{{\"action\":\"reset_environment\",\"payload\":{{{}}}}}",
        keys.join(",")
    )));
    assert!(sent.contains("\"action\":\"ok\""), "unknown keys are ignored: {sent}");
    let objects = format!("[{}1]", "1,".repeat(20_000));
    let (sent, _) = check(reset_message(&format!(
        "{{\"action\":\"reset_environment\",\"payload\":{{\"objects\":{objects}}}}}"
    )));
    assert!(
        sent.contains("\"action\":\"ok\""),
        "list items that are not objects are skipped: {sent}"
    );
    let objects = "{\"class\":\"tree\",\"coordinates\":[1e9,0]},".repeat(20_000);
    let (sent, _) = check(reset_message(&format!(
        "{{\"action\":\"reset_environment\",\"payload\":{{\"objects\":[{objects}1]}}}}"
    )));
    assert!(
        sent.contains("payload: and at least 280 more"),
        "the first 300 are listed: {sent}"
    );
}

#[test]
fn odd_json_is_refused_with_a_message() {
    let reset = |payload: &str| format!("{{\"action\":\"reset_environment\",\"payload\":{payload}}}");
    for text in [
        "[".repeat(300_000),
        reset(&format!("{}{}", "[".repeat(100_000), "]".repeat(100_000))),
        reset("{\"max_steps\":1e999999}"),
        reset(&format!("{{\"max_steps\":{}}}", "9".repeat(100_000))),
        reset("{\"agent_params\":{\"observation_size\":1e9}}"),
        reset("{\"environment_params\":{\"map_size\":[1e308,1e308]}}"),
        "\u{0}".to_owned(),
        "{\"action\":\"\\ud800\"}".to_owned(),
    ] {
        let (sent, _) = check(reset_message(&text));
        assert!(sent.contains("\"action\":\"error\""), "{text:.100}: {sent}");
    }
}

#[test]
fn surplus_messages_are_refused_with_a_message() {
    let (sent, remarks) = check(reset_message("{}").repeat(5000));
    assert_eq!(sent.matches("\"action\":\"error\"").count(), 5000);
    assert_eq!(sent.matches("found more than 1000 in one go").count(), 4000);
    let expected = "messages: found more than 1000 in one go; the others are refused";
    assert!(remarks.iter().any(|remark| remark == expected), "{remarks:?}");
}

/// While texts are being parsed, a disconnected client is not noticed, so all texts of a batch share one limit.
#[test]
fn texts_of_one_batch_are_limited() {
    let zeros = vec!["0"; 150_000].join(",");
    let text = format!(r#"{{"action":"reset_environment","payload":{{}},"beside":[{zeros}]}}"#);
    let (sent, _) = check(reset_message(&text).repeat(4));
    assert_eq!(sent.matches("\"action\":\"ok\"").count(), 2, "{sent}");
    assert_eq!(sent.matches("of the 400000 in one go").count(), 2, "{sent}");
}

/// The Debug channel's encoded identifier.
const DEBUG: [u8; 16] = [
    0xb5, 0xa0, 0xfb, 0xc5, 0x92, 0x63, 0x33, 0x44, 0xa9, 0x5f, 0xcd, 0xec, 0x6b, 0x00, 0x61, 0xe1,
];
/// The encoded identifier of the channel for environment parameters.
const PARAMETERS: [u8; 16] = [
    0x1e, 0x89, 0x4c, 0x53, 0x0f, 0x81, 0xea, 0x11, 0xa9, 0xd0, 0x82, 0x24, 0x85, 0x86, 0x04, 0x00,
];

/// An encoded environment parameter.
fn parameter(name: &str, value: f32) -> Vec<u8> {
    let number = value.to_le_bytes();
    let payload = [&(name.len() as i32).to_le_bytes(), name.as_bytes(), &[0; 4], &number].concat();
    record(PARAMETERS, payload.len() as i32, &payload)
}

/// While images are rendered, a disconnected client is not noticed, so their number per batch is limited.
#[test]
fn large_screenshots_per_batch_are_limited() {
    let text = r#"{"action":"save_screenshot","payload":{"filename":"a.png","upscale_factor":512}}"#;
    let payload = [&(text.len() as i32).to_le_bytes(), text.as_bytes()].concat();
    let (sent, _) = check(record(DEBUG, payload.len() as i32, &payload).repeat(5));
    assert_eq!(sent.matches("\"action\":\"ok\"").count(), 2, "{sent}");
    assert_eq!(
        sent.matches("more pictures than are drawn in one go").count(),
        3,
        "{sent}"
    );
}

#[test]
fn remarks_on_settings_leave_room_for_those_on_refusals() {
    let (mut session, _folder) = session();
    let settings = (0..900_u16).flat_map(|number| parameter(&format!("difficulty {}", number % 300), number.into()));
    answer(&mut session, &step_with(settings.collect())).expect("settings do not end a session");
    let remarks = session.take_remarks();
    assert_eq!(
        remarks.len(),
        101,
        "one per name up to the limit, and a closing one: {remarks:?}"
    );
    let refused = reset_message(r#"{"action":"reset_environment","payload":7}"#);
    answer(&mut session, &step_with(refused)).expect("the session continues");
    let remarks = session.take_remarks();
    assert!(
        remarks.iter().any(|remark| remark.contains("was refused")),
        "{remarks:?}"
    );
}

#[test]
fn parameters_invalid_in_a_world_are_skipped_for_it() {
    let (mut session, _folder) = session();
    let large = reset_message(r#"{"action":"reset_environment","payload":{"agent_params":{"observation_size":2100}}}"#);
    let input = UnityRlInputProto {
        side_channel: [parameter("supersampling", 4.0), large].concat(),
        command: CommandProto::Reset.into(),
        ..UnityRlInputProto::default()
    };
    answer(&mut session, &input).expect("the world is valid without the parameter");
    let remarks = session.take_remarks();
    assert!(
        remarks
            .iter()
            .any(|remark| remark.contains("for which they are invalid")),
        "{remarks:?}"
    );
}

#[test]
fn only_step_reads_actions() {
    let (mut session, _folder) = session();
    for command in [CommandProto::Reset, CommandProto::Quit] {
        let input = UnityRlInputProto {
            command: command.into(),
            ..actions(&[(BEHAVIOR, &[&[1.0, 2.0]])])
        };
        answer(&mut session, &input).expect("no action is carried out");
    }
    let error = answer(&mut session, &actions(&[(BEHAVIOR, &[&[1.0, 2.0]])])).expect_err("a step needs three numbers");
    assert_eq!(error.code(), "unity/action-length");
}

#[test]
fn surplus_answers_wait_for_the_next_turn_up_to_a_limit() {
    let debug = [
        0xb5, 0xa0, 0xfb, 0xc5, 0x92, 0x63, 0x33, 0x44, 0xa9, 0x5f, 0xcd, 0xec, 0x6b, 0x00, 0x61, 0xe1,
    ];
    let (mut session, _folder) = session();
    let listen = "{\"action\":\"set_debug_categories\",\"payload\":[{\"category\":\"worldmaker\",\"active\":true}]}";
    let mut listen = reset_message(listen);
    listen[..16].copy_from_slice(&debug);
    answer(&mut session, &step_with(listen)).expect("messages do not end a session");
    // Each key causes a remark: more bytes than a client accepts at a time, and more messages than may be queued.
    let keys: Vec<String> = (0..12_000).map(|key| format!("\"{key:0>200}\":1")).collect();
    // Each message reports its first 300 keys.
    let many_keys = keys.chunks(300).flat_map(|keys| {
        reset_message(&format!(
            "{{\"action\":\"reset_environment\",\"payload\":{{{}}}}}",
            keys.join(",")
        ))
    });
    let many_keys: Vec<u8> = many_keys.collect();
    let output = answer(&mut session, &step_with(many_keys)).expect("messages do not end a session");
    let first = output.rl_output.expect("there is an agent").side_channel.len();
    assert!(first > MAX_ANSWER_BYTES / 2, "{first} bytes");
    let remarks = session.take_remarks();
    assert!(
        remarks.iter().any(|remark| remark.contains("messages were left out")),
        "{remarks:?}"
    );
    let output = answer(&mut session, &step_with(Vec::new())).expect("the session continues");
    assert!(
        !output.rl_output.expect("there is an agent").side_channel.is_empty(),
        "the next output carries the rest"
    );
    assert_session_works(&mut session);
}

#[test]
fn invalid_commands_and_actions_change_nothing() {
    let valid: &[f32] = &[0.0, 0.0, 0.0];
    let unknown = UnityRlInputProto {
        command: -1,
        ..UnityRlInputProto::default()
    };
    for (input, code) in [
        (unknown, "unity/unknown-command"),
        (actions(&[("", &[valid])]), "unity/wrong-agent"),
        (
            actions(&[(BEHAVIOR, &[valid]), ("Walker", &[valid])]),
            "unity/wrong-agent",
        ),
        (actions(&[(BEHAVIOR, &[valid, valid])]), "unity/wrong-agent"),
        (actions(&[(BEHAVIOR, &[])]), "unity/wrong-agent"),
        (actions(&[(BEHAVIOR, &[&[]])]), "unity/action-length"),
        (actions(&[(BEHAVIOR, &[&[1.0, 2.0]])]), "unity/action-length"),
        (actions(&[(BEHAVIOR, &[&[1.0, 2.0, 3.0, 4.0]])]), "unity/action-length"),
        (actions(&[(BEHAVIOR, &[&[f32::NAN, 0.0, 0.0]])]), "unity/env"),
        (actions(&[(BEHAVIOR, &[&[0.0, 0.0, f32::NEG_INFINITY]])]), "unity/env"),
    ] {
        let (mut session, _folder) = session();
        let error = answer(&mut session, &input).expect_err("the input is invalid");
        assert_eq!(error.code(), code, "{error}");
        assert_session_works(&mut session);
    }
}
