# Copyright 2026 The Husky Playpen Lab authors
# SPDX-License-Identifier: Apache-2.0
"""Find the submissions in what a teaching assistant has: files, folders and exports of an LMS."""

from collections.abc import Iterable, Iterator, Sequence
from contextlib import suppress
from dataclasses import replace
from pathlib import Path
import re

from husky_course.printable import printable

from husky_grader.folder_names import folder_names
from husky_grader.submission.canvas import canvas_submissions
from husky_grader.submission.git import is_bare
from husky_grader.submission.gradescope import gradescope_submissions
from husky_grader.submission.kinds import without_ending
from husky_grader.submission.limits import FOLDERS_OF_COLCON, Refused
from husky_grader.submission.listing import (
    FolderListing,
    head_of,
    listed_zip,
    Listing,
    submission_at,
    visible,
)
from husky_grader.submission.moodle import moodle_submissions
from husky_grader.submission.submission import Submission

_NAME = re.compile(rb'<name>\s*([^<\s]+)')
_MOST_OF_A_MANIFEST = 100_000  # bytes
# Also what ssh takes: user@host:path.
_URL = re.compile(r'[a-z][a-z0-9+.-]*://.*|[\w.-]+@[\w.-]+:.*', re.IGNORECASE)


def find_submissions(
    given: Sequence[str], *, taken: Iterable[str] = (), without: str = ''
) -> list[Submission]:
    """
    Return the submissions in files, folders and exports, in the order given, then of their names.

    What cannot be taken is among them, with the reason in `refused`. Of several of one student of
    an LMS the newest is returned, and says which it replaces.

    :param given: paths: one submission, a folder of submissions, or an export of Moodle, Canvas or
        Gradescope, as a zip or unpacked.
    :param taken: names that no id may be.
    :param without: the real path of what is none of it, though it may lie in one of the folders.
    """
    found = _newest(_without_forged(given, [_found_in(path, without) for path in given]))
    names = folder_names([each.source.parent / each.id for each in found], taken=taken)
    return [
        replace(each, id=name, notes=tuple(map(printable, each.notes)))
        for each, name in zip(found, names, strict=True)
    ]


def _without_forged(
    given: Sequence[str], found: Sequence[list[Submission]]
) -> Iterator[Submission]:
    """
    Yield what was found, with a zip that looks like an export refused beside single files.

    Where the archives of a class are given one by one, a student can make such a zip for another.
    """
    files = [path.is_file() for path in map(Path, given)]
    single = any(is_file and not each[0].lms for is_file, each in zip(files, found, strict=True))
    for is_file, each in zip(files, found, strict=True):
        if single and is_file and each[0].lms:
            source = each[0].source
            why = 'looks like an export, among single files; give an export alone, or unpacked'
            yield Submission(without_ending(source.name), source, 'zip', refused=why)
        else:
            yield from each


def _found_in(given: str, without: str) -> list[Submission]:
    """Return the submissions in one of the paths; one that says why where there are none."""
    path = Path(given)
    refused = ''
    try:
        if given and path.exists() and (path.is_symlink() or path.name in ('', '..')):
            path = path.resolve()
        if not given:
            refused = 'an empty name; give a file or a folder'
        elif path.is_dir():
            return _in_folder(path, without)
        elif path.is_file():
            return _in_file(path)
        elif _URL.fullmatch(given):
            refused = 'a URL; clone it with git first, and give the clone'
        else:
            refused = 'no file and no folder' if path.exists() else 'no such file or folder'
    except (OSError, ValueError) as error:  # ValueError: a NUL byte in the path
        refused = getattr(error, 'strerror', None) or str(error)
    return [Submission(without_ending(path.name) or given, path, 'unknown', refused=refused)]


def _in_file(path: Path) -> list[Submission]:
    one = submission_at(path)
    if one.kind == 'zip':
        try:
            with listed_zip(path) as listing:
                return _in_export(listing) or [one]
        except Refused:  # unpacking it says why
            pass
    return [one]


def _in_folder(folder: Path, without: str) -> list[Submission]:
    names = visible(folder, without)
    children = [folder / name for name in names]
    if found := _in_export(FolderListing(folder, without)):
        return found
    if (folder / '.git').exists() or is_bare(folder) or _is_workspace(children):
        return [submission_at(folder)]
    if not children:
        return [Submission(folder.name, folder, 'folder', refused='an empty folder')]
    return [submission_at(child) for child in children]


def _is_workspace(children: Sequence[Path]) -> bool:
    """Tell a workspace, a package or a folder of packages from a folder of submissions."""
    if any(child.name in ('src', 'package.xml') for child in children):
        return True
    folders = [
        child for child in children if child.is_dir() and child.name not in FOLDERS_OF_COLCON
    ]
    if not folders or not all(map(_is_package, folders)):
        return False
    # In a workspace no two packages have one name. A class may hand in nothing but packages.
    names = {_package_name(folder) for folder in folders}
    clones = len(folders) > 1 and all((folder / '.git').exists() for folder in folders)
    archives = any(submission_at(child).kind in ('zip', 'tar') for child in children)
    return len(names) == len(folders) and not clones and not archives


def _is_package(folder: Path) -> bool:
    try:
        return (folder / 'package.xml').exists()
    except PermissionError:  # unpacking it says why
        return False


def _package_name(folder: Path) -> str:
    """Return the name of a package; that of its folder where the manifest does not say it."""
    manifest, found = folder / 'package.xml', None
    if manifest.is_file():  # to read a pipe may take for ever
        with suppress(Refused):
            found = _NAME.search(head_of(manifest, _MOST_OF_A_MANIFEST))
    return found[1].decode(errors='replace') if found else folder.name


def _in_export(listing: Listing) -> list[Submission]:
    """Return the submissions in an export, also in a folder around it; none where it is none."""
    inside = listing.inside()
    return _directly_in(listing) or (_directly_in(inside) if inside is not None else [])


def _directly_in(listing: Listing) -> list[Submission]:
    tops: dict[str, list[str]] = {}
    for name in listing.names:
        tops.setdefault(name.partition('/')[0], []).append(name)
    return (
        gradescope_submissions(listing, tops)
        or moodle_submissions(listing, tops)
        or canvas_submissions(listing, tops)
    )


def _newest(found: Iterable[Submission]) -> list[Submission]:
    """Drop what a newer one of the same student replaces; of two that do not say, the earlier."""
    newest: dict[object, Submission] = {}
    for number, each in enumerate(found):
        whose = (each.lms, each.user) if each.user else number
        other = newest.setdefault(whose, each)
        if other is not each:
            old, new = (each, other) if each.attempt < other.attempt else (other, each)
            older = 'an older one' if old.attempt < new.attempt else 'one that was given before it'
            note = f'replaces {older}: {old.place}'
            newest[whose] = replace(new, notes=(*new.notes, note))
    return list(newest.values())
