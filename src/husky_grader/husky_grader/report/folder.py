# Copyright 2026 The Husky Playpen Lab authors
# SPDX-License-Identifier: Apache-2.0
"""The folder of a report, into which one process writes at a time, and those of its drives."""

from collections.abc import Iterator
from contextlib import contextmanager
import hashlib
import os
from pathlib import Path
import re

from husky_runtime.domains import Lock

REPORT = 'report.html'
_held: set[str] = set()  # by this process


@contextmanager
def alone_in(folder: Path) -> Iterator[None]:
    """
    Keep other processes out of a folder: two would take each other's record for their own.

    A process may come in again where it is already. The folder need not be there yet.

    :raises ValueError: if another process is in it, or it is a file.
    """
    if folder.is_file():
        raise ValueError(f'{folder}: a file, no folder; name another with --report DIR')
    # By os.path: Path.resolve fails where links lead in a circle.
    place = os.fsencode(os.path.realpath(folder))
    name = f'husky_report_{hashlib.sha256(place).hexdigest()}'
    if name in _held:
        yield
        return
    try:
        lock = Lock(name)
    except BlockingIOError:
        raise ValueError(
            f'{folder}: another drive or grading writes its report there; wait for its end, or '
            'name another folder with --report DIR'
        ) from None
    _held.add(name)
    try:
        yield
    finally:
        _held.discard(name)
        lock.close()


def drives_in(folder: Path, step: str) -> list[Path]:
    """
    Return the folders with a report on a drive of a step, in their order.

    :param folder: of the report of a submission.
    :param step: how the names of its files begin.
    """
    one_or_several = re.compile(rf'{re.escape(step)}(_\d+)?')
    found = [path for path in folder.glob(f'{step}*') if one_or_several.fullmatch(path.name)]
    in_order = sorted(found, key=lambda path: (len(path.name), path.name))
    return [path for path in in_order if (path / REPORT).is_file()]
