# Copyright 2026 The Husky Playpen Lab authors
# SPDX-License-Identifier: Apache-2.0
"""
A Kalman filter that takes one number at a time.

In floats of Python: they give the same bits on every CPU, where a product of numpy's matrices
chooses its code by the CPU; and for so few states they are faster.
"""

from collections.abc import Mapping, Sequence

Terms = Sequence[tuple[int, float]]
"""A weighted sum: which values or rows, and the weight of each."""


class Kalman:
    """Estimates some values; `values` and `covariance` may be changed between two calls."""

    def __init__(self, values: Sequence[float], deviations: Sequence[float]) -> None:
        """Begin with what is known before, and its standard deviations."""
        self.values = list(values)
        self.covariance = [[0.0] * len(self.values) for _ in self.values]
        for i, deviation in enumerate(deviations):
            self.covariance[i][i] = deviation * deviation

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
        covariance = self.covariance
        if transition:
            mixed = {row: self._sum(terms) for row, terms in transition.items()}
            for i, row in mixed.items():
                # As the covariance is symmetric, only where both mix is there more to do.
                both = [(j, _weighted(row, terms)) for j, terms in transition.items()]
                for j, each in both:
                    row[j] = each
                covariance[i] = row
                for other, each in zip(covariance, row, strict=True):
                    other[i] = each
        for i, deviation in enumerate(deviations):
            covariance[i][i] += deviation * deviation * period_sec

    def correct(self, terms: Terms, measured: float, deviation: float) -> None:
        """Take a measurement of a sum of the values."""
        seen, values = self._sum(terms), self.values
        error = measured - _weighted(values, terms)
        variance = deviation * deviation + _weighted(seen, terms)
        gain = [each / variance for each in seen]
        self.values = [value + error * by for value, by in zip(values, gain, strict=True)]
        self.covariance = [
            [each - by * other for each, other in zip(row, seen, strict=True)]
            for row, by in zip(self.covariance, gain, strict=True)
        ]

    def _sum(self, terms: Terms) -> list[float]:
        """Return the weighted sum of rows of the covariance."""
        (first, weight), *others = terms
        total = [weight * each for each in self.covariance[first]]
        for i, weight in others:
            row = self.covariance[i]
            total = [before + weight * each for before, each in zip(total, row, strict=True)]
        return total


def _weighted(values: Sequence[float], terms: Terms) -> float:
    total = 0.0  # not `sum`, which rounds otherwise from Python 3.12 on
    for i, weight in terms:
        total += weight * values[i]
    return total
