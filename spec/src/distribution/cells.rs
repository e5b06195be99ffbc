//! Kinds and rooms of layout cells that a placement can request.

use schemars::JsonSchema;
use serde::{Deserialize, Serialize};

/// Which cells of a layout, by how many sides they can be left.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Serialize, Deserialize, JsonSchema)]
#[serde(rename_all = "snake_case")]
pub enum CellKind {
    /// Every cell.
    #[default]
    Any,
    /// Those that can be left by one side.
    DeadEnd,
    /// Those that can be left by two sides, corners too.
    Corridor,
    /// Those that can be left by three or four sides.
    Junction,
    /// No cells but the doorways between rooms. Objects stand in their middle, turned along the wall.
    Doorway,
}

impl CellKind {
    /// Whether a cell with `open_sides` open sides is of this kind.
    pub fn has(self, open_sides: u32) -> bool {
        match self {
            Self::Any => true,
            Self::DeadEnd => open_sides == 1,
            Self::Corridor => open_sides == 2,
            Self::Junction => open_sides > 2,
            Self::Doorway => false,
        }
    }

    /// The plural for messages.
    pub fn describe(self) -> &'static str {
        match self {
            Self::Any => "cells",
            Self::DeadEnd => "dead ends",
            Self::Corridor => "corridors",
            Self::Junction => "junctions",
            Self::Doorway => "doorways",
        }
    }
}

/// Which room of a layout, as seen from the agent's start.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Serialize, Deserialize, JsonSchema)]
#[serde(rename_all = "snake_case")]
pub enum CellRoom {
    /// Another room than that in which the agent starts.
    OtherThanAgent,
    /// The room in which the agent starts.
    SameAsAgent,
}
