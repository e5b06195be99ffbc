"""Gymnasium's own vector environments, for comparison with Driftworld's."""

from __future__ import annotations

from typing import Any

import driftworld


def spread(envs: Any) -> Any:
    """Makes a reset with one seed spread it as Driftworld does; Gymnasium's own environments add 0, 1, 2 and so on."""
    reset = envs.reset

    def reset_spread(*, seed: Any = None, options: dict[str, Any] | None = None) -> Any:
        if isinstance(seed, int):
            seed = driftworld.spread_seeds(seed, envs.num_envs)
        return reset(seed=seed, options=options)

    envs.reset = reset_spread
    return envs
