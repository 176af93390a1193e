# Copyright 2026 The Husky Playpen Lab authors
# SPDX-License-Identifier: Apache-2.0
"""What a file is: by its content, and what its name says."""

import re
from typing import Literal

Kind = Literal['folder', 'git', 'zip', 'tar', 'yaml', 'unknown']

HEAD_BYTES = 512
TAKEN = 'zip, tar (also .gz, .bz2, .xz), a folder, a git clone or a waypoint file (.yaml)'

# An empty zip has only the record of its end (APPNOTE.TXT 6.3.10, section 4.3.16).
_ZIP = (b'PK\x03\x04', b'PK\x05\x06')
GZIP, BZIP2, XZ = b'\x1f\x8b', b'BZh', b'\xfd7zXZ\x00'
_USTAR_AT = 257  # POSIX.1-2001, pax: the field magic of a header
_NOT_TAKEN = {
    b'Rar!\x1a\x07': 'a RAR archive',
    b"7z\xbc\xaf'\x1c": 'a 7z archive',
    b'\x28\xb5\x2f\xfd': 'compressed with Zstandard',
    b'%PDF': 'a PDF',
}
_ENDINGS = re.compile(r'(?<=.)(\.tar)?\.(zip|tar|t[gbx]z|tbz2|gz|bz2|xz|ya?ml)$', re.IGNORECASE)


def kind_of(head: bytes, name: str) -> Kind:
    """
    Return what a file is.

    :param head: its first HEAD_BYTES bytes, fewer of a shorter file.
    """
    if head.startswith(_ZIP):
        return 'zip'
    if head.startswith((GZIP, BZIP2, XZ)) or head[_USTAR_AT:].startswith(b'ustar'):
        return 'tar'
    return 'yaml' if is_called_yaml(name) else 'unknown'


def is_called_yaml(name: str) -> bool:
    """Tell whether a file has the ending of a waypoint file."""
    return name.lower().endswith(('.yaml', '.yml'))


def without_ending(name: str) -> str:
    """
    Return the name of a file without the ending of an archive or of a waypoint file.

    >>> without_ending('CSE461_07_03.tar.gz')
    'CSE461_07_03'
    """
    return _ENDINGS.sub('', name)


def is_called_archive(name: str) -> bool:
    """Tell whether a file has the ending of an archive."""
    return not is_called_yaml(name) and without_ending(name) != name


def why_not(head: bytes) -> str:
    """Return in one line why a file of kind unknown cannot be taken."""
    if re.search(rb'^waypoints\s*:', head, re.MULTILINE):
        return (
            'a waypoint file by another name; call it NAME.yaml (Windows hides a .txt behind that)'
        )
    known = (text for start, text in _NOT_TAKEN.items() if head.startswith(start))
    what = 'empty' if not head else next(known, 'no archive that is known here')
    return f'{what}; hand in {TAKEN}'
