//! Fuzz target for ML-Agents messages. Input: a raw message, or after [`MARK`](crate::edited::MARK) a command with text on the
//! Reset channel, such as an edited world.

use arbitrary::Unstructured;
use driftworld_spec::World;
use driftworld_unity::protocol::{
    AgentActionProto, CommandProto, ListAgentActionProto, UnityMessageProto, UnityRlInputProto,
};
use driftworld_unity::{BEHAVIOR, Screenshots, Session, Setup, Turn};
use prost::Message;
use serde_json::json;

use crate::edited::{MARK, byte};
use crate::{refusal, world};

/// Bytes of the Reset channel's identifier.
const RESET: [u8; 16] = [
    0x70, 0x0a, 0x1f, 0x62, 0x87, 0x4f, 0xea, 0x11, 0xa6, 0xbf, 0x78, 0x4f, 0x43, 0x87, 0xd1, 0xf7,
];

/// gRPC's default limit on the size of a message, in bytes.
const MAX_ANSWER_BYTES: usize = 4 << 20;

/// Maximum length of a message on the Reset channel, in bytes; other tests run larger worlds.
const MAX_TEXT_BYTES: usize = 16_000;

/// A session in a small world. Its screenshots go to a temporary folder.
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

/// A session answers or refuses each message within the limits of its transport, and continues.
pub(crate) fn check(bytes: &[u8]) {
    let input = match bytes.split_first() {
        Some((&MARK, rest)) => command_from(rest),
        _ => match UnityMessageProto::decode(bytes) {
            Ok(message) => message.unity_input.and_then(|input| input.rl_input).unwrap_or_default(),
            Err(_) => return,
        },
    };
    let (mut session, _folder) = session();
    answer(&mut session, &input);
    refusal::messages(session.take_remarks());
    let reset = UnityRlInputProto {
        command: CommandProto::Reset.into(),
        ..UnityRlInputProto::default()
    };
    assert!(answer(&mut session, &reset), "the session continues");
}

/// Whether the session answered.
fn answer(session: &mut Session, input: &UnityRlInputProto) -> bool {
    match session.answer(input) {
        Ok(Turn::Output(output)) => {
            assert!(
                output.encoded_len() < MAX_ANSWER_BYTES,
                "{} bytes",
                output.encoded_len()
            );
            true
        }
        Ok(Turn::Quit) => false,
        Err(error) => {
            refusal::message(&error.to_string());
            false
        }
    }
}

fn command_from(bytes: &[u8]) -> UnityRlInputProto {
    let mut bytes = Unstructured::new(bytes);
    let command = byte(&mut bytes) % 3;
    let numbers: Vec<f32> = (0..byte(&mut bytes) % 5)
        .map(|_| bytes.arbitrary().unwrap_or_default())
        .collect();
    let action = AgentActionProto {
        vector_actions: numbers,
        ..AgentActionProto::default()
    };
    let actions = ListAgentActionProto { value: vec![action] };
    let text = match byte(&mut bytes) % 4 {
        0 => String::from_utf8_lossy(bytes.take_rest()).into_owned(),
        1 => {
            let object =
                json!({ "class": "ball", "coordinates": [f64::from(byte(&mut bytes)) - 128.0, 3], "unique_name": "x" });
            json!({ "token": "t", "action": "object_create", "payload": object }).to_string()
        }
        _ => {
            let payload = world::known().edited(&mut bytes);
            json!({ "token": "t", "action": "reset_environment", "payload": payload }).to_string()
        }
    };
    let text = &text[..text.floor_char_boundary(MAX_TEXT_BYTES)];
    let payload = [&(text.len() as i32).to_le_bytes(), text.as_bytes()].concat();
    let record = [&RESET[..], &(payload.len() as i32).to_le_bytes(), &payload].concat();
    UnityRlInputProto {
        command: i32::from(command),
        agent_actions: [(BEHAVIOR.to_owned(), actions)].into_iter().collect(),
        side_channel: record,
    }
}
