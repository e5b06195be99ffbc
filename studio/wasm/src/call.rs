//! [`Call`]: the calls that a session answers. `studio/src/engine.ts` documents each of them and its result.

use driftworld::env::Action;
use driftworld::similarity::Method;
use driftworld::spec::{By, Modality, Style};
use serde::{Deserialize, Serialize};

use crate::request::WorldRequest;

/// A call with its arguments. Files and new networks are passed as bytes; later calls refer to a network by its number.
#[derive(Debug, Deserialize)]
#[serde(tag = "call", rename_all = "snake_case", deny_unknown_fields)]
pub(crate) enum Call {
    Version,
    Tasks,
    Task {
        task: String,
    },
    Validate {
        text: String,
    },
    Schema {
        kind: String,
    },
    Sample {
        request: WorldRequest,
    },
    Open {
        request: WorldRequest,
        #[serde(default)]
        style: Option<Style>,
        #[serde(default)]
        size: Option<[u32; 2]>,
    },
    Step {
        episode: u32,
        steps: Vec<StepInput>,
    },
    Choose {
        episode: u32,
        agent: AgentName,
    },
    Act {
        episode: u32,
        agent: AgentName,
    },
    Seek {
        episode: u32,
        step: usize,
    },
    Now {
        episode: u32,
    },
    Frame {
        episode: u32,
        view: View,
        modality: Modality,
        #[serde(default)]
        size: Option<[u32; 2]>,
    },
    Map {
        episode: u32,
    },
    Actions {
        episode: u32,
    },
    Recording {
        episode: u32,
    },
    Close {
        episode: u32,
    },
    /// Registers a network, passed as bytes.
    Network,
    Run {
        request: WorldRequest,
        agent: AgentName,
        steps: u32,
    },
    Measures,
    Distance {
        a: WorldRequest,
        b: WorldRequest,
        #[serde(default)]
        by: Option<By>,
        #[serde(default)]
        worlds: Option<u64>,
        #[serde(default)]
        seed: u64,
        #[serde(default)]
        as_worlds: bool,
    },
    Elements {
        task: String,
        a: String,
        b: String,
        worlds: u64,
        seed: u64,
    },
    Matrix(Selection),
    Order {
        #[serde(flatten)]
        selection: Selection,
        #[serde(default)]
        method: Option<String>,
        #[serde(default)]
        start: Option<String>,
        #[serde(default)]
        seed: u64,
    },
    Log {
        files: Vec<File>,
    },
    OpenLogged {
        experience: u64,
        #[serde(default)]
        style: Option<Style>,
        #[serde(default)]
        size: Option<[u32; 2]>,
    },
    EncodeLink {
        link: Link,
    },
    DecodeLink {
        fragment: String,
    },
}

/// Some or all variants of a task, and the measure that compares them.
#[derive(Debug, Deserialize)]
pub(crate) struct Selection {
    pub(crate) task: String,
    #[serde(default)]
    pub(crate) variants: Option<Vec<String>>,
    #[serde(default)]
    pub(crate) by: Option<By>,
    #[serde(default)]
    pub(crate) worlds: Option<u64>,
}

/// A file of a log: the next `length` of the bytes passed with the call.
#[derive(Debug, Deserialize)]
pub(crate) struct File {
    pub(crate) path: String,
    pub(crate) length: usize,
}

/// An episode that fits into a link.
#[derive(Debug, Deserialize, Serialize)]
pub(crate) struct Link {
    pub(crate) request: WorldRequest,
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub(crate) looks: Option<Style>,
    pub(crate) actions: Vec<Action>,
}

/// The input of a step.
#[derive(Clone, Copy, Debug, Deserialize)]
#[serde(untagged)]
pub(crate) enum StepInput {
    Action(Action),
    /// Input from keys, with `ahead` and `turn` in −1..=1.
    Keys {
        ahead: f64,
        turn: f64,
        interact: bool,
    },
}

/// The agent that acts. A network is identified by the number that [`Call::Network`] returned.
#[derive(Clone, Copy, Debug, Deserialize, PartialEq, Eq)]
#[serde(rename_all = "snake_case")]
pub(crate) enum AgentName {
    Planner,
    Random,
    Still,
    Network(usize),
}

/// The viewpoint of a picture.
#[derive(Clone, Copy, Debug, Deserialize, PartialEq, Eq)]
#[serde(rename_all = "lowercase")]
pub(crate) enum View {
    Agent,
    Above,
}

/// Parses the name of an ordering method.
pub(crate) fn method(name: Option<&str>) -> Result<Option<Method>, crate::fault::Fault> {
    Ok(name.map(str::parse).transpose()?)
}
