"""A helper for comparisons with Gymnasium's own vector environments."""

from __future__ import annotations

from typing import Any

import driftworld


def spread(envs: Any) -> Any:
    """Makes resets with one seed derive the seeds of environments as Driftworld does; Gymnasium adds 0, 1, 2 and so on."""
    reset = envs.reset

    def reset_spread(*, seed: Any = None, options: dict[str, Any] | None = None) -> Any:
        if isinstance(seed, int):
            seed = driftworld.spread_seeds(seed, envs.num_envs)
        return reset(seed=seed, options=options)

    envs.reset = reset_spread
    return envs
