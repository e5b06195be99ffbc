//! The network matches `PyTorch`, the agent holds its actions, and bad files are refused.

use std::sync::Arc;

use driftworld_spec::{ActionSpace, World};

use super::{Agent, NetworkAgent, Trained, file};
use crate::sim::{Action, Environment};

/// A network with three actions, each held for five time steps, and images of 16 × 16 pixels; written by
/// `scripts/golden_network.py`.
const NETWORK: &[u8] = include_bytes!("../../../tests/golden/network.safetensors");

fn trained() -> Trained {
    file::read("golden", NETWORK).expect("the golden network is valid")
}

fn agent(edit: impl FnOnce(&mut Trained)) -> NetworkAgent {
    let mut trained = trained();
    edit(&mut trained);
    NetworkAgent::of(Arc::new(trained))
}

/// Actions of the first steps; the agent stands in the middle of the arena and sees one tree.
fn actions(agent: &mut dyn Agent, seed: u64, edit: impl FnOnce(&mut driftworld_spec::WorldDraft)) -> Vec<Action> {
    let world = World::default().edit(|world| {
        world.objects.push(driftworld_spec::Object::new("tree", [2.0, 9.0]));
        edit(world);
    });
    let mut environment = Environment::new(world.expect("the world is valid"));
    agent.begin(seed);
    let step = |_| {
        let action = agent.act(&environment);
        environment.step(action).expect("an action of the world");
        action
    };
    (0..40).map(step).collect()
}

#[test]
fn log_probabilities_match_torch() {
    let rows: Vec<Vec<f64>> =
        serde_json::from_str(include_str!("../../../tests/golden/network.json")).expect("it has rows of numbers");
    let network = trained().network;
    assert_eq!(rows.len(), 4);
    for (number, expected) in rows.iter().enumerate() {
        let image: Vec<u8> = (0..16 * 16 * 3)
            .map(|k| ((k * (7 + 2 * number) + k / 5) % 256) as u8)
            .collect();
        let found = network.log_policy(&image);
        assert_eq!(found.len(), expected.len());
        for (found, expected) in found.iter().zip(expected) {
            assert!(
                (found - expected).abs() < 1e-5,
                "image {number}: {found}, expected {expected}"
            );
        }
    }
}

#[test]
fn image_matches_an_environment_of_the_same_size() {
    let world = World::default().edit(|world| {
        world.objects.push(driftworld_spec::Object::new("tree", [2.0, 9.0]));
        world.agent_params.observation_size = 16;
        world.agent_params.supersampling = 2;
    });
    let mut environment = Environment::new(world.expect("the world is valid"));
    let mut agent = agent(|_| {});
    agent.look(&environment);
    assert_eq!(agent.image, environment.observe().rgb);
}

#[test]
fn action_is_held_and_interacts_only_in_its_first_time_step() {
    let always = |trained: &mut Trained| trained.actions = vec![[4.0, 9.0, 1.0]; 3];
    let first = Action::Continuous([4.0, 9.0, 1.0]);
    let later = Action::Continuous([4.0, 9.0, 0.0]);
    for (frame_skip, held) in [(1, 5), (2, 3), (5, 1), (7, 1)] {
        let done = actions(&mut agent(always), 0, |world| {
            world.agent_params.frame_skip = frame_skip;
        });
        for (step, action) in done.into_iter().enumerate() {
            let expected = if step % held == 0 { first } else { later };
            assert_eq!(action, expected, "step {step} with a frame skip of {frame_skip}");
        }
    }
    let no_frame_skip =
        |trained: &mut Trained| (trained.actions, trained.frame_skip) = (vec![[4.0, 9.0, 1.0]; 3], None);
    assert_eq!(actions(&mut agent(no_frame_skip), 0, |_| {}), vec![first; 40]);
}

#[test]
fn action_in_a_world_with_a_table_is_the_nearest_row() {
    let always = |trained: &mut Trained| trained.actions = vec![[4.0, 9.0, 0.0]; 3];
    let table = vec![[0.0, 90.0, 0.0], [5.0, 0.0, 0.0], [-5.0, 0.0, 0.0]];
    let done = actions(&mut agent(always), 0, |world| {
        world.agent_params.actions = ActionSpace::Discrete(table);
    });
    assert_eq!(done, vec![Action::Discrete(1); 40]);
}

#[test]
fn sampling_depends_only_on_the_episode_seed() {
    let sampled = |trained: &mut Trained| trained.is_greedy = false;
    let mut used = agent(sampled);
    let first = actions(&mut used, 3, |_| {});
    assert_ne!(first, actions(&mut used, 4, |_| {}));
    assert_eq!(first, actions(&mut used, 3, |_| {}));
    assert!(!used.learns());
    let mut copy = used.frozen().expect("it can be copied");
    assert_eq!(first, actions(copy.as_mut(), 3, |_| {}));
    let mut greedy = agent(|_| {});
    assert_eq!(actions(&mut greedy, 3, |_| {}), actions(&mut greedy, 4, |_| {}));
}

/// The file with one word of its header replaced.
fn changed(from: &str, to: &str) -> Vec<u8> {
    let length = u64::from_le_bytes(*NETWORK.first_chunk().expect("the file starts with eight bytes")) as usize;
    let (header, data) = NETWORK[8..].split_at(length);
    let header = std::str::from_utf8(header).expect("it is UTF-8");
    assert!(header.contains(from), "{from}");
    let header = header.replacen(from, to, 1);
    [&(header.len() as u64).to_le_bytes(), header.as_bytes(), data].concat()
}

#[test]
fn bf16_tensors_give_the_same_output_as_f32() {
    let length = u64::from_le_bytes(*NETWORK.first_chunk().expect("the file starts with eight bytes")) as usize;
    let (header, data) = NETWORK[8..].split_at(length);
    let rounded: Vec<[u8; 4]> = data.as_chunks().0.iter().map(|[_, _, c, d]| [0, 0, *c, *d]).collect();
    let halves: Vec<u8> = rounded.iter().flat_map(|bytes| &bytes[2..]).copied().collect();
    let mut tensors: serde_json::Value = serde_json::from_slice(header).expect("it is JSON");
    for tensor in tensors.as_object_mut().expect("there are tensors").values_mut().skip(1) {
        let offsets = [0, 1].map(|k| tensor["data_offsets"][k].as_u64().expect("it is an offset") / 2);
        (tensor["dtype"], tensor["data_offsets"]) = ("BF16".into(), offsets.as_slice().into());
    }
    let short = tensors.to_string();
    let file = |header: &[u8], data: &[u8]| [&(header.len() as u64).to_le_bytes(), header, data].concat();
    let [long, short] = [file(header, rounded.as_flattened()), file(short.as_bytes(), &halves)]
        .map(|file| file::read("halves", &file).expect("it is a valid network").network);
    assert_eq!(
        long.log_policy(&[77; 16 * 16 * 3]),
        short.log_policy(&[77; 16 * 16 * 3])
    );
}

fn refusal(bytes: &[u8]) -> String {
    let result = NetworkAgent::parse("a.safetensors", bytes).map(|_| "accepted".to_owned());
    result.unwrap_or_else(|error| error.to_string())
}

#[test]
fn bad_files_are_refused_with_where_and_what() {
    let mut lines = vec![
        refusal(b""),
        refusal(b"PK\x03\x04 and so on, as torch.save writes"),
        refusal(&[&2_u64.to_le_bytes()[..], b"{]"].concat()),
        refusal(&[&2_u64.to_le_bytes()[..], b"{}"].concat()),
        refusal(&NETWORK[..NETWORK.len() - 100]),
    ];
    let mut infinite = NETWORK.to_vec();
    let last = infinite.len();
    // The last 9 numbers belong to the value head, which is not read.
    infinite[last - 40..last - 36].copy_from_slice(&f32::NAN.to_le_bytes());
    lines.push(refusal(&infinite));
    for (from, to) in [
        ("\"patch\"", "\"gru\""),
        ("\"architecture\": \"patch\", ", ""),
        ("\"size\": \"16\"", "\"size\": 16"),
        ("\"size\": \"16\"", "\"size\": \"12\""),
        ("\"size\": \"16\"", "\"size\": \"100000\""),
        ("\"size\": \"16\"", "\"size\": \"24\""),
        ("[3.0, 90.0, 0.0]", "[3.0, 90.0]"),
        ("[3.0, 90.0, 0.0], ", ""),
        ("\"greedy\"", "\"best\""),
        ("\"frame_skip\": \"5\"", "\"frame_skip\": \"0\""),
        ("trunk.large.weight", "trunk.huge.weight"),
        ("\"F32\"", "\"F16\""),
        ("[4, 48]", "[48, 4]"),
        ("[0, 768]", "[0, 764]"),
        ("[0, 768]", "[768, 0]"),
        ("\"shape\": [4]", "\"shape\": [18446744073709551615]"),
        ("\"shape\": [4]", "\"shape\": [0]"),
        ("\"shape\": [4]", "\"shape\": 4"),
    ] {
        lines.push(refusal(&changed(from, to)));
    }
    insta::assert_snapshot!(lines.join("\n"));
}
