# Copyright 2026 The Husky Playpen Lab authors
# SPDX-License-Identifier: Apache-2.0
"""What a program has printed, as much of it as a report may hold."""

import os
from pathlib import Path

from husky_course.printable import printable

from husky_grader.clone import CLONE

MAX_READ = 32_000  # bytes, of the beginning and of the end each
MAX_SHOWN = 4_000  # characters
MAX_LINES = 100  # that hold a word
MAX_AROUND = 2_000  # bytes of a line before and behind it


def read_printed(log: Path, *, without: str = '') -> str:
    """
    Return the beginning and the end of a log; nothing where there is none.

    :param without: the beginning of paths that is left out: where something lies on this computer.
    """
    try:
        with log.open('rb') as stream:
            begin = stream.read(MAX_READ)
            left = os.fstat(stream.fileno()).st_size - len(begin)
            stream.seek(-min(left, MAX_READ), os.SEEK_END)
            end = stream.read() if left > 0 else b''
    except OSError:
        return ''
    dots = f'\n[{left - MAX_READ} bytes are left out]\n' if left > MAX_READ else ''
    printed = ''.join((_text(begin), dots, _text(end)))
    return printed.replace(without, '') if without else printed


def printed_lines(log: Path, word: str) -> list[str]:
    """Return the first lines in all of a log that hold a word, cut where they are very long."""
    try:
        data, sought = log.read_bytes(), word.encode()
    except OSError:
        return []
    lines: list[str] = []
    end = 0
    while len(lines) < MAX_LINES and (at := data.find(sought, end)) >= 0:
        begin = max(end, data.rfind(b'\n', end, at) + 1, at - MAX_AROUND)
        end = data.find(b'\n', at, at + MAX_AROUND)
        end = end if end >= 0 else at + MAX_AROUND
        lines += [line for line in _text(data[begin:end]).splitlines() if word in line]
    return lines


def shown(printed: str) -> str:
    """Return what of it a report shows: its beginning and its end, nothing of the machine."""
    printed, half = without_machine(printed), MAX_SHOWN // 2
    if len(printed) > MAX_SHOWN:
        left_out = f'\n[{len(printed) - MAX_SHOWN} characters are left out]\n'
        printed = printed[:half] + left_out + printed[-half:]
    return printable(printed, keep='\n\t')


def without_machine(text: str) -> str:
    """Return it without where the lab and the home of who grades lie: paths there begin so."""
    home = os.path.expanduser('~')  # noqa: PTH111  # the other raises where there is none
    text = text.replace(f'{CLONE}/', '')
    return text.replace(f'{home}/', '~/') if home.strip('/~') else text


def _text(data: bytes) -> str:
    return data.decode('utf-8', errors='replace')
