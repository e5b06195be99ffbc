"""Fine-tuning: PPO that goes on, whatever comes. The baseline of every table, in two rows.

``FineTuning`` does not know of tasks: its weights and Adam's moments go on over every border. ``ResetOptimizer`` clears the
moments at borders. Both minimise the loss of the present task alone.

Known traps:

- Moments of the last task point the first steps of the next one its way, and scale them by its gradients (Asadi et al. 2023,
  arXiv:2306.17833). A method that resets Adam is compared with ``ResetOptimizer``, or the reset is counted as its merit.
- *Joint training* is this learner in a curriculum of the form ``"joint"`` (``Curriculum.design(form="joint")``). It is an upper
  bound only where it was shown to be one: tasks that conflict and are not told apart have no common policy.
"""

from __future__ import annotations

from driftworld.learners.ppo import PPO


class FineTuning(PPO):
    """PPO that knows of no tasks and keeps everything: network, optimiser and unfinished rollouts go on. Arguments as :class:`PPO`."""

    name = "finetuning"


class ResetOptimizer(PPO):
    """Fine-tuning with Adam's moments cleared where a task ends. Arguments as :class:`PPO`; ``borders`` is ``"labels"`` by default."""

    name = "finetuning_reset_optimizer"
    own_borders = "labels"

    def end_task(self, label: str | None) -> None:
        """Clears Adam's moments."""
        self.reset_optimizer()
