//! The typed documents of Driftworld: worlds, task specs with their variants, scenarios, and their JSON Schemas.
//!
//! Documents are read, checked and returned as plain values. Start with [`World`]. Units everywhere are SI; headings are degrees
//! clockwise from +y; colours are sRGB in 0..1; x is east, y north, z up.

mod classes;
mod color;
mod describe;
mod distribution;
mod document;
mod element;
mod error;
mod l2explorer;
mod layout;
mod limits;
pub mod maps;
mod names;
mod oklab;
mod philox;
pub mod reference;
mod scenario;
pub mod schema;
mod serde_defaults;
mod suggest;
mod task;
#[cfg(test)]
#[path = "../../tests/tier.rs"]
mod tier;
mod value;
mod version;
mod warning;
mod world;

pub use classes::{Classes, Models};
pub use color::Color;
pub use distribution::{
    Case, CellKind, CellRoom, Channel, ChannelChance, ChannelSpread, Channels, Distribution, Moments, Number, Order,
    ParamRef, Spread, Turns,
};
pub use element::Element;
pub use error::{MAX_PROBLEMS, Problem, SpecError};
pub use layout::{
    Circle, Doorway, Layout, LayoutWall, Legend, MAX_CELLS, MAX_LAYOUT_SIDE, Maze, Plan, PlanCell, PlanWall, RoomDoors,
    Rooms,
};
pub use limits::{
    MAX_BYTES, MAX_DEPTH, MAX_KEY_BYTES, MAX_OBJECTS, MAX_SCENARIO_VALUES, MAX_SEED, MAX_TASK_DEPTH, MAX_VALUES,
    MAX_WORLD_VALUES,
};
pub use names::sound_name;
pub use oklab::{Oklab, linear_from_srgb, srgb_from_linear};
pub use philox::philox;
pub use scenario::{
    Block, BlockKind, BlockMix, DriftSchedule, DriftSwitch, MAX_EXPERIENCES, Phase, ProvenVariant, Regime, RegimeDrift,
    Scenario, ScenarioComplexity, ScenarioDifficulty, ScenarioForm, ScenarioProof, TaskLabel,
};
pub use suggest::{did_you_mean, nearest};
pub use task::{
    By, Choices, Compare, Count, DEFAULT_VARIANT, Domain, ElementWeights, Facing, Group, Hole, KeepOut, MeasureName,
    Parameter, PlacedGroup, Readers, Requirement, Resolved, Role, Source, Spacing, Sweep, TaskSpec, Template, Variant,
    VariantSpec,
};
pub use value::{ParameterType, Value};
pub use version::{SCENARIO_VERSION, TASK_VERSION, WORLD_VERSION};
pub use warning::Warning;
pub use world::{
    ActionModel, ActionSpace, AgentParams, Compared, Comparison, Covering, Delivery, Disc, Door, Enclosure,
    EndCondition, Energy, EnvironmentParams, Field, FieldPlace, GameMode, ImageParams, LastEvent, LeafTexts, Looks,
    MAX_POINTS, Modality, Model, MotionModel, Object, ObjectProgress, Origin, Portable, Progress, Pushable,
    RailsProgress, Region, Respawn, Rules, Shaping, StateFeature, Stimulus, Style, Surface, Switch, SwitchAction,
    Trigger, Wall, World, WorldDraft, Zone, ZoneEnd,
};
