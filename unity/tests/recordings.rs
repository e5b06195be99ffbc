//! Recordings of a session replay each episode bit for bit, even if the client changes the world during an episode.

use std::collections::BTreeMap;
use std::io::BufReader;

use driftworld_env::{Catalogue, Recording, RecordingReader, Replay};
use driftworld_spec::{Object, Stimulus, World, WorldDraft};
use driftworld_unity::protocol::ListAgentActionProto;
use driftworld_unity::protocol::{AgentActionProto, CommandProto, UnityRlInitializationInputProto, UnityRlInputProto};
use driftworld_unity::{BEHAVIOR, RecordingFile, Screenshots, Session, Setup, Turn};
use proptest::prelude::*;

/// The encoded identifier of the channel for resets and new objects.
const RESET: [u8; 16] = [
    0x70, 0x0a, 0x1f, 0x62, 0x87, 0x4f, 0xea, 0x11, 0xa6, 0xbf, 0x78, 0x4f, 0x43, 0x87, 0xd1, 0xf7,
];

/// A cube that gives a reward, on the agent's path.
fn cube(x: f64, y: f64) -> Object {
    let mut object = Object::new("cube", [x, y]);
    object.reward = 5.0;
    object.reward_stimulus = vec![Stimulus::AgentCollide];
    object
}

fn session() -> Session {
    let mut world = WorldDraft::default();
    world.agent_params.observation_size = 4;
    world.max_steps = 12;
    world.objects.push(cube(0.0, 30.0));
    let setup = Setup {
        world: world.check().expect("the world is valid"),
        ..Setup::default()
    };
    let mut session = Session::new(setup, Screenshots::new("none"), || "2026-01-01T00:00:00Z".to_owned());
    let identity = UnityRlInitializationInputProto {
        communication_version: "1.0.0".to_owned(),
        package_version: "0.16.0".to_owned(),
        ..UnityRlInitializationInputProto::default()
    };
    session.begin(&identity).expect("the client uses version 1");
    session.record();
    session
}

/// A message on the Reset channel.
fn reset_message(text: &str) -> Vec<u8> {
    let payload = [&(text.len() as i32).to_le_bytes(), text.as_bytes()].concat();
    [&RESET[..], &(payload.len() as i32).to_le_bytes(), &payload].concat()
}

/// An action of the client.
#[derive(Clone, Debug)]
enum Act {
    Step([f32; 3]),
    /// A step, with an object that is created before it.
    Create([f32; 3], f64, f64),
    Reset,
}

fn act() -> impl Strategy<Value = Act> {
    let numbers = || (0.0..10.0f32, -60.0..60.0f32, 0.0..1.0f32).prop_map(|(a, b, c)| [a, b, c]);
    prop_oneof![
        8 => numbers().prop_map(Act::Step),
        1 => (numbers(), -20.0..20.0f64, 3.0..20.0f64).prop_map(|(action, x, y)| Act::Create(action, x, y)),
        1 => Just(Act::Reset),
    ]
}

/// Carries out an act; returns each agent's reward, and whether it ends an episode. If a step ends an episode, the first agent
/// has its last reward, and the second starts the next episode.
fn carry_out(session: &mut Session, act: &Act) -> Vec<(f32, bool)> {
    let (command, action, side_channel) = match act {
        Act::Step(action) => (CommandProto::Step, Some(action), Vec::new()),
        Act::Create(action, x, y) => {
            let payload = format!(
                r#"{{ "token": "t", "action": "object_create", "payload": {{ "class": "cube", "coordinates": [{x}, {y}],
                    "reward": 2, "reward_stimulus": ["AgentCollide"] }} }}"#
            );
            (CommandProto::Step, Some(action), reset_message(&payload))
        }
        Act::Reset => (CommandProto::Reset, None, Vec::new()),
    };
    let agent_actions = action.map(|numbers| {
        let action = AgentActionProto {
            vector_actions: numbers.to_vec(),
            ..AgentActionProto::default()
        };
        (BEHAVIOR.to_owned(), ListAgentActionProto { value: vec![action] })
    });
    let input = UnityRlInputProto {
        command: command.into(),
        agent_actions: agent_actions.into_iter().collect::<BTreeMap<_, _>>(),
        side_channel,
    };
    let Turn::Output(output) = session.answer(&input).expect("the command is valid") else {
        panic!("unexpected quit")
    };
    let output = output.rl_output.expect("there is an agent");
    let agents = &output.agent_infos[BEHAVIOR].value;
    agents.iter().map(|agent| (agent.reward, agent.done)).collect()
}

fn read(path: &std::path::Path) -> Vec<Recording> {
    let file = std::fs::File::open(path).expect("the file was written");
    let mut reader = RecordingReader::new(BufReader::new(file)).expect("the file is complete");
    let mut found = Vec::new();
    while let Some(episode) = reader.next_episode().expect("the file is complete") {
        found.push(reader.recording(&episode).expect("the file is complete"));
    }
    found
}

/// Replays a recording, and returns the reward of each step.
fn replayed_rewards(recording: &Recording) -> Vec<f32> {
    let mut replay = Replay::new(recording, &Catalogue::default());
    let mut replayed_rewards = Vec::new();
    while let Some(step) = replay.step().expect("a replay matches its recording") {
        replayed_rewards.push(step.reward as f32);
    }
    replay.check().expect("a replay matches its recording");
    replayed_rewards
}

proptest! {
    #![proptest_config(ProptestConfig::with_cases(24))]
    #[test]
    fn recorded_episodes_replay_bit_for_bit(acts in prop::collection::vec(act(), 1..60)) {
        let mut session = session();
        carry_out(&mut session, &Act::Reset);
        let mut episodes: Vec<Vec<f32>> = vec![Vec::new()];
        let mut edits = 0;
        for act in &acts {
            let agents = carry_out(&mut session, act);
            edits += usize::from(matches!(act, Act::Create(..)));
            match (act, &agents[..]) {
                (Act::Reset, _) => episodes.push(Vec::new()),
                (_, [(reward, false)]) => episodes.last_mut().expect("there is a current episode").push(*reward),
                (_, [(reward, true), _]) => {
                    episodes.last_mut().expect("there is a current episode").push(*reward);
                    episodes.push(Vec::new());
                }
                other => panic!("{other:?}"),
            }
        }
        session.end_recording();
        // Episodes without a step are not recorded.
        episodes.retain(|rewards| !rewards.is_empty());

        let folder = tempfile::tempdir().expect("a temporary folder can be created");
        let path = folder.path().join("episodes.jsonl");
        let recordings = session.take_recordings();
        let mut half = recordings.len() / 2;
        // A client that restarts the program continues the same file.
        let mut file = RecordingFile::open(&path).expect("the file can be created");
        for recording in recordings {
            if half == 0 {
                drop(file);
                let torn = std::fs::OpenOptions::new().append(true).open(&path).expect("the file exists");
                std::io::Write::write_all(&mut &torn, b"{\"experi").expect("the file can be written");
                file = RecordingFile::open(&path).expect("the file can be continued");
            }
            half = half.wrapping_sub(1);
            file.write(recording).expect("the file can be written");
        }
        drop(file);
        let back = read(&path);
        prop_assert_eq!(back.len(), episodes.len());
        for (number, (recording, expected)) in (0..).zip(back.iter().zip(&episodes)) {
            prop_assert_eq!(recording.origin.experience, number);
            prop_assert_eq!(&replayed_rewards(recording), expected);
        }
        prop_assert!(back.iter().map(|recording| recording.edits.len()).sum::<usize>() <= edits);
    }
}

#[test]
fn file_is_locked_against_a_second_program() {
    let folder = tempfile::tempdir().expect("a temporary folder can be created");
    let path = folder.path().join("episodes.jsonl");
    let first = RecordingFile::open(&path).expect("the file can be created");
    let error = RecordingFile::open(&path).expect_err("the file is already open for writing");
    assert!(
        error.to_string().contains("another driftworld-unity is writing to it"),
        "{error}"
    );
    drop(first);
    std::fs::write(&path, World::default().to_json_pretty()).expect("the file can be written");
    assert_eq!(
        RecordingFile::open(&path)
            .expect_err("the file contains a world")
            .code(),
        "unity/recording"
    );
}
