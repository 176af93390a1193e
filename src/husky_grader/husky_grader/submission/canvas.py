# Copyright 2026 The Husky Playpen Lab authors
# SPDX-License-Identifier: Apache-2.0
"""
What Canvas gives for "Download Submissions".

All files lie side by side, as `NAME_[LATE_]USER_FILE_ORIGINAL`: the name of the student or group
in small letters and without what is neither letter nor mark on one, the number of the user, the
number of the file, which grows with time, and the name it was handed in under. Anonymous ones have
`anon_` and five characters for the name and the user. Texts and links end in `_text.html` and
`_link.html`. Source: get_filename and add_upload_submission in lib/content_zipper.rb,
github.com/instructure/canvas-lms.
"""

from collections.abc import Mapping, Sequence
from dataclasses import dataclass, replace
import re

from husky_grader.folder_names import composed, is_of_a_word
from husky_grader.submission.kinds import HEAD_BYTES, kind_of
from husky_grader.submission.limits import Refused
from husky_grader.submission.listing import Listing
from husky_grader.submission.submission import Submission

_NUMBER = re.compile(r'[1-9]\d{0,17}', re.ASCII)
_ANONYMOUSLY = 'anon'
_ANONYMOUS = re.compile(r'[0-9A-Za-z]{5}')
_TEXTS = ('text.html', 'link.html')


@dataclass(frozen=True)
class _File:
    """What the name of a file says."""

    top: str  # the whole name
    name: str
    late: bool
    user: str
    number: int  # 0 of a text or a link
    original: str


def canvas_submissions(listing: Listing, tops: Mapping[str, Sequence[str]]) -> list[Submission]:
    """
    Return the submissions of an export of Canvas; none where it is not one.

    Every name must be of Canvas, and the number of a file must not come twice: people name files
    in a like way, and so those of a class would be taken for the files of one student.

    :param tops: the names directly in the export, and the files in each.
    """
    by_user: dict[str, list[_File]] = {}
    numbers: set[int] = set()
    for top, names in tops.items():
        file = _parse(top)
        again = file is not None and file.number > 0 and file.number in numbers
        if file is None or list(names) != [top] or again:
            return []
        numbers.add(file.number)
        by_user.setdefault(file.user, []).append(file)
    if not numbers - {0} or not _are_users(listing, by_user):
        return []
    return [_of_user(listing, files) for files in by_user.values()]


def _are_users(listing: Listing, by_user: Mapping[str, Sequence[_File]]) -> bool:
    """
    Tell users from numbers in the names that people give: years, sections of a course.

    Each has one name, and somebody has one that is no number. Only one, with several archives, is
    rather a class. Little of this is in the hands of a student who would hide a class's export.
    """
    names = {user: {file.name for file in files} for user, files in by_user.items()}
    if any(len(each) > 1 for each in names.values()):
        return False
    if not any(_is_named(*each) or user.startswith(_ANONYMOUSLY) for user, each in names.items()):
        return False
    first, *others = by_user.values()
    return bool(others) or sum(_is_archive(listing, file) for file in first) <= 1


def _is_named(name: str) -> bool:
    return name != '' and not name.isdecimal()


def _parse(top: str) -> _File | None:
    """
    Return what a name says; None where it is not of Canvas.

    A student may have a number for a name, or one in it: the user's stands behind it.
    """
    words = top.split('_')
    for at, word in enumerate(words):
        anonymous = word == _ANONYMOUSLY and _ANONYMOUS.fullmatch(''.join(words[at + 1 : at + 2]))
        if anonymous or (at > 0 and _NUMBER.fullmatch(word)):
            after = at + 2 if anonymous else at + 1
            file = _parsed(top, words[:at], '_'.join(words[at:after]), words[after:])
            if file is not None:
                return file
    return None


def _parsed(top: str, before: list[str], user: str, after: list[str]) -> _File | None:
    late = before[-1:] == ['LATE']
    name = composed('_'.join(before[:-1] if late else before))
    if name != name.lower() or not all(map(is_of_a_word, name)):
        return None
    if len(after) == 1 and after[0] in _TEXTS:
        return _File(top, name, late, user, 0, after[0])
    if len(after) > 1 and _NUMBER.fullmatch(after[0]):
        return _File(top, name, late, user, int(after[0]), '_'.join(after[1:]))
    return None


def _of_user(listing: Listing, files: list[_File]) -> Submission:
    """Return the submission of one user: the newest archive, or all files where there is none."""
    uploads = sorted((file for file in files if file.number), key=lambda file: file.number)
    archives = [file for file in uploads if _is_archive(listing, file)]
    chosen = archives[-1:] if len(uploads) > 1 else []
    taken = chosen or uploads or files
    left = ', '.join(file.original for file in uploads if chosen and file not in chosen)
    note = f'taken: {taken[-1].original}, the newest archive; left out: {left}'
    newest = taken[-1]
    wanted = f'{newest.name}_{newest.user}' if newest.name else newest.user
    one = listing.submission([(file.top, file.original) for file in taken], wanted)
    return replace(
        one,
        lms='canvas',
        user=newest.user,
        name=newest.name,
        late=any(file.late for file in files),
        attempt=max(file.number for file in files),
        notes=(note,) if left else (),
        refused=one.refused if uploads else 'a text or a link, and no file; hand in a zip',
    )


def _is_archive(listing: Listing, file: _File) -> bool:
    try:
        head = listing.read(file.top, HEAD_BYTES)
    except Refused:
        return False
    return kind_of(head, file.original) in ('zip', 'tar')
