"""A lifetime with an agent that learns: which turn paid most so far. What it has learned depends on every step, and is saved."""

import json
import random
import sys
from pathlib import Path

import driftworld
import numpy as np


class Learner:
    """Keeps a value for each of a few actions, and mostly takes the best."""

    name = "learner"

    def __init__(self):
        self.values = [0.0] * 5
        self.chance = random.Random(0)
        self.frozen = False
        self.last = 0

    def begin(self, label, seed):
        self.chance = random.Random(seed)

    def freeze(self, frozen):
        self.frozen = frozen

    def act(self, observation, info):
        del observation, info
        if self.chance.random() < 0.3:
            self.last = self.chance.randrange(5)
        else:
            self.last = max(range(5), key=self.values.__getitem__)
        return np.array([1.0, 0.0, (self.last - 2) / 2], dtype=np.float32)[: self.width]

    def learn(self, transition):
        self.values[self.last] += 0.1 * (transition.reward - 0.001 * self.last - self.values[self.last])

    def save(self, path):
        Path(path).write_text(json.dumps(self.values))

    def load(self, path):
        self.values = json.loads(Path(path).read_text())


scenario, log = sys.argv[1:]
agent = Learner()
curriculum = driftworld.Curriculum.load(scenario)
agent.width = 3
curriculum.run(agent, log=log, resume=True, modalities=["state"])
