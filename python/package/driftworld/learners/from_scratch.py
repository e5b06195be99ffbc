"""From scratch: a new network for every task, so that nothing carries over.

Its learning curves are the reference for forward transfer, and its forgetting is complete by construction.

Known traps: a task that occurs again is learned again from scratch; each visit draws new weights. Lifetimes with
different orders see the same initial weights at the same *position*, not for the same task.
"""

from __future__ import annotations

from driftworld.learners.ppo import PPO


class FromScratch(PPO):
    """PPO with a new network and optimiser for every task.

    Arguments as for :class:`PPO`; ``borders`` is ``"labels"`` by default.
    """

    name = "from_scratch"
    own_borders = "labels"

    def begin_task(self, label: str | None) -> None:
        """Draws a new network; the first task keeps PPO's."""
        if self.tasks > 1:
            self.network.load_state_dict(self.fresh_network(self.tasks).state_dict())
            self.reset_optimizer()
