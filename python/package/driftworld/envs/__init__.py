"""Gymnasium environments: one world at a time, or many at once.

The simulation runs in Rust; this package adds the spaces, the infos and Gymnasium's rules.
"""

from __future__ import annotations

from driftworld.envs.origin import spread_seeds
from driftworld.envs.registration import ENV_IDS, register_envs
from driftworld.envs.single import DriftworldEnv
from driftworld.envs.vector import DriftworldVectorEnv

__all__ = ["ENV_IDS", "DriftworldEnv", "DriftworldVectorEnv", "register_envs", "spread_seeds"]
