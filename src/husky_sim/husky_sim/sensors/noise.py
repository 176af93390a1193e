# Copyright 2026 The Husky Playpen Lab authors
# SPDX-License-Identifier: Apache-2.0
"""
Noise of sensors: white noise and a slow drift, from a seed.

The drift is a Gauss-Markov process, as that of the Gazebo plugins which the original uses: it
keeps its deviation, and forgets its value within an hour.
"""

import math

from husky_course.frames import Array
import numpy as np

_DRIFT_FREQUENCY_HZ = 1.0 / 3600.0


class Noise:
    """
    Independent noise on some values.

    :param deviation: of the white noise, and of the drift.
    :param seed: numbers that together make this noise differ from every other.
    """

    def __init__(self, values: int, *, deviation: float, drift: float, seed: list[int]) -> None:
        self._values = values
        self._deviation = deviation
        self._drift_deviation = drift
        self._seed = seed
        self._normals = np.zeros((2, values))
        self.reset()

    def reset(self) -> None:
        """Begin the same sequence again."""
        self._random = np.random.Generator(np.random.PCG64(self._seed))
        self._drift = self._drift_deviation * self._random.standard_normal(self._values)

    def sample(self, period_sec: float) -> Array:
        """Return the errors of a sample, a period after the one before."""
        drifts, whites = self._random.standard_normal(out=self._normals)
        if self._drift_deviation == 0.0:  # what is drawn stays the same for the same seed
            return self._deviation * whites
        kept = math.exp(-period_sec * _DRIFT_FREQUENCY_HZ)
        fresh = self._drift_deviation * math.sqrt(1.0 - kept * kept)
        self._drift = kept * self._drift + fresh * drifts
        return self._drift + self._deviation * whites
