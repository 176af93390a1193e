# Copyright 2026 The Husky Playpen Lab authors
# SPDX-License-Identifier: Apache-2.0
"""
What Canvas gives for "Download Submissions".

All files lie side by side, as `NAME_[LATE_]USER_FILE_ORIGINAL`: the name of the student or group
in small letters and without what is no letter, the number of the user, the number of the file,
which grows with time, and the name it was handed in under. Anonymous ones have `anon_` and five
characters for the name and the user. Texts and links end in `_text.html` and `_link.html`. Source:
get_filename and add_upload_submission in lib/content_zipper.rb, github.com/instructure/canvas-lms.
"""

from collections.abc import Mapping, Sequence
from dataclasses import replace
import re

from husky_grader.submission.kinds import HEAD_BYTES, kind_of
from husky_grader.submission.limits import Refused
from husky_grader.submission.listing import Listing
from husky_grader.submission.submission import Submission

_WHOSE = (
    r'(?:(?P<name>[^\WA-Z_][^\WA-Z]*?)_)??(?P<late>LATE_)?'
    r'(?P<user>anon_[0-9A-Za-z]{5}|[1-9]\d*)'
)
_UPLOAD = re.compile(_WHOSE + r'_(?P<number>[1-9]\d*)_(?P<original>.+)')
_TEXT = re.compile(_WHOSE + r'_(?:text|link)\.html')


def canvas_submissions(listing: Listing, tops: Mapping[str, Sequence[str]]) -> list[Submission]:
    """
    Return the submissions of an export of Canvas; none where it is not one.

    Every name must be of Canvas, and the number of a file must not come twice: people name files
    in a like way.

    :param tops: the names directly in the export, and the files in each.
    """
    uploads = {top: match for top in tops if (match := _UPLOAD.fullmatch(top))}
    texts = {top: match for top in tops if (match := _TEXT.fullmatch(top))}
    numbers = {match['number'] for match in uploads.values()}
    flat = all(list(names) == [top] for top, names in tops.items())
    if not (uploads and flat and {*uploads, *texts} == set(tops) and len(numbers) == len(uploads)):
        return []
    by_user: dict[str, list[re.Match[str]]] = {}
    for match in uploads.values():
        by_user.setdefault(match['user'], []).append(match)
    found = [_uploaded(listing, matches) for matches in by_user.values()]
    for top, match in texts.items():
        if match['user'] not in by_user:
            one = _submission(listing, [(top, top)], match)
            found.append(replace(one, refused='a text or a link, and no file; hand in a zip'))
    return found


def _uploaded(listing: Listing, matches: list[re.Match[str]]) -> Submission:
    """Return the submission of one user: the newest archive, or all files where there is none."""
    matches.sort(key=lambda match: int(match['number']))
    archives = [match for match in matches if _is_archive(listing, match)]
    taken = archives[-1:] if len(matches) > 1 and archives else matches
    left = [match['original'] for match in matches if match not in taken]
    files = [(match[0], match['original']) for match in taken]
    note = f'taken: {taken[-1]["original"]}, the newest archive; left out: {", ".join(left)}'
    return replace(
        _submission(listing, files, matches[-1]),
        late=any(match['late'] for match in matches),
        attempt=int(matches[-1]['number']),
        notes=(note,) if left else (),
    )


def _is_archive(listing: Listing, match: re.Match[str]) -> bool:
    try:
        head = listing.read(match[0], HEAD_BYTES)
    except Refused:
        return False
    return kind_of(head, match['original']) in ('zip', 'tar')


def _submission(
    listing: Listing, files: list[tuple[str, str]], match: re.Match[str]
) -> Submission:
    name, user = match['name'] or '', match['user']
    one = listing.submission(files, f'{name}_{user}' if name else user)
    return replace(one, lms='canvas', user=user, name=name)
