# Copyright 2026 The Husky Playpen Lab authors
# SPDX-License-Identifier: Apache-2.0
"""
What Moodle gives for "Download all submissions".

Each student has `NAME_NUMBER_assignsubmission_PLUGIN`, as a folder or as the beginning of the
names of their files; up to Moodle 4.0 the folder ends in `_`. An underscore in a name becomes a
space. The number is that of the participant in the grading worksheet, of a group its id; those in
no group have none. Source: get_student_prefix and load_submissionplugin_filelist in
mod/assign/classes/downloader.php, github.com/moodle/moodle.
"""

from collections.abc import Iterator, Mapping, Sequence
from dataclasses import dataclass, field, replace

from husky_grader.folder_names import composed
from husky_grader.submission.kinds import without_ending
from husky_grader.submission.listing import Listing
from husky_grader.submission.submission import Submission

_MARK = '_assignsubmission_'


@dataclass
class _Handed:
    files: list[tuple[str, str]] = field(default_factory=list)
    others: list[tuple[str, str]] = field(default_factory=list)  # texts, comments


def moodle_submissions(listing: Listing, tops: Mapping[str, Sequence[str]]) -> list[Submission]:
    """
    Return the submissions of an export of Moodle; none where it is not one.

    :param tops: the names directly in the export, and the files in each.
    """
    handed: dict[tuple[str, str], _Handed] = {}
    found = []
    for top, names in tops.items():
        prefix, mark, rest = top.partition(_MARK)
        if not mark:
            found.append(_other(listing, top, names))
            continue
        prefix = composed(prefix)
        name, _, user = prefix.rpartition('_')
        whose = (name, user) if name and user.isdecimal() else (prefix, '')
        of_student = handed.setdefault(whose, _Handed())
        plugin, _, flat = rest.partition('_')
        files = of_student.files if plugin == 'file' else of_student.others
        files += [(path, path.partition('/')[2] or flat or path) for path in names]
    return [*_submissions(listing, handed), *found] if handed else []


def _submissions(
    listing: Listing, handed: Mapping[tuple[str, str], _Handed]
) -> Iterator[Submission]:
    for (name, user), each in handed.items():
        one = listing.submission(each.files or each.others, f'{name}_{user}' if user else name)
        one = replace(one, lms='moodle', user=user, name=name)
        if not each.files:
            one = replace(one, refused='a text typed into Moodle, and no file; hand in a zip')
        elif each.others:
            one = replace(one, notes=('left out: a text typed into Moodle',))
        yield one


def _other(listing: Listing, top: str, names: Sequence[str]) -> Submission:
    """Return what somebody has put beside the export."""
    files = [(name, name.partition('/')[2] or name) for name in names]
    return listing.submission(files, without_ending(top))
