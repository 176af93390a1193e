# Copyright 2026 The Husky Playpen Lab authors
# SPDX-License-Identifier: Apache-2.0
"""A Kalman filter that takes one number at a time."""

from collections.abc import Sequence

from husky_course.frames import Array
import numpy as np


class Kalman:
    """Estimates some values; `values` and `covariance` may be changed between two calls."""

    def __init__(self, values: Sequence[float], deviations: Sequence[float]) -> None:
        """Begin with what is known before, and its standard deviations."""
        self.values: Array = np.array(values)
        self.covariance: Array = np.diag(np.square(deviations))

    def grow(self, deviations: Array, period_sec: float, transition: Array | None = None) -> None:
        """
        Make everything less certain.

        :param deviations: by how much in a second.
        :param transition: how the errors of the values pass on to one another; by default not.
        """
        if transition is not None:
            self.covariance = transition.dot(self.covariance).dot(transition.T)
        self.covariance.flat[:: len(self.values) + 1] += deviations * deviations * period_sec

    def correct(self, terms: Array, measured: float, deviation: float) -> None:
        """Take a measurement of the sum of the values, each times its term."""
        seen = self.covariance.dot(terms)
        error = measured - float(terms.dot(self.values))
        gain = seen / (float(terms.dot(seen)) + deviation * deviation)
        self.values += gain * error
        self.covariance -= np.multiply.outer(gain, seen)
