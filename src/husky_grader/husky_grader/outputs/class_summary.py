# Copyright 2026 The Husky Playpen Lab authors
# SPDX-License-Identifier: Apache-2.0
"""What a class got: points, steps, and the mistakes that several students have made."""

from collections.abc import Iterator, Sequence
from dataclasses import dataclass
import re
from statistics import fmean, quantiles
from typing import NamedTuple

from husky_grader.graded import DRIVE_PASSED, Graded, RUN_WITH, StepGrade

MOST_SENTENCES = 3  # each, on steps and on mistakes, to talk about
BETWEEN = '; '  # the reasons of a step

_QUOTED = re.compile(r"'[^']*'|\"[^\"]*\"")
_WORD = re.compile(r'[\w./-]+')


@dataclass(frozen=True)
class StepSummary:
    """How a class did in one step."""

    name: str
    most: float
    mean: float  # points
    full: int  # students with all of its points
    zero: int  # with none
    lost: float  # points, by all together


@dataclass(frozen=True)
class Mistake:
    """What several students have met in a step."""

    step: str
    text: str  # as the first of them was told it
    who: Sequence[Graded]
    lost: float  # points, by all together


@dataclass(frozen=True)
class ClassSummary:
    """
    What a class got.

    :param quartiles: of the points of those who were graded, the median in the middle; empty
        without any.
    :param mistakes: those that several have made, the most frequent first.
    :param talk_about: what cost the class most, in a sentence each.
    """

    graded: Sequence[Graded]
    refused: Sequence[Graded]
    most: float
    quartiles: Sequence[float]
    steps: Sequence[StepSummary]
    mistakes: Sequence[Mistake]
    talk_about: Sequence[str]


def summarize(everyone: Sequence[Graded]) -> ClassSummary:
    graded = [one for one in everyone if not one.refused]
    points = [one.points for one in graded]
    steps, mistakes = _steps(graded), _mistakes(graded)
    return ClassSummary(
        graded=graded,
        refused=[one for one in everyone if one.refused],
        most=max((one.most for one in everyone), default=0.0),
        quartiles=quantiles(points, method='inclusive') if len(points) > 1 else points * 3,
        steps=steps,
        mistakes=mistakes,
        talk_about=[*_about_steps(steps, len(graded)), *_about_mistakes(mistakes)],
    )


def as_points(points: float) -> str:
    """
    Return points as a person writes them.

    >>> as_points(12.0), as_points(12.34)
    ('12', '12.3')
    """
    return f'{points:.1f}'.removesuffix('.0')


def students(count: int) -> str:
    return '1 student' if count == 1 else f'{count} students'


def _steps(graded: Sequence[Graded]) -> list[StepSummary]:
    by_name: dict[str, list[StepGrade]] = {}
    for one in graded:
        for step in one.steps:
            by_name.setdefault(step.name, []).append(step)
    return [
        StepSummary(
            name,
            most=steps[0].most,
            mean=fmean(step.points for step in steps),
            full=sum(step.is_full for step in steps),
            zero=sum(step.points <= 0.0 < step.most for step in steps),
            lost=sum(step.most - step.points for step in steps),
        )
        for name, steps in by_name.items()
    ]


def _mistakes(graded: Sequence[Graded]) -> list[Mistake]:
    """
    Return the mistakes that several have made.

    Reasons are the same whatever names and numbers stand in them. Of a step with several reasons,
    each has cost the same part. Reasons that all the same students have met are one mistake: often
    one of them says what to do about another.
    """
    met: dict[tuple[str, str], dict[int, _Met]] = {}
    for number, one in enumerate(graded):
        for step, reason, lost in _reasons(one):
            by_student = met.setdefault((step, without_names(reason)), {})
            before = by_student.setdefault(number, _Met(reason, 0.0))
            by_student[number] = _Met(before.reason, before.lost + lost)
    together: dict[tuple[str, tuple[int, ...]], list[_Met]] = {}
    for (step, _), by_student in met.items():
        if len(by_student) > 1:
            first = next(iter(by_student.values())).reason
            lost = sum(each.lost for each in by_student.values())
            together.setdefault((step, tuple(by_student)), []).append(_Met(first, lost))
    found = [
        Mistake(
            step,
            text=BETWEEN.join(each.reason for each in same),
            who=[graded[number] for number in numbers],
            lost=sum(each.lost for each in same),
        )
        for (step, numbers), same in together.items()
    ]
    return sorted(found, key=lambda mistake: (-len(mistake.who), -mistake.lost))


class _Met(NamedTuple):
    reason: str
    lost: float


def _reasons(one: Graded) -> Iterator[tuple[str, str, float]]:
    """Yield step, reason, and the points that it has cost."""
    for step in one.steps:
        if not step.is_full:
            told = step.why.split(BETWEEN)
            reasons = [
                each
                for each in told
                if not (each.startswith(RUN_WITH) or each.endswith(DRIVE_PASSED))
            ]
            for reason in reasons:
                yield step.name, reason, (step.most - step.points) / len(reasons)


def without_names(reason: str) -> str:
    """
    Return a reason with dots for what differs from student to student: names and numbers.

    >>> without_names("talker.py line 12: name 'x' is not defined")
    '... line ...: name ... is not defined'
    """

    def shown(word: re.Match[str]) -> str:
        text = word[0]
        differs = '/' in text or '_' in text or '.py' in text or any(map(str.isdigit, text))
        return '...' if differs else text

    return _WORD.sub(shown, _QUOTED.sub('...', reason))


def _about_steps(steps: Sequence[StepSummary], count: int) -> Iterator[str]:
    costly = sorted((step for step in steps if step.lost > 0.0), key=lambda step: -step.lost)
    for step in costly[:MOST_SENTENCES]:
        yield (
            f'{step.name} cost the class {as_points(step.lost)} of {as_points(step.most * count)} '
            f'points: {students(step.zero)} got nothing for it, {step.full} got all.'
        )


def _about_mistakes(mistakes: Sequence[Mistake]) -> Iterator[str]:
    for mistake in sorted(mistakes, key=lambda mistake: -mistake.lost)[:MOST_SENTENCES]:
        yield (
            f'{students(len(mistake.who))} lost {as_points(mistake.lost)} points in '
            f'{mistake.step} by this: {mistake.text}'
        )
