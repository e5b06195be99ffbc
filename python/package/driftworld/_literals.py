"""Literal types for options with a closed set of values, so that type checkers catch misspellings.

Tests check that each type lists exactly the accepted values.
"""

from __future__ import annotations

from typing import Literal, TypeAlias

# -- environments ------------------------------------------------------------------------------------------------------
ImageKind: TypeAlias = Literal["rgb", "depth", "segmentation", "class", "instance"]
Modality: TypeAlias = Literal["rgb", "depth", "segmentation", "class", "instance", "state"]
DepthForm: TypeAlias = Literal["uint8", "uint16", "float32"]
ActionsName: TypeAlias = Literal["task", "normalized", "continuous", "discrete"]
RendererName: TypeAlias = Literal["cpu", "gpu", "auto"]
TaskLabel: TypeAlias = Literal["none", "info", "observation"]
InfoFor: TypeAlias = Literal["agent", "full", "none"]
CameraName: TypeAlias = Literal["agent", "above", "both"]
FilmModality: TypeAlias = Literal["rgb", "depth", "segmentation"]
RenderMode: TypeAlias = Literal["human", "rgb_array"]
AutoresetName: TypeAlias = Literal["next_step", "same_step", "disabled"]

# -- documents and distances -------------------------------------------------------------------------------------------
DocumentKind: TypeAlias = Literal["task", "world", "scenario", "maps", "l2explorer-world", "l2explorer-scenario"]
ComparedBy: TypeAlias = Literal[
    "parameters",
    "worlds",
    "pictures",
    "pictures:whole",
    "pictures:structure",
    "occupancy",
    "occupancy:jaccard",
    "occupancy:hausdorff",
    "occupancy:chamfer",
    "placements",
    "objects",
    "objects:counts",
    "colors",
    "colors:srgb",
    "colors:cie76",
    "colors:ciede2000",
    "colors:hyab",
    "rewards",
    "dynamics",
    "dynamics:bisimulation",
    "behavior",
    "behavior:success",
]
Scale: TypeAlias = Literal["units", "share"]
OrderMethod: TypeAlias = Literal[
    "nearest",
    "exact",
    "two-opt",
    "abrupt",
    "farthest",
    "random",
    "target-step",
    "gradual",
    "outward",
    "given",
]

# -- curricula ---------------------------------------------------------------------------------------------------------
Form: TypeAlias = Literal["condensed", "dispersed", "permuted", "alternating", "joint", "custom"]
Evaluate: TypeAlias = Literal["every", "ends"]
DesignOrder: TypeAlias = Literal["gradual", "outward", "abrupt", "path", "farthest", "named"]
Probe: TypeAlias = Literal["state", "action", "transition", "reward", "observation"]
WorldSplit: TypeAlias = Literal["validation", "test"]
BlockKind: TypeAlias = Literal["learning", "evaluation"]
Phase: TypeAlias = Literal["deployment", "pre_deployment"]

# -- logs and scores ---------------------------------------------------------------------------------------------------
BlockType: TypeAlias = Literal["train", "test"]
BlockSubtype: TypeAlias = Literal["wake", "sleep"]
Status: TypeAlias = Literal["complete", "incomplete"]
VariantMode: TypeAlias = Literal["aware", "agnostic"]
SteAveraging: TypeAlias = Literal["metrics", "time"]
Aggregation: TypeAlias = Literal["mean", "median"]
Maintenance: TypeAlias = Literal["mrlep", "mrtlp", "both"]
Transfer: TypeAlias = Literal["ratio", "contrast", "both"]
Normalization: TypeAlias = Literal["task", "run", "none"]
Smoothing: TypeAlias = Literal["flat", "hanning", "hamming", "bartlett", "blackman", "none"]
Resampling: TypeAlias = Literal["strata", "runs"]
PlotType: TypeAlias = Literal["all", "raw", "lb", "eb", "ste", "timeline"]
Unit: TypeAlias = Literal["exp_num", "steps"]
