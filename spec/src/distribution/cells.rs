//! Kinds and rooms of layout cells that a placement can request.

use schemars::JsonSchema;
use serde::{Deserialize, Serialize};

/// Selects cells of a layout by their number of open sides.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Serialize, Deserialize, JsonSchema)]
#[serde(rename_all = "snake_case")]
pub enum CellKind {
    /// Every cell.
    #[default]
    Any,
    /// Cells with one open side.
    DeadEnd,
    /// Cells with two open sides, including corners.
    Corridor,
    /// Cells with three or four open sides.
    Junction,
    /// Doorways between rooms, instead of cells. Objects are placed in the middle of a doorway and turned along the wall.
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

/// Selects rooms of a layout relative to the agent's start.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Serialize, Deserialize, JsonSchema)]
#[serde(rename_all = "snake_case")]
pub enum CellRoom {
    /// Any room except the one in which the agent starts.
    OtherThanAgent,
    /// The room in which the agent starts.
    SameAsAgent,
}
