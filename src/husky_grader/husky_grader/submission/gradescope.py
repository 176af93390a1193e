# Copyright 2026 The Husky Playpen Lab authors
# SPDX-License-Identifier: Apache-2.0
"""
What Gradescope gives for "Export Submissions" of a programming assignment.

A folder `assignment_NUMBER_export` has a folder `submission_NUMBER` for each student or group,
with the files as they were handed in (Gradescope has unpacked archives), and
`submission_metadata.yml`: under the name of each folder `:submitters:`, a list of `:name:`,
`:sid:` and `:email:`. Gradescope does not document the format; this is the shape of exports of
2023, and what programs read that others have published.
"""

from collections.abc import Iterator, Mapping, Sequence
from dataclasses import dataclass, replace
from itertools import islice
import re

import yaml

from husky_grader.submission.limits import Refused
from husky_grader.submission.listing import Listing
from husky_grader.submission.submission import Submission

_METADATA = 'submission_metadata.yml'
_MOST_BYTES = 32_000_000  # of the metadata, which has the results of earlier gradings in it
_LEAST_BYTES = 32  # of a submitter
_MOST_EVENTS = 1_000_000
_DEPTH = 4  # of a submitter: all folders, one of them, `:submitters:`, one of those
_DEEPEST = 100  # of what else is in it
_NULLS = ('', '~', 'null', 'Null', 'NULL')


@dataclass(frozen=True)
class _Submitter:
    name: str
    sid: str
    email: str


def gradescope_submissions(
    listing: Listing, tops: Mapping[str, Sequence[str]]
) -> list[Submission]:
    """
    Return the submissions of an export of Gradescope; none where it is not one.

    :param tops: the names directly in the export, and the files in each.
    """
    if _METADATA not in tops:
        return []
    try:
        metadata, unread = _read(listing), ''
    except Refused as error:
        metadata, unread = {}, f'without names: {_METADATA} is {error}'
    found = []
    for top, names in tops.items():
        if top != _METADATA:
            files = [(name, name.partition('/')[2] or name) for name in names]
            one = listing.submission(files, top)
            missing = unread or ('' if top in metadata else f'not in {_METADATA}')
            found.append(_with_names(one, top, metadata.get(top, ()), missing))
    return found


def _with_names(
    one: Submission, top: str, submitters: Sequence[_Submitter], missing: str
) -> Submission:
    number = re.search(r'\d{1,18}', top)
    return replace(
        one,
        lms='gradescope',
        user=','.join(each.sid or each.email for each in submitters),
        name=', '.join(each.name for each in submitters),
        emails=tuple(each.email for each in submitters),
        attempt=int(number[0]) if number else 0,
        notes=(missing,) if missing else (),
    )


def _read(listing: Listing) -> dict[str, list[_Submitter]]:
    """
    Return who handed in each folder.

    :raises Refused: when the file is too large, also by its aliases, or is not YAML.
    """
    data = listing.read(_METADATA, _MOST_BYTES + 1)
    if len(data) > _MOST_BYTES:
        raise Refused(f'larger than {_MOST_BYTES / 1e6:g} MB')
    # Only events: what Ruby writes may have tags that no Python class is for.
    events = yaml.parse(data, Loader=getattr(yaml, 'CSafeLoader', yaml.SafeLoader))
    try:
        root = _Builder(events).document()
    except (yaml.YAMLError, ValueError) as error:
        if isinstance(error, Refused):
            raise
        raise Refused(f'not valid YAML ({" ".join(str(error).split())})') from None
    submitters: dict[str, list[_Submitter]] = {}
    size, known = 0, dict[int, tuple[list[_Submitter], int]]()
    for folder, facts in _pairs(root).items():
        given = _pairs(facts).get(':submitters')
        if id(given) not in known:  # by aliases each folder may have the same list
            known[id(given)] = _submitters(_items(given), _MOST_BYTES - size)
        submitters[folder], more = known[id(given)]
        size += more
        if size > _MOST_BYTES:
            raise _too_large_with_aliases()
    return submitters


def _submitters(given: Sequence[object], most: int) -> tuple[list[_Submitter], int]:
    """
    Return the submitters in a list, and their size.

    :raises Refused: when that is above the most.
    """
    submitters, size = [], 0
    for each in given:
        words = [_text(_pairs(each).get(key)) for key in (':name', ':sid', ':email')]
        size += _LEAST_BYTES + sum(map(len, words))
        if size > most:  # by aliases it may have one many times
            raise _too_large_with_aliases()
        submitters.append(_Submitter(*words))
    return submitters, size


def _too_large_with_aliases() -> Refused:
    return Refused(f'larger than {_MOST_BYTES / 1e6:g} MB with its aliases written out')


class _Builder:
    """
    Makes texts, lists and dicts of the events of YAML, as deep as submitters stand.

    Students may have written the file: to compose it whole would cost stack for each level, and
    memory for each node.
    """

    def __init__(self, events: Iterator[yaml.Event]) -> None:
        self._events = islice(events, _MOST_EVENTS)
        self._anchored: dict[str, object] = {}

    def document(self) -> object:
        """
        Return the first document.

        :raises Refused: when the file is nested too deep or has too many parts.
        """
        for event in self._events:
            if not isinstance(event, (yaml.StreamStartEvent, yaml.DocumentStartEvent)):
                return self._value(event, 1)
        return None

    def _value(self, event: yaml.Event, depth: int) -> object:
        if isinstance(event, yaml.AliasEvent):
            return self._anchored.get(event.anchor or '')
        value: object = None
        if isinstance(event, yaml.ScalarEvent):
            value = '' if event.style is None and event.value in _NULLS else event.value
        elif isinstance(event, yaml.CollectionStartEvent):
            parts = self._parts(depth)
            if isinstance(event, yaml.SequenceStartEvent):
                value = parts
            else:
                value = {
                    _text(key): each for key, each in zip(parts[::2], parts[1::2], strict=True)
                }
        if isinstance(event, yaml.NodeEvent) and event.anchor is not None:
            self._anchored[event.anchor] = value
        return value

    def _parts(self, depth: int) -> list[object]:
        """Return what a collection holds; nothing of one that stands too deep."""
        parts: list[object] = []
        within = 0
        for event in self._events:
            if isinstance(event, yaml.CollectionEndEvent):
                if within == 0:
                    return parts
                within -= 1
            elif depth <= _DEPTH:
                parts.append(self._value(event, depth + 1))
            elif isinstance(event, yaml.CollectionStartEvent):
                within += 1
                if within > _DEEPEST:  # to parse it takes time by the square of its depth
                    raise Refused('nested too deep')
        raise Refused(f'of more than {_MOST_EVENTS} parts')


def _pairs(value: object) -> dict[str, object]:
    return value if isinstance(value, dict) else {}


def _items(value: object) -> list[object]:
    return value if isinstance(value, list) else []


def _text(value: object) -> str:
    return value if isinstance(value, str) else ''
