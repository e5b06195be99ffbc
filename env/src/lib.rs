//! Runs a [`World`](driftworld_spec::World): physics, rewards and interactions, and cameras that need no GPU. [`Environment`]
//! steps a world and renders its agent's view; [`Scene`], [`Camera`] and [`CpuRenderer`] render any other view of it. Units are
//! SI; x is east, y north, z up; headings are degrees clockwise from +y. This crate reads no files and samples no worlds.

mod abstraction;
mod agents;
mod assets;
mod batch;
mod behavior;
mod camera;
mod channel;
mod error;
mod experiment;
mod ground;
mod looks;
mod photograph;
mod polygon;
mod prefetch;
mod recording;
mod render;
mod scene;
mod sim;
#[cfg(test)]
#[path = "../../tests/tier.rs"]
mod tier;
mod vector;
mod wall_tops;

pub use abstraction::{
    Abstraction, MAX_ABSTRACT_STATES, MAX_MACRO_SECONDS, NUM_HEADINGS, NUM_MACRO_ACTIONS, StateGrid, WorldAbstraction,
};
pub use agents::{Agent, Label, NetworkAgent, OnRailsAgent, RandomAgent, SarsaAgent, ScriptedAgent, StillAgent};
pub use assets::{
    Asset, Catalogue, ColliderKind, ColliderShape, FIRST_LIBRARY_CLASS, Library, LibraryModel, MAX_LIBRARY_MODELS,
    MAX_MODEL_LEVELS, MAX_MODEL_PARTS, MAX_MODEL_REACH, MAX_MODEL_TRIANGLES, MAX_MODEL_VERTICES, MAX_NAME_BYTES, Mesh,
    Paint, Part, UNKNOWN_CLASS, asset, asset_in, classes, model_names,
};
#[cfg(feature = "gltf")]
pub use assets::{
    ImportOptions, ImportSize, ImportWarning, Imported, MAX_IMPORT_BYTES, MAX_IMPORT_DEPTH, MAX_IMPORT_NODES,
    MAX_TEXTURE_SIDE, ReadBeside,
};
pub use batch::{
    Autoreset, Batch, BatchOptions, Episode, GoOn, ImageLayout, Images, MAX_BATCH_BYTES, MAX_ENVS, Outputs, WorldSource,
};
pub use behavior::{ExpertRun, Expertise, MAX_EXPERT_STEPS};
pub use camera::Camera;
pub use channel::{Category, Channel, Channels, Level, MAX_MESSAGE_BYTES, Outgoing, Received, Screenshot};
pub use error::EnvError;
pub use experiment::{Experiment, Findings, MAX_EXPERIMENT_STEPS, Policy, Proof, Witness};
pub use photograph::{MAX_PHOTOGRAPHS, Photograph, Studio};
pub use recording::{
    Edit, EpisodeOrigin, MAX_RECORDED_STEPS, MAX_RECORDING_LINE, RECORDING_FORMAT, RecordedEpisode, Recorder,
    Recording, RecordingLines, RecordingMark, RecordingReader, Replay,
};
#[cfg(feature = "gpu")]
pub use render::GpuRenderer;
pub use render::{
    AdapterReport, CATEGORY_BUILDING, CATEGORY_MAP, CATEGORY_NEGATIVE, CATEGORY_NEUTRAL, CATEGORY_POSITIVE,
    CATEGORY_SKY, CpuRenderer, DepthForm, FAR_DEPTH, Frame, Image, Picture, Renderer, RendererKind, RendererReport,
    Target, category_color, depth_to_gray, top_down, top_down_scale, top_down_with_way,
};
pub use scene::{Item, Light, Scene, WallPanel};
pub use sim::{
    Action, AgentState, Effect, EndedBy, Environment, Event, ObjectState, Obstacle, Snapshot, Step, Warning,
};
