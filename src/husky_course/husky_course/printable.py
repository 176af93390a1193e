# Copyright 2026 The Husky Playpen Lab authors
# SPDX-License-Identifier: Apache-2.0
"""Text of others (names of files, of nodes, of obstacles) as a terminal or a page may show it."""

import unicodedata

# Control, format (they turn the direction of writing) and surrogate characters, and line ends.
_NOT_SHOWN = frozenset({'Cc', 'Cf', 'Cs', 'Zl', 'Zp'})


def printable(text: str, *, keep: str = '') -> str:
    r"""
    Show what a terminal would obey, or cannot show, as Python writes it.

    :param keep: characters that stay, such as a newline that is ours.

    >>> printable('a\x1b[31m.yaml')
    'a\\x1b[31m.yaml'
    """
    return ''.join(
        char if char in keep or unicodedata.category(char) not in _NOT_SHOWN else _named(char)
        for char in text
    )


def _named(char: str) -> str:
    if '\udc80' <= char <= '\udcff':  # a byte of a file name that is not UTF-8
        return f'\\x{ord(char) - 0xDC00:02x}'
    return char.encode('unicode_escape').decode()
