//! The messages of the ML-Agents protocol, with the field numbers and names of mlagents-envs 0.16 to 1.1. Fields that neither
//! side needs are omitted, and skipped when received.

use std::collections::BTreeMap;

/// A message from either side.
#[derive(Clone, PartialEq, prost::Message)]
pub struct UnityMessageProto {
    /// The sender's status.
    #[prost(message, optional, tag = "1")]
    pub header: Option<HeaderProto>,
    /// The world's output.
    #[prost(message, optional, tag = "2")]
    pub unity_output: Option<UnityOutputProto>,
    /// Python's input.
    #[prost(message, optional, tag = "3")]
    pub unity_input: Option<UnityInputProto>,
}

/// The sender's status.
#[derive(Clone, PartialEq, Eq, Hash, prost::Message)]
pub struct HeaderProto {
    /// 200: success; 400: end; anything else is an error.
    #[prost(int32, tag = "1")]
    pub status: i32,
    /// The error message.
    #[prost(string, tag = "2")]
    pub message: String,
}

/// Capabilities beyond the first version of the protocol, one flag each.
#[expect(
    clippy::struct_excessive_bools,
    reason = "the protocol has a flag for each capability"
)]
#[derive(Clone, Copy, PartialEq, Eq, Hash, prost::Message)]
pub struct UnityRlCapabilitiesProto {
    /// The basic protocol of every version.
    #[prost(bool, tag = "1")]
    pub base_rl_capabilities: bool,
    /// Images of more than three channels as several PNG files.
    #[prost(bool, tag = "2")]
    pub concatenated_png_observations: bool,
    /// A mapping between the channels of compressed images and observations.
    #[prost(bool, tag = "3")]
    pub compressed_channel_mapping: bool,
    /// Actions with continuous and discrete numbers, and `action_spec`.
    #[prost(bool, tag = "4")]
    pub hybrid_actions: bool,
    /// Training analytics for Unity Technologies.
    #[prost(bool, tag = "5")]
    pub training_analytics: bool,
    /// Observations of variable length.
    #[prost(bool, tag = "6")]
    pub variable_length_observation: bool,
    /// Groups of agents with group rewards.
    #[prost(bool, tag = "7")]
    pub multi_agent_groups: bool,
}

/// Python's input: its identity once, then commands.
#[derive(Clone, PartialEq, prost::Message)]
pub struct UnityInputProto {
    /// A command.
    #[prost(message, optional, tag = "1")]
    pub rl_input: Option<UnityRlInputProto>,
    /// The client's identity.
    #[prost(message, optional, tag = "2")]
    pub rl_initialization_input: Option<UnityRlInitializationInputProto>,
}

/// A client's identity.
#[derive(Clone, PartialEq, Eq, Hash, prost::Message)]
pub struct UnityRlInitializationInputProto {
    /// A seed for the world.
    #[prost(int32, tag = "1")]
    pub seed: i32,
    /// The version of the protocol that the client speaks.
    #[prost(string, tag = "2")]
    pub communication_version: String,
    /// The version of its package.
    #[prost(string, tag = "3")]
    pub package_version: String,
    /// Its further capabilities.
    #[prost(message, optional, tag = "4")]
    pub capabilities: Option<UnityRlCapabilitiesProto>,
}

/// A command, with actions and side channel messages.
#[derive(Clone, PartialEq, prost::Message)]
pub struct UnityRlInputProto {
    /// Actions by name of behaviour.
    #[prost(btree_map = "string, message", tag = "1")]
    pub agent_actions: BTreeMap<String, ListAgentActionProto>,
    /// The command.
    #[prost(enumeration = "CommandProto", tag = "4")]
    pub command: i32,
    /// Side channel messages: identifier, length and bytes of each, concatenated.
    #[prost(bytes = "vec", tag = "5")]
    pub side_channel: Vec<u8>,
}

/// The actions of one behaviour's agents, in the order in which the agents were sent.
#[derive(Clone, PartialEq, prost::Message)]
pub struct ListAgentActionProto {
    /// One action per agent.
    #[prost(message, repeated, tag = "1")]
    pub value: Vec<AgentActionProto>,
}

/// One agent's action.
#[expect(clippy::struct_field_names, reason = "the names are the protocol's")]
#[derive(Clone, PartialEq, prost::Message)]
pub struct AgentActionProto {
    /// Continuous or discrete numbers; the only form before protocol version 1.3.
    #[prost(float, repeated, tag = "1")]
    pub vector_actions: Vec<f32>,
    /// Continuous numbers.
    #[prost(float, repeated, tag = "6")]
    pub continuous_actions: Vec<f32>,
    /// Discrete numbers.
    #[prost(int32, repeated, tag = "7")]
    pub discrete_actions: Vec<i32>,
}

/// A command for the world.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash, PartialOrd, Ord, prost::Enumeration)]
#[repr(i32)]
pub enum CommandProto {
    /// Take one step.
    Step = 0,
    /// Start an episode.
    Reset = 1,
    /// Quit.
    Quit = 2,
}

/// One observation.
#[derive(Clone, PartialEq, prost::Message)]
pub struct ObservationProto {
    /// Length of each dimension.
    #[prost(int32, repeated, tag = "1")]
    pub shape: Vec<i32>,
    /// The form of the data.
    #[prost(enumeration = "CompressionTypeProto", tag = "2")]
    pub compression_type: i32,
    /// Properties of each dimension: 2 for translational equivariance (rows and columns of images), 1 for none.
    #[prost(int32, repeated, tag = "6")]
    pub dimension_properties: Vec<i32>,
    /// Its name.
    #[prost(string, tag = "8")]
    pub name: String,
    /// The data.
    #[prost(oneof = "ObservationData", tags = "3, 4")]
    pub observation_data: Option<ObservationData>,
}

/// Uncompressed numbers.
#[derive(Clone, PartialEq, prost::Message)]
pub struct FloatData {
    /// Row by row.
    #[prost(float, repeated, tag = "1")]
    pub data: Vec<f32>,
}

/// The data of an observation.
#[derive(Clone, PartialEq, prost::Oneof)]
pub enum ObservationData {
    /// As a PNG file.
    #[prost(bytes, tag = "3")]
    CompressedData(Vec<u8>),
    /// As floats.
    #[prost(message, tag = "4")]
    FloatData(FloatData),
}

/// Forms of observations.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash, PartialOrd, Ord, prost::Enumeration)]
#[repr(i32)]
pub enum CompressionTypeProto {
    /// Floats.
    None = 0,
    /// A PNG file.
    Png = 1,
}

/// The world's output: the results of a command, and the description of a new world.
#[derive(Clone, PartialEq, prost::Message)]
pub struct UnityOutputProto {
    /// The results of a command.
    #[prost(message, optional, tag = "1")]
    pub rl_output: Option<UnityRlOutputProto>,
    /// The world's description.
    #[prost(message, optional, tag = "2")]
    pub rl_initialization_output: Option<UnityRlInitializationOutputProto>,
}

/// The description of a world.
#[derive(Clone, PartialEq, prost::Message)]
pub struct UnityRlInitializationOutputProto {
    /// Its name.
    #[prost(string, tag = "1")]
    pub name: String,
    /// The version of the protocol that the world speaks.
    #[prost(string, tag = "2")]
    pub communication_version: String,
    /// Its behaviours. Python registers a behaviour only together with one of its agents.
    #[prost(message, repeated, tag = "5")]
    pub brain_parameters: Vec<BrainParametersProto>,
    /// The version of its package.
    #[prost(string, tag = "7")]
    pub package_version: String,
    /// Its capabilities.
    #[prost(message, optional, tag = "8")]
    pub capabilities: Option<UnityRlCapabilitiesProto>,
}

/// The action space of a behaviour.
#[derive(Clone, PartialEq, Eq, Hash, prost::Message)]
pub struct BrainParametersProto {
    /// Number of continuous numbers, or of choices of each discrete one; for clients before protocol version 1.3.
    #[prost(int32, repeated, tag = "3")]
    pub vector_action_size: Vec<i32>,
    /// Descriptions of the numbers.
    #[prost(string, repeated, tag = "5")]
    pub vector_action_descriptions: Vec<String>,
    /// The kind of numbers.
    #[prost(enumeration = "SpaceTypeProto", tag = "6")]
    pub vector_action_space_type: i32,
    /// The behaviour's name.
    #[prost(string, tag = "7")]
    pub brain_name: String,
    /// Whether Python controls its agents.
    #[prost(bool, tag = "8")]
    pub is_training: bool,
    /// The action space for clients using protocol version 1.3 or later.
    #[prost(message, optional, tag = "9")]
    pub action_spec: Option<ActionSpecProto>,
}

/// An action space for clients using protocol version 1.3 or later.
#[derive(Clone, PartialEq, Eq, Hash, prost::Message)]
pub struct ActionSpecProto {
    /// Number of continuous numbers.
    #[prost(int32, tag = "1")]
    pub num_continuous_actions: i32,
    /// Number of discrete numbers.
    #[prost(int32, tag = "2")]
    pub num_discrete_actions: i32,
    /// Number of choices of each discrete number.
    #[prost(int32, repeated, tag = "3")]
    pub discrete_branch_sizes: Vec<i32>,
    /// Descriptions of the numbers.
    #[prost(string, repeated, tag = "4")]
    pub action_descriptions: Vec<String>,
}

/// The results of a command.
#[derive(Clone, PartialEq, prost::Message)]
pub struct UnityRlOutputProto {
    /// Agents by name of behaviour.
    #[prost(btree_map = "string, message", tag = "2")]
    pub agent_infos: BTreeMap<String, ListAgentInfoProto>,
    /// Side channel messages: identifier, length and bytes of each, concatenated.
    #[prost(bytes = "vec", tag = "3")]
    pub side_channel: Vec<u8>,
}

/// The agents of one behaviour.
#[derive(Clone, PartialEq, prost::Message)]
pub struct ListAgentInfoProto {
    /// One entry per agent.
    #[prost(message, repeated, tag = "1")]
    pub value: Vec<AgentInfoProto>,
}

/// One agent's results and observations.
#[derive(Clone, PartialEq, prost::Message)]
pub struct AgentInfoProto {
    /// The reward of the step.
    #[prost(float, tag = "7")]
    pub reward: f32,
    /// Whether its episode has ended.
    #[prost(bool, tag = "8")]
    pub done: bool,
    /// Whether its episode was truncated.
    #[prost(bool, tag = "9")]
    pub max_step_reached: bool,
    /// The agent's number, new in each episode.
    #[prost(int32, tag = "10")]
    pub id: i32,
    /// Its observations.
    #[prost(message, repeated, tag = "13")]
    pub observations: Vec<ObservationProto>,
}

/// Kinds of actions.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash, PartialOrd, Ord, prost::Enumeration)]
#[repr(i32)]
pub enum SpaceTypeProto {
    /// Discrete choices.
    Discrete = 0,
    /// Continuous numbers.
    Continuous = 1,
}
