# Copyright 2026 The Husky Playpen Lab authors
# SPDX-License-Identifier: Apache-2.0
"""Read the steps of the lab sheet: what is typed, which files are written, what comes out.

The first words after the fence of a block say what it is; Markdown shows only its language:

    ```bash terminal=2          typed into terminal 2; 1 where none is given
    ```bash until=Ctrl-C        the same, for a program that runs until then
    ```bash status=1            the same, for one that ends with another exit status than 0
    ```text terminal=2          what then stands in that terminal
    ```python file=PATH         a file, below the workspace
    ```python edit=PATH         a part of a file, which replaces what begins and ends alike

A sentence counts as a block, too: `End ... in all terminals with Ctrl-C.`, or in one of them.
"""

from dataclasses import dataclass
from pathlib import Path
import re

_BLOCK = re.compile(r'^```(?P<info>\w.*?)\n(?P<text>.*?)^```$', re.MULTILINE | re.DOTALL)
_END = re.compile(
    r'\bEnd [^`.]+? in\s(?:all\sterminals|terminal\s(?P<terminal>\d+))\swith\sCtrl-C\.'
)
_NUMBER = re.compile(r'[-+]?\d+(?:\.\d+)?')
_ANY_NUMBER = r'[-+]?\d+(?:\.\d+)?(?:e[-+]?\d+)?'
LEFT_OUT = '...'
ALL = 'all'


@dataclass(frozen=True)
class Block:
    """A fenced block of the sheet; or, in the language `Ctrl-C`, that programs are ended."""

    language: str
    attributes: dict[str, str]
    text: str
    line: int  # of its fence in the sheet

    @property
    def goes_on(self) -> bool:
        return 'until' in self.attributes

    @property
    def terminal(self) -> str:
        return self.attributes.get('terminal', '1')


def read_blocks(sheet: str) -> list[Block]:
    """Return the blocks of a Markdown text in their order."""
    blocks = []

    def add(match: re.Match[str], info: str, text: str) -> None:
        language, *words = info.split()
        attributes = dict(word.split('=', 1) for word in words)
        line = sheet.count('\n', 0, match.start()) + 1
        blocks.append(Block(language, attributes, text, line))

    for match in _BLOCK.finditer(sheet):
        add(match, match['info'], match['text'])
    for match in _END.finditer(sheet):
        add(match, f'Ctrl-C terminal={match["terminal"] or ALL}', '')
    return sorted(blocks, key=lambda block: block.line)


def write_file(workspace: Path, block: Block) -> None:
    """Do what a student does in the editor."""
    if 'file' in block.attributes:
        path = workspace / block.attributes['file']
        assert path.parent.is_dir(), f'line {block.line}: there is no folder {path.parent}'
        path.write_text(block.text)
        return
    path = workspace / block.attributes['edit']
    lines, new = path.read_text().splitlines(), block.text.splitlines()
    starts = [number for number, line in enumerate(lines) if _name(line) == _name(new[0])]
    assert len(starts) == 1, f'line {block.line}: {path} has {len(starts)} lines like {new[0]!r}'
    (start,) = starts
    end = lines.index(new[-1], start) if len(new) > 1 else start
    path.write_text('\n'.join([*lines[:start], *new, *lines[end + 1 :]]) + '\n')


def _name(line: str) -> str:
    """Return what is assigned to."""
    return line.partition('=')[0].rstrip()


def matches(expected: str, printed: str, *, goes_on: bool) -> bool:
    """
    Tell whether a terminal shows what the sheet says.

    Any number stands for any other; a line `...` for any number of lines.

    :param goes_on: more may follow, because the program still runs.
    """
    pattern = ''
    for line in expected.rstrip('\n').split('\n'):
        if line.strip() == LEFT_OUT:
            pattern += r'(?:[^\n]*\n)*?'
        else:
            pattern += _line_pattern(line.rstrip()) + r'[ ]*\n'
    if not goes_on:
        pattern += r'\s*\Z'
    return re.match(r'\s*' + pattern, printed.rstrip('\n') + '\n') is not None


def _line_pattern(line: str) -> str:
    words = (re.escape(word) for word in _NUMBER.split(line))
    # A column gets wider or narrower with its numbers.
    return re.sub(r'(?:\\ )+', ' +', _ANY_NUMBER.join(words))
