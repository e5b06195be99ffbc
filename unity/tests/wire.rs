//! Compares the protocol's encodings with bytes written by hand: each field has the number and type that published clients use.

use driftworld_unity::Session;
use driftworld_unity::protocol::{
    ActionSpecProto, AgentActionProto, AgentInfoProto, BrainParametersProto, CommandProto, CompressionTypeProto,
    FloatData, HeaderProto, ListAgentActionProto, ListAgentInfoProto, ObservationData, ObservationProto,
    SpaceTypeProto, UnityInputProto, UnityMessageProto, UnityOutputProto, UnityRlCapabilitiesProto,
    UnityRlInitializationInputProto, UnityRlInitializationOutputProto, UnityRlInputProto, UnityRlOutputProto,
};
use prost::Message;

/// A field with an integer below 128, or true.
fn number(field: u8, value: u8) -> Vec<u8> {
    varint(field, &[value])
}

fn varint(field: u8, bytes: &[u8]) -> Vec<u8> {
    [&[field << 3], bytes].concat()
}

/// A field with a 32-bit float.
fn float(field: u8, value: f32) -> Vec<u8> {
    [&[field << 3 | 5], value.to_le_bytes().as_slice()].concat()
}

/// A field with a string, bytes, a message or a packed list, of fewer than 128 bytes.
fn block(field: u8, bytes: impl AsRef<[u8]>) -> Vec<u8> {
    let bytes = bytes.as_ref();
    assert!(bytes.len() < 128, "the length of longer fields takes two bytes");
    [&[field << 3 | 2, bytes.len() as u8], bytes].concat()
}

fn floats(field: u8, values: &[f32]) -> Vec<u8> {
    let bytes: Vec<u8> = values.iter().flat_map(|value| value.to_le_bytes()).collect();
    block(field, bytes)
}

/// Checks that the value encodes to these bytes and decodes from them.
fn check<M: Message + Default + PartialEq + std::fmt::Debug>(message: &M, parts: &[Vec<u8>]) {
    let bytes = parts.concat();
    assert_eq!(message.encode_to_vec(), bytes, "encoding {message:?}");
    assert_eq!(
        &M::decode(bytes.as_slice()).expect("the bytes are valid"),
        message,
        "decoding"
    );
}

#[test]
fn envelope_has_the_published_field_numbers() {
    let header = HeaderProto {
        status: 200,
        message: "m".to_owned(),
    };
    check(&header, &[varint(1, &[0xc8, 0x01]), block(2, "m")]);
    let message = UnityMessageProto {
        header: Some(HeaderProto::default()),
        unity_output: Some(UnityOutputProto {
            rl_output: Some(UnityRlOutputProto::default()),
            rl_initialization_output: Some(UnityRlInitializationOutputProto::default()),
        }),
        unity_input: Some(UnityInputProto {
            rl_input: Some(UnityRlInputProto::default()),
            rl_initialization_input: Some(UnityRlInitializationInputProto::default()),
        }),
    };
    let both = [block(1, []), block(2, [])].concat();
    check(&message, &[block(1, []), block(2, &both), block(3, &both)]);
}

#[test]
fn inputs_have_the_published_field_numbers() {
    let who = UnityRlInitializationInputProto {
        seed: 7,
        communication_version: "1.0.0".to_owned(),
        package_version: "0.16.0".to_owned(),
        capabilities: Some(capabilities()),
    };
    let capable = (1..=7).flat_map(|field| number(field, 1)).collect::<Vec<u8>>();
    check(
        &who,
        &[number(1, 7), block(2, "1.0.0"), block(3, "0.16.0"), block(4, capable)],
    );
    let action = AgentActionProto {
        vector_actions: vec![1.5, -2.0, 0.0],
        continuous_actions: vec![0.5],
        ..AgentActionProto::default()
    };
    let list = ListAgentActionProto { value: vec![action] };
    let command = UnityRlInputProto {
        agent_actions: [("b".to_owned(), list)].into(),
        command: CommandProto::Quit.into(),
        side_channel: vec![9, 8],
    };
    let action = [floats(1, &[1.5, -2.0, 0.0]), floats(6, &[0.5])].concat();
    let entry = [block(1, "b"), block(2, block(1, action))].concat();
    check(&command, &[block(1, entry), number(4, 2), block(5, [9, 8])]);
    let numbers = [CommandProto::Step, CommandProto::Reset, CommandProto::Quit].map(i32::from);
    assert_eq!(numbers, [0, 1, 2]);
    // Field 4 is the trainer's value estimate, which is ignored.
    let parameters = AgentActionProto::decode([floats(1, &[1.0]), float(4, 3.0)].concat().as_slice());
    assert_eq!(parameters.expect("the bytes are valid").vector_actions, [1.0]);
}

fn capabilities() -> UnityRlCapabilitiesProto {
    UnityRlCapabilitiesProto {
        base_rl_capabilities: true,
        concatenated_png_observations: true,
        compressed_channel_mapping: true,
        hybrid_actions: true,
        training_analytics: true,
        variable_length_observation: true,
        multi_agent_groups: true,
    }
}

#[test]
fn outputs_have_the_published_field_numbers() {
    let agent = AgentInfoProto {
        reward: 0.5,
        done: true,
        max_step_reached: true,
        id: 4,
        observations: vec![ObservationProto::default()],
    };
    let info = [float(7, 0.5), number(8, 1), number(9, 1), number(10, 4), block(13, [])].concat();
    let output = UnityRlOutputProto {
        agent_infos: [("b".to_owned(), ListAgentInfoProto { value: vec![agent] })].into(),
        side_channel: vec![7],
    };
    let entry = [block(1, "b"), block(2, block(1, info))].concat();
    check(&output, &[block(2, entry), block(3, [7])]);
}

#[test]
fn observations_have_the_published_field_numbers() {
    let picture = ObservationProto {
        shape: vec![4, 5, 3],
        compression_type: CompressionTypeProto::Png.into(),
        dimension_properties: vec![2, 2, 1],
        name: "rgb".to_owned(),
        observation_data: Some(ObservationData::CompressedData(vec![1, 2])),
    };
    let parts = [
        block(1, [4, 5, 3]),
        number(2, 1),
        block(3, [1, 2]),
        block(6, [2, 2, 1]),
        block(8, "rgb"),
    ];
    check(&picture, &parts);
    let data = FloatData { data: vec![1.0, 2.0] };
    let vector = ObservationProto {
        observation_data: Some(ObservationData::FloatData(data)),
        ..ObservationProto::default()
    };
    check(&vector, &[block(4, floats(1, &[1.0, 2.0]))]);
    assert_eq!(i32::from(CompressionTypeProto::None), 0);
}

#[test]
fn behaviours_have_the_published_field_numbers() {
    let spec = ActionSpecProto {
        num_continuous_actions: 3,
        num_discrete_actions: 1,
        discrete_branch_sizes: vec![2],
        action_descriptions: vec!["d".to_owned()],
    };
    let parameters = BrainParametersProto {
        vector_action_size: vec![3],
        vector_action_descriptions: vec!["d".to_owned()],
        vector_action_space_type: SpaceTypeProto::Continuous.into(),
        brain_name: "b".to_owned(),
        is_training: true,
        action_spec: Some(spec),
    };
    let spec = [number(1, 3), number(2, 1), block(3, [2]), block(4, "d")].concat();
    let parts = [
        block(3, [3]),
        block(5, "d"),
        number(6, 1),
        block(7, "b"),
        number(8, 1),
        block(9, spec),
    ];
    check(&parameters, &parts);
    assert_eq!(i32::from(SpaceTypeProto::Discrete), 0);
}

#[test]
fn greeting_has_the_expected_bytes() {
    let version = format!("driftworld {}", env!("CARGO_PKG_VERSION"));
    let capable = [number(1, 1), number(4, 1)].concat();
    let parts = [
        block(1, "L2Explorer"),
        block(2, "1.0.0"),
        block(7, version),
        block(8, capable),
    ];
    assert_eq!(Session::greeting().encode_to_vec(), block(2, parts.concat()));
}
