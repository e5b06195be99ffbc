"""Fine-tuning: PPO that continues across tasks. It is the baseline of every table, in two rows.

``FineTuning`` ignores tasks: its weights and Adam's moments carry over every border. ``ResetOptimizer`` clears the
moments at borders. Both minimise the loss of the current task alone.

Known traps:

- Adam's moments from the last task affect the direction and size of the first steps in the next one (Asadi et al. 2023,
  arXiv:2306.17833). Compare a method that resets Adam with ``ResetOptimizer``; otherwise the benefit of the reset is
  credited to the method.
- *Joint training* is this learner in a curriculum of the form ``"joint"`` (``Curriculum.design(form="joint")``). It is
  an upper bound only where that has been shown: tasks that conflict and cannot be told apart have no common policy.
"""

from __future__ import annotations

from driftworld.learners.ppo import PPO


class FineTuning(PPO):
    """PPO that ignores tasks and keeps everything: network, optimiser and unfinished rollouts carry over.

    Arguments as for :class:`PPO`.
    """

    name = "finetuning"


class ResetOptimizer(PPO):
    """Fine-tuning with Adam's moments cleared at the end of each task.

    Arguments as for :class:`PPO`; ``borders`` is ``"labels"`` by default.
    """

    name = "finetuning_reset_optimizer"
    own_borders = "labels"

    def end_task(self, label: str | None) -> None:
        """Clears Adam's moments."""
        self.reset_optimizer()
