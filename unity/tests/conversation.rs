//! Replays the recorded messages of clients of three releases, and compares every answer, down to pixels and wording.
//!
//! `golden/record.py` records the clients; `INSTA_UPDATE=always` rewrites the expected answers. Images are compared by a checksum
//! of their pixels, because the bytes of a PNG file depend on the encoder.

use std::fmt::Write;

use driftworld_unity::protocol::ObservationData;
use driftworld_unity::protocol::{
    AgentInfoProto, BrainParametersProto, CommandProto, ObservationProto, UnityInputProto, UnityMessageProto,
    UnityOutputProto, UnityRlInputProto,
};
use driftworld_unity::{BEHAVIOR, Screenshots, Session, Setup, Turn};
use prost::Message;
use serde_json::Value;

use crate::recorded::{RELEASES, messages};

/// L2Explorer's channels, by the first bytes of their encoded identifiers.
const CHANNELS: [([u8; 4], &str); 3] = [
    ([0x70, 0x0a, 0x1f, 0x62], "Reset"),
    ([0x21, 0x51, 0x71, 0x37], "State"),
    ([0xb5, 0xa0, 0xfb, 0xc5], "Debug"),
];

fn session(folder: &std::path::Path) -> Session {
    let clock = || "2026-01-01T00:00:00Z".to_owned();
    Session::new(Setup::default(), Screenshots::new(folder), clock)
}

fn input(bytes: &[u8]) -> UnityInputProto {
    let message = UnityMessageProto::decode(bytes).expect("the recorded message is valid");
    assert_eq!(message.header.expect("every message has a header").status, 200);
    message.unity_input.expect("every recorded message has an input")
}

/// A checksum: 64-bit FNV-1a.
fn checksum(bytes: &[u8]) -> u64 {
    let mix = |sum: u64, byte: &u8| (sum ^ u64::from(*byte)).wrapping_mul(0x0100_0000_01b3);
    bytes.iter().fold(0xcbf2_9ce4_8422_2325, mix)
}

fn picture(png: &[u8]) -> String {
    let mut reader = png::Decoder::new(std::io::Cursor::new(png))
        .read_info()
        .expect("the image is a PNG file");
    let mut pixels = vec![0; reader.output_buffer_size().expect("the image is small")];
    let info = reader.next_frame(&mut pixels).expect("the image is complete");
    pixels.truncate(info.buffer_size());
    let (width, height, colors) = (info.width, info.height, info.color_type);
    format!("PNG {width} × {height} {colors:?} {:016x}", checksum(&pixels))
}

fn observation(seen: &ObservationProto) -> String {
    let data = match seen.observation_data.as_ref().expect("every observation has data") {
        ObservationData::CompressedData(png) => picture(png),
        ObservationData::FloatData(floats) => format!("{:?}", floats.data),
    };
    format!("{} {:?} {:?} {data}", seen.name, seen.shape, seen.dimension_properties)
}

fn agent(text: &mut String, agent: &AgentInfoProto) -> std::fmt::Result {
    let AgentInfoProto { reward, id, .. } = agent;
    let end = match (agent.done, agent.max_step_reached) {
        (false, false) => "",
        (true, false) => ", over",
        (true, true) => ", truncated",
        (false, true) => ", truncated but not over",
    };
    writeln!(text, "  agent {id}: reward {reward}{end}")?;
    for seen in &agent.observations {
        writeln!(text, "    {}", observation(seen))?;
    }
    Ok(())
}

fn behavior(text: &mut String, parameters: &BrainParametersProto) -> std::fmt::Result {
    writeln!(
        text,
        "  behaviour {:?}: type {}, {:?} numbers, training {}, {:?}",
        parameters.brain_name,
        parameters.vector_action_space_type,
        parameters.vector_action_size,
        parameters.is_training,
        parameters.vector_action_descriptions
    )?;
    let Some(spec) = &parameters.action_spec else {
        return Ok(());
    };
    writeln!(
        text,
        "    continuous {}, discrete {} {:?}, {:?}",
        spec.num_continuous_actions, spec.num_discrete_actions, spec.discrete_branch_sizes, spec.action_descriptions
    )
}

/// The side channel messages, with their channels.
fn side_channel_messages(mut bytes: &[u8]) -> Vec<(&'static str, Value)> {
    let number = |bytes: &[u8]| i32::from_le_bytes(bytes.try_into().expect("a number has four bytes")) as usize;
    let mut found = Vec::new();
    while !bytes.is_empty() {
        let (head, rest) = bytes.split_at(20);
        let (payload, rest) = rest.split_at(number(&head[16..]));
        let (length, text) = payload.split_at(4);
        assert_eq!(number(length), text.len(), "the length field matches the text");
        assert!(text.is_ascii(), "old clients decode ASCII only");
        let channel = CHANNELS.iter().find(|(start, _)| head.starts_with(start));
        let json = serde_json::from_slice(text).expect("every message is JSON");
        found.push((channel.expect("the channel is L2Explorer's").1, json));
        bytes = rest;
    }
    found
}

fn output(text: &mut String, output: &UnityOutputProto) -> std::fmt::Result {
    for parameters in output
        .rl_initialization_output
        .iter()
        .flat_map(|news| &news.brain_parameters)
    {
        behavior(text, parameters)?;
    }
    let results = output.rl_output.as_ref().expect("every output has results");
    assert_eq!(results.agent_infos.len(), 1, "there is one behaviour");
    for info in &results.agent_infos[BEHAVIOR].value {
        agent(text, info)?;
    }
    for (channel, message) in side_channel_messages(&results.side_channel) {
        writeln!(text, "  {channel}: {message}")?;
    }
    Ok(())
}

/// All answers to the client of a release.
fn answers(release: &str) -> Result<String, std::fmt::Error> {
    let folder = tempfile::tempdir().expect("a temporary folder can be created");
    let mut session = session(folder.path());
    let mut text = String::new();
    let recorded = messages(release);
    let ((_, first), rest) = recorded.split_first().expect("the recording has a first message");
    let ((_, last), rest) = rest.split_last().expect("the recording has a last message");
    let identity = input(first)
        .rl_initialization_input
        .expect("the first message identifies the client");
    session.begin(&identity).expect("the client's version is supported");
    for (about, bytes) in rest {
        writeln!(text, "{about}")?;
        let command = input(bytes).rl_input.expect("the message has a command");
        match session.answer(&command).expect("the command is valid") {
            Turn::Output(answer) => output(&mut text, &answer)?,
            Turn::Quit => panic!("unexpected quit"),
        }
        for remark in session.take_remarks() {
            let remark = remark.replace(&folder.path().display().to_string(), "FOLDER");
            writeln!(text, "  remark: {remark}")?;
        }
    }
    let last = UnityMessageProto::decode(last.as_slice()).expect("the last message is valid");
    assert_eq!(
        (last.header.map(|header| header.status), last.unity_input),
        (Some(400), None)
    );
    let screenshot = std::fs::read(folder.path().join("view.png")).expect("the screenshot is in its folder");
    writeln!(text, "the screenshot: {}", picture(&screenshot))?;
    Ok(text)
}

#[test]
fn answers_to_each_release_are_unchanged() {
    for release in RELEASES {
        let name = format!("answers_to_{release}");
        insta::assert_snapshot!(name, answers(release).expect("writing to a String does not fail"));
    }
}

#[test]
fn same_conversation_gives_the_same_answers() {
    assert_eq!(answers("0.16"), answers("0.16"));
}

/// Encoding a decoded message restores its bytes.
#[test]
fn decoding_drops_only_the_number_of_areas() {
    // The last field of a client's first message: the number of copies of its scene that Unity should build, which does not apply
    // here.
    let areas = [5 << 3, 1];
    for release in RELEASES {
        for (about, mut bytes) in messages(release) {
            let message = UnityMessageProto::decode(bytes.as_slice()).expect("the message is valid");
            let mut kept = message.encode_to_vec();
            if release != "0.16" && about == "the client's identity" {
                assert!(bytes.ends_with(&areas), "{release}");
                bytes.truncate(bytes.len() - areas.len());
                // The enclosing lengths are shorter by the same amount.
                kept[6] += areas.len() as u8;
                kept[8] += areas.len() as u8;
            }
            assert_eq!(kept, bytes, "{release}: {about}");
        }
    }
}

#[test]
fn quit_handles_its_messages_and_ends_the_session() {
    let folder = tempfile::tempdir().expect("a temporary folder can be created");
    let mut session = session(folder.path());
    let wants_screenshot = |(about, _): &(String, Vec<u8>)| about.contains("screenshot");
    let (_, bytes) = messages("1.1")
        .into_iter()
        .find(wants_screenshot)
        .expect("one message requests a screenshot");
    let request = input(&bytes).rl_input.expect("the message has a command");
    let quit = UnityRlInputProto {
        command: CommandProto::Quit.into(),
        ..request
    };
    assert_eq!(session.answer(&quit).expect("quitting is always allowed"), Turn::Quit);
    assert!(folder.path().join("view.png").exists());
}
