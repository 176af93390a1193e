# Copyright 2026 The Husky Playpen Lab authors
# SPDX-License-Identifier: Apache-2.0
"""
A Kalman filter that takes one number at a time.

In floats of Python: they give the same bits on every CPU, where a product of numpy's matrices
chooses its code by the CPU; and for so few states they are faster.
"""

from collections.abc import Mapping, Sequence
from operator import mul, sub

Terms = Sequence[tuple[int, float]]
"""A weighted sum: which values or rows, and the weight of each."""


class Kalman:
    """Estimates some values, which may be changed between two calls."""

    def __init__(self, values: Sequence[float], deviations: Sequence[float]) -> None:
        """Begin with what is known before, and its standard deviations."""
        self.values = [0.0] * len(values)
        # Row after row in one list, for which `map` computes in half of the time of nested ones.
        self._covariance = [0.0] * len(values) ** 2
        for i, (value, deviation) in enumerate(zip(values, deviations, strict=True)):
            self.know(i, value, deviation)

    def know(self, i: int, value: float, deviation: float) -> None:
        """Set a value that is known otherwise, independently of the others."""
        size = len(self.values)
        self.values[i] = value
        self._put(i, [0.0] * size)
        self._covariance[i * size + i] = deviation * deviation

    def grow(
        self,
        deviations: Sequence[float],
        period_sec: float,
        transition: Mapping[int, Terms] | None = None,
    ) -> None:
        """
        Make everything less certain.

        :param deviations: by how much in a second.
        :param transition: the values that others pass into, each as a sum of those before.
        """
        if transition:
            mixed = {row: self._sum(terms) for row, terms in transition.items()}
            for i, row in mixed.items():
                # As the covariance is symmetric, only where both mix is there more to do.
                both = [(j, _weighted(row, terms)) for j, terms in transition.items()]
                for j, each in both:
                    row[j] = each
                self._put(i, row)
        for i, deviation in enumerate(deviations):
            self._covariance[i * len(deviations) + i] += deviation * deviation * period_sec

    def correct(self, terms: Terms, measured: float, deviation: float) -> None:
        """Take a measurement of a sum of the values."""
        seen, values = self._sum(terms), self.values
        error = measured - _weighted(values, terms)
        variance = deviation * deviation + _weighted(seen, terms)
        gain = [each / variance for each in seen]
        self.values = [value + error * by for value, by in zip(values, gain, strict=True)]
        of_rows = [by for by in gain for _ in seen]
        less = map(mul, of_rows, seen * len(seen))
        self._covariance = list(map(sub, self._covariance, less))

    def _put(self, i: int, row: list[float]) -> None:
        """Set a row of the covariance, and the column that is the same."""
        size = len(row)
        self._covariance[i * size : i * size + size] = row
        self._covariance[i::size] = row

    def _sum(self, terms: Terms) -> list[float]:
        """Return the weighted sum of rows of the covariance."""
        size = len(self.values)
        (first, weight), *others = terms
        total = [weight * each for each in self._covariance[first * size : first * size + size]]
        for i, weight in others:
            row = self._covariance[i * size : i * size + size]
            total = [before + weight * each for before, each in zip(total, row, strict=True)]
        return total


def _weighted(values: Sequence[float], terms: Terms) -> float:
    total = 0.0  # not `sum`, which rounds otherwise from Python 3.12 on
    for i, weight in terms:
        total += weight * values[i]
    return total
