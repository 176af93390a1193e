# Copyright 2026 The Husky Playpen Lab authors
# SPDX-License-Identifier: Apache-2.0
"""Unpack one submission into a workspace of its own."""

from collections.abc import Iterable, Iterator, Sequence
from contextlib import contextmanager, ExitStack
from dataclasses import dataclass, replace
import hashlib
import io
from pathlib import Path
import shutil
from tempfile import TemporaryFile

from husky_course.printable import printable

from husky_grader.submission.archives import decompressed, opened_zip, tar_entries, zip_entries
from husky_grader.submission.entries import (
    Entry,
    FILE,
    file_entry,
    folder_entries,
    is_left_out,
    refusing_what_is_broken,
)
from husky_grader.submission.git import is_bare, tar_of
from husky_grader.submission.kinds import HEAD_BYTES, kind_of, without_ending
from husky_grader.submission.limits import Limits, Meter, Refused
from husky_grader.submission.submission import Submission
from husky_grader.submission.tree import TreeWriter
from husky_grader.submission.workspace import settle, Workspace

_STAGING = '.unpacking'  # no workspace is called so: harmless names do not begin with a dot
_DEFAULT = Limits()
_FEW = 20  # so many files may lie beside an archive that was handed in


def unpack(submission: Submission, folder: Path, limits: Limits = _DEFAULT) -> Workspace:
    """
    Copy what was handed in to a workspace in a folder; nothing of the source is changed.

    The workspace has only files and folders, of the user who calls this, and no links.

    :param folder: of this submission alone; is made where it is missing. A workspace of the same
        name in it is replaced.
    :raises Refused: when it cannot be taken, with one line for a person.
    :raises OSError: when the workspace cannot be written, which is no fault of the submission.
    """
    if submission.refused:
        raise Refused(printable(f'{submission.place}: {submission.refused}'))
    folder.mkdir(parents=True, exist_ok=True)
    staging = folder / _STAGING
    shutil.rmtree(staging, ignore_errors=True)  # of a call that was killed
    meter = Meter(limits)
    tree = TreeWriter(staging, meter)
    try:
        with ExitStack() as stack:
            handed = _handed_in(submission, meter, stack)
            for entry in handed.entries:
                tree.add(entry)
        workspace = settle(tree, staging, folder, handed.name)
    except Refused as error:
        raise Refused(printable(f'{submission.place}: {error}')) from None
    finally:
        shutil.rmtree(staging, ignore_errors=True)
    notes = map(printable, (*handed.notes, *workspace.notes))
    return replace(workspace, notes=tuple(notes))


def digest_of(submission: Submission, limits: Limits = _DEFAULT) -> str:
    """
    Return a hash of what was handed in: of what `unpack` takes, or refuses.

    :raises OSError: when the folder for temporary files cannot be written.
    """
    digest = hashlib.sha256()
    try:
        if submission.refused:
            raise Refused(submission.refused)
        meter = Meter(limits)
        with ExitStack() as stack:
            handed = _handed_in(submission, meter, stack)
            digest.update(repr(handed.name).encode())
            for entry in handed.entries:
                digest.update(repr((entry.path, entry.what, entry.executable)).encode())
                content = hashlib.sha256()
                for chunk in entry.chunks() if entry.what == FILE else ():
                    content.update(chunk)
                digest.update(content.digest())
    except Refused as error:
        digest.update(f'refused: {error}'.encode(errors='surrogateescape'))
    return digest.hexdigest()


@dataclass(frozen=True)
class _Handed:
    """What is to be written, and the name of a workspace that has none of its own."""

    entries: Iterable[Entry]
    name: str
    notes: tuple[str, ...] = ()


def _handed_in(submission: Submission, meter: Meter, stack: ExitStack) -> _Handed:
    """
    Open what was handed in.

    :param stack: closes it.
    """
    source = submission.source
    if submission.kind == 'git' and is_bare(source):
        stream = stack.enter_context(tar_of(source, Meter(meter.limits)))
        return _Handed(tar_entries(stream, meter), without_ending(source.name))
    if source.is_dir() and submission.files:
        found = [file_entry(source / name, path, meter) for name, path in submission.files]
        return _unwrapped(found, submission.id, meter, stack)
    if source.is_dir():
        return _unwrapped(list(folder_entries(source, meter)), source.name, meter, stack)
    if submission.files:
        with refusing_what_is_broken():
            file = stack.enter_context(source.open('rb', buffering=0))
        archive = stack.enter_context(opened_zip(file))
        found = list(zip_entries(archive, meter, dict(submission.files)))
        return _unwrapped(found, submission.id, meter, stack)
    return _unwrapped([file_entry(source, source.name, meter)], submission.id, meter, stack)


def _unwrapped(found: Sequence[Entry], name: str, meter: Meter, stack: ExitStack) -> _Handed:
    """Return what is in the archive that was handed in, or all where none was."""
    files = [entry for entry in found if entry.what == FILE and not is_left_out(entry.name)]
    if len(files) > _FEW or any(entry.name == 'package.xml' for entry in files):
        return _Handed(found, name)
    heads = [next(entry.chunks(), b'')[:HEAD_BYTES] for entry in files]
    kinds = [kind_of(head, entry.name) for head, entry in zip(heads, files, strict=True)]
    archives = [entry for entry, kind in zip(files, kinds, strict=True) if kind in ('zip', 'tar')]
    if len(archives) > 1:
        names = ', '.join(entry.path for entry in archives)
        raise Refused(f'{len(archives)} archives: {names}; hand in one')
    if not archives:
        return _Handed(found, name)
    others = ', '.join(entry.path for entry in files if entry not in archives)
    notes = (f'left out beside {archives[0].path}: {others}',) if others else ()
    inside = _archive_entries(archives[0], meter, stack)
    return _Handed(inside, without_ending(archives[0].name), notes)


def _archive_entries(entry: Entry, meter: Meter, stack: ExitStack) -> Iterator[Entry]:
    """Return what is in an archive."""
    file = stack.enter_context(_copied(entry, meter))
    head = file.read(HEAD_BYTES)
    if kind_of(head, entry.name) == 'zip':
        return zip_entries(stack.enter_context(opened_zip(file)), meter)
    return tar_entries(decompressed(file, head), meter)


@contextmanager
def _copied(entry: Entry, meter: Meter) -> Iterator[io.FileIO]:
    """Give a copy of a file that can be read in any order; in a zip it could not, quickly."""
    with TemporaryFile(buffering=0) as file:
        size = 0
        for chunk in entry.chunks():
            size += len(chunk)
            meter.check_file(entry.path, size)
            file.write(chunk)
        file.seek(0)
        yield file
