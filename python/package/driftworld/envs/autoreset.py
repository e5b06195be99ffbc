"""``AutoresetMode``: Gymnasium's own, or one with the same names for Gymnasium 1.0, which lacks it."""

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
            """When the next episode starts after one has ended."""

            NEXT_STEP = "NextStep"
            SAME_STEP = "SameStep"
            DISABLED = "Disabled"


def autoreset_mode_of(mode: Any) -> AutoresetMode:
    """The mode for a name (``next_step``, ``same_step`` or ``disabled``) or for Gymnasium's value of it.

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
