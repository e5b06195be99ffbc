"""``AutoresetMode``, Gymnasium's own or, for Gymnasium 1.0 that does not have it yet, one of the same names."""

from __future__ import annotations

from enum import Enum
from typing import TYPE_CHECKING, Any

if TYPE_CHECKING:
    from gymnasium.vector import AutoresetMode
else:
    try:
        from gymnasium.vector import AutoresetMode
    except ImportError:

        class AutoresetMode(Enum):
            """When an episode that has ended is followed by the next."""

            NEXT_STEP = "NextStep"
            SAME_STEP = "SameStep"
            DISABLED = "Disabled"


def autoreset_mode_of(mode: Any) -> AutoresetMode:
    """The mode of a name: ``next_step``, ``same_step`` or ``disabled``, or of Gymnasium's value for it.

    Raises:
        ValueError: For anything else.
    """
    if isinstance(mode, AutoresetMode):
        return mode
    for known in AutoresetMode:
        if mode in (known.name.lower(), known.value):
            return known
    raise ValueError(f"autoreset_mode: found {mode!r}, expected next_step, same_step or disabled")


__all__ = ["AutoresetMode", "autoreset_mode_of"]
