//! The messages of the ML-Agents protocol: numbers and names of mlagents-envs 0.16 to 1.1. Fields that no
//! client sends and nobody here writes are left out, and skipped when they come.

use std::collections::BTreeMap;

/// One message, of either side.
#[derive(Clone, PartialEq, prost::Message)]
pub struct UnityMessageProto {
    /// Whether all is well.
    #[prost(message, optional, tag = "1")]
    pub header: Option<HeaderProto>,
    /// What the world says.
    #[prost(message, optional, tag = "2")]
    pub unity_output: Option<UnityOutputProto>,
    /// What Python says.
    #[prost(message, optional, tag = "3")]
    pub unity_input: Option<UnityInputProto>,
}

/// How the sender is.
#[derive(Clone, PartialEq, Eq, Hash, prost::Message)]
pub struct HeaderProto {
    /// 200: well; 400: this is the end; anything else is an error.
    #[prost(int32, tag = "1")]
    pub status: i32,
    /// The error in words.
    #[prost(string, tag = "2")]
    pub message: String,
}

/// What a side understands beyond the first version of the protocol: one flag for each thing.
#[expect(
    clippy::struct_excessive_bools,
    reason = "the protocol has a flag for each capability"
)]
#[derive(Clone, Copy, PartialEq, Eq, Hash, prost::Message)]
pub struct UnityRlCapabilitiesProto {
    /// What every version can.
    #[prost(bool, tag = "1")]
    pub base_rl_capabilities: bool,
    /// Pictures of more than three channels as several PNG files.
    #[prost(bool, tag = "2")]
    pub concatenated_png_observations: bool,
    /// Channels that change places between picture and observation.
    #[prost(bool, tag = "3")]
    pub compressed_channel_mapping: bool,
    /// Actions with continuous and discrete numbers, and `action_spec`.
    #[prost(bool, tag = "4")]
    pub hybrid_actions: bool,
    /// Notes about trainings for the maker of the engine.
    #[prost(bool, tag = "5")]
    pub training_analytics: bool,
    /// Observations whose length changes.
    #[prost(bool, tag = "6")]
    pub variable_length_observation: bool,
    /// Groups of agents with rewards of their own.
    #[prost(bool, tag = "7")]
    pub multi_agent_groups: bool,
}

/// What Python says: who it is, once; then commands.
#[derive(Clone, PartialEq, prost::Message)]
pub struct UnityInputProto {
    /// A command.
    #[prost(message, optional, tag = "1")]
    pub rl_input: Option<UnityRlInputProto>,
    /// Who it is.
    #[prost(message, optional, tag = "2")]
    pub rl_initialization_input: Option<UnityRlInitializationInputProto>,
}

/// Who the client is.
#[derive(Clone, PartialEq, Eq, Hash, prost::Message)]
pub struct UnityRlInitializationInputProto {
    /// A seed for worlds that want one.
    #[prost(int32, tag = "1")]
    pub seed: i32,
    /// The version of the protocol that it speaks.
    #[prost(string, tag = "2")]
    pub communication_version: String,
    /// Its own version.
    #[prost(string, tag = "3")]
    pub package_version: String,
    /// What it understands beyond that.
    #[prost(message, optional, tag = "4")]
    pub capabilities: Option<UnityRlCapabilitiesProto>,
}

/// A command, what agents do, and messages beside them.
#[derive(Clone, PartialEq, prost::Message)]
pub struct UnityRlInputProto {
    /// Behaviours by name.
    #[prost(btree_map = "string, message", tag = "1")]
    pub agent_actions: BTreeMap<String, ListAgentActionProto>,
    /// What is to be done.
    #[prost(enumeration = "CommandProto", tag = "4")]
    pub command: i32,
    /// Messages beside: identifier, length and bytes of each, one after the other.
    #[prost(bytes = "vec", tag = "5")]
    pub side_channel: Vec<u8>,
}

/// The actions of one behaviour's agents, in the order in which they were told.
#[derive(Clone, PartialEq, prost::Message)]
pub struct ListAgentActionProto {
    /// An action for each agent.
    #[prost(message, repeated, tag = "1")]
    pub value: Vec<AgentActionProto>,
}

/// What one agent does.
#[expect(clippy::struct_field_names, reason = "the names are the protocol's")]
#[derive(Clone, PartialEq, prost::Message)]
pub struct AgentActionProto {
    /// Continuous and discrete numbers alike; all that clients before 1.3 of the protocol send.
    #[prost(float, repeated, tag = "1")]
    pub vector_actions: Vec<f32>,
    /// Continuous numbers.
    #[prost(float, repeated, tag = "6")]
    pub continuous_actions: Vec<f32>,
    /// Discrete numbers.
    #[prost(int32, repeated, tag = "7")]
    pub discrete_actions: Vec<i32>,
}

/// What the world is to do.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash, PartialOrd, Ord, prost::Enumeration)]
#[repr(i32)]
pub enum CommandProto {
    /// Go on by one step.
    Step = 0,
    /// Begin an episode.
    Reset = 1,
    /// End.
    Quit = 2,
}

/// One observation.
#[derive(Clone, PartialEq, prost::Message)]
pub struct ObservationProto {
    /// How many numbers along each dimension.
    #[prost(int32, repeated, tag = "1")]
    pub shape: Vec<i32>,
    /// Which of the two forms below it has.
    #[prost(enumeration = "CompressionTypeProto", tag = "2")]
    pub compression_type: i32,
    /// What each dimension means: 1 has no neighbours, 2 has (rows and columns of pictures).
    #[prost(int32, repeated, tag = "6")]
    pub dimension_properties: Vec<i32>,
    /// Its name.
    #[prost(string, tag = "8")]
    pub name: String,
    /// The numbers.
    #[prost(oneof = "ObservationData", tags = "3, 4")]
    pub observation_data: Option<ObservationData>,
}

/// Numbers as they are.
#[derive(Clone, PartialEq, prost::Message)]
pub struct FloatData {
    /// Row after row.
    #[prost(float, repeated, tag = "1")]
    pub data: Vec<f32>,
}

/// The numbers.
#[derive(Clone, PartialEq, prost::Oneof)]
pub enum ObservationData {
    /// As a PNG file.
    #[prost(bytes, tag = "3")]
    CompressedData(Vec<u8>),
    /// As they are.
    #[prost(message, tag = "4")]
    FloatData(FloatData),
}

/// Forms of observations.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash, PartialOrd, Ord, prost::Enumeration)]
#[repr(i32)]
pub enum CompressionTypeProto {
    /// Numbers.
    None = 0,
    /// A PNG file.
    Png = 1,
}

/// What a world says: what happened, and, where it is new, what can be done in it.
#[derive(Clone, PartialEq, prost::Message)]
pub struct UnityOutputProto {
    /// What happened.
    #[prost(message, optional, tag = "1")]
    pub rl_output: Option<UnityRlOutputProto>,
    /// What it is, and what can be done in it.
    #[prost(message, optional, tag = "2")]
    pub rl_initialization_output: Option<UnityRlInitializationOutputProto>,
}

/// What a world is.
#[derive(Clone, PartialEq, prost::Message)]
pub struct UnityRlInitializationOutputProto {
    /// Its name.
    #[prost(string, tag = "1")]
    pub name: String,
    /// The version of the protocol that it speaks.
    #[prost(string, tag = "2")]
    pub communication_version: String,
    /// The behaviours in it. Python takes notice of one only beside an agent of it.
    #[prost(message, repeated, tag = "5")]
    pub brain_parameters: Vec<BrainParametersProto>,
    /// The version of the package that it stands in for.
    #[prost(string, tag = "7")]
    pub package_version: String,
    /// What it understands.
    #[prost(message, optional, tag = "8")]
    pub capabilities: Option<UnityRlCapabilitiesProto>,
}

/// What the agents of a behaviour can do.
#[derive(Clone, PartialEq, Eq, Hash, prost::Message)]
pub struct BrainParametersProto {
    /// How many continuous numbers, or how many choices each discrete one has; for clients before 1.3 of the protocol.
    #[prost(int32, repeated, tag = "3")]
    pub vector_action_size: Vec<i32>,
    /// The numbers in words.
    #[prost(string, repeated, tag = "5")]
    pub vector_action_descriptions: Vec<String>,
    /// Which kind of numbers.
    #[prost(enumeration = "SpaceTypeProto", tag = "6")]
    pub vector_action_space_type: i32,
    /// The behaviour's name.
    #[prost(string, tag = "7")]
    pub brain_name: String,
    /// Whether Python says what its agents do.
    #[prost(bool, tag = "8")]
    pub is_training: bool,
    /// The same for clients from 1.3 of the protocol on.
    #[prost(message, optional, tag = "9")]
    pub action_spec: Option<ActionSpecProto>,
}

/// An action as clients from 1.3 of the protocol on see it.
#[derive(Clone, PartialEq, Eq, Hash, prost::Message)]
pub struct ActionSpecProto {
    /// How many continuous numbers.
    #[prost(int32, tag = "1")]
    pub num_continuous_actions: i32,
    /// How many discrete ones.
    #[prost(int32, tag = "2")]
    pub num_discrete_actions: i32,
    /// How many choices each discrete one has.
    #[prost(int32, repeated, tag = "3")]
    pub discrete_branch_sizes: Vec<i32>,
    /// The numbers in words.
    #[prost(string, repeated, tag = "4")]
    pub action_descriptions: Vec<String>,
}

/// What happened.
#[derive(Clone, PartialEq, prost::Message)]
pub struct UnityRlOutputProto {
    /// Behaviours by name.
    #[prost(btree_map = "string, message", tag = "2")]
    pub agent_infos: BTreeMap<String, ListAgentInfoProto>,
    /// Messages beside: identifier, length and bytes of each, one after the other.
    #[prost(bytes = "vec", tag = "3")]
    pub side_channel: Vec<u8>,
}

/// The agents of one behaviour.
#[derive(Clone, PartialEq, prost::Message)]
pub struct ListAgentInfoProto {
    /// An entry for each agent.
    #[prost(message, repeated, tag = "1")]
    pub value: Vec<AgentInfoProto>,
}

/// What happened to one agent, and what it sees.
#[derive(Clone, PartialEq, prost::Message)]
pub struct AgentInfoProto {
    /// What the step paid.
    #[prost(float, tag = "7")]
    pub reward: f32,
    /// Whether its episode is over.
    #[prost(bool, tag = "8")]
    pub done: bool,
    /// Whether it was cut off.
    #[prost(bool, tag = "9")]
    pub max_step_reached: bool,
    /// The agent's number, a new one for each episode.
    #[prost(int32, tag = "10")]
    pub id: i32,
    /// What it sees.
    #[prost(message, repeated, tag = "13")]
    pub observations: Vec<ObservationProto>,
}

/// Kinds of actions.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash, PartialOrd, Ord, prost::Enumeration)]
#[repr(i32)]
pub enum SpaceTypeProto {
    /// Choices.
    Discrete = 0,
    /// Numbers.
    Continuous = 1,
}
