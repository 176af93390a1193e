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

from collections.abc import Mapping, Sequence
from dataclasses import dataclass, replace
import re

import yaml

from husky_grader.submission.limits import Refused
from husky_grader.submission.listing import Listing
from husky_grader.submission.submission import Submission

_METADATA = 'submission_metadata.yml'
_MOST_BYTES = 32_000_000  # of the metadata, which has the results of earlier gradings in it
_NULL = 'tag:yaml.org,2002:null'


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

    :raises Refused: when the file is too large or is not YAML.
    """
    data = listing.read(_METADATA, _MOST_BYTES + 1)
    if len(data) > _MOST_BYTES:
        raise Refused(f'larger than {_MOST_BYTES / 1e6:g} MB')
    try:
        # Only nodes: what Ruby writes may have tags that no Python class is for.
        root = yaml.compose(data, Loader=getattr(yaml, 'CSafeLoader', yaml.SafeLoader))
    except (yaml.YAMLError, RecursionError) as error:
        raise Refused(f'not valid YAML ({" ".join(str(error).split())})') from None
    return {
        folder: [
            _Submitter(*(_text(_pairs(each).get(key)) for key in (':name', ':sid', ':email')))
            for each in _items(_pairs(facts).get(':submitters'))
        ]
        for folder, facts in _pairs(root).items()
    }


def _pairs(node: yaml.Node | None) -> dict[str, yaml.Node]:
    if not isinstance(node, yaml.MappingNode):
        return {}
    return {_text(key): value for key, value in node.value}


def _items(node: yaml.Node | None) -> list[yaml.Node]:
    return list(node.value) if isinstance(node, yaml.SequenceNode) else []


def _text(node: yaml.Node | None) -> str:
    if not isinstance(node, yaml.ScalarNode) or node.tag == _NULL:
        return ''
    return str(node.value)
