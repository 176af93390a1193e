# Copyright 2026 The Husky Playpen Lab authors
# SPDX-License-Identifier: Apache-2.0
"""A student's desk: terminals in which the steps of a lab sheet are done one after another."""

from __future__ import annotations

from collections.abc import Callable, Iterable, Iterator, Sequence
from pathlib import Path

from playpen_testing.lab_sheet import ALL, Block, matches, write_file
from playpen_testing.processes import Processes
from playpen_testing.terminal import Terminal
from playpen_testing.waiting import wait_until

STEP_WITHIN_SEC = 120.0

Seen = Callable[[Terminal], object]
"""Called with a terminal that shows what the sheet says."""


class Terminals:
    """The terminals of the desk, opened when they are first used."""

    def __init__(self, processes: Processes) -> None:
        self._processes = processes
        self._open: dict[str, Terminal] = {}

    def __getitem__(self, name: str) -> Terminal:
        if name not in self._open:
            self._open[name] = Terminal(self._processes)
        return self._open[name]

    def __iter__(self) -> Iterator[Terminal]:
        return iter(self._open.values())

    def close(self) -> None:
        for terminal in self:
            terminal.close()


def do_steps(
    blocks: Sequence[Block],
    terminals: Terminals,
    workspace: Path,
    on_seen: Seen = lambda _: None,
) -> None:
    """Type what the sheet says, write its files, and compare what comes out; then Ctrl-C."""
    for number, block in enumerate(blocks):
        if {'file', 'edit'} & block.attributes.keys():
            write_file(workspace, block)
        elif block.language == 'bash':
            following = next(
                (b for b in blocks[number + 1 :] if _is_same_terminal(b, block)), None
            )
            terminals[block.terminal].type(block.text)
            if following is None or following.language != 'text':
                _finish(terminals[block.terminal], block)
        elif block.language == 'text':
            _compare(terminals[block.terminal], block, _command(blocks, number))
            on_seen(terminals[block.terminal])
        elif block.language == 'Ctrl-C':
            _interrupt(terminals if block.terminal == ALL else [terminals[block.terminal]])
    _interrupt(terminals)


def _interrupt(terminals: Iterable[Terminal]) -> None:
    for terminal in terminals:
        if terminal.busy:
            terminal.interrupt()


def _is_same_terminal(block: Block, other: Block) -> bool:
    is_shown = block.language in ('bash', 'text') and 'file' not in block.attributes
    return is_shown and block.terminal == other.terminal


def _command(blocks: Sequence[Block], number: int) -> Block:
    """Return the block that was typed before an output block."""
    terminal = blocks[number].terminal
    return next(
        b for b in reversed(blocks[:number]) if b.language == 'bash' and b.terminal == terminal
    )


def _finish(terminal: Terminal, command: Block) -> None:
    """Wait for the end of a command, with the exit status that the sheet expects."""
    terminal.wait_until_done(timeout_sec=STEP_WITHIN_SEC)
    expected = int(command.attributes.get('status', '0'))
    assert terminal.statuses[-1] == expected, f'line {command.line}: it shows\n{terminal.screen}'


def _compare(terminal: Terminal, expected: Block, command: Block) -> None:
    """Wait until the terminal shows what the sheet says, while the command runs or at its end."""
    if not command.goes_on:
        _finish(terminal, command)
        assert matches(expected.text, terminal.screen, goes_on=False), (
            f'line {expected.line}: the sheet says\n{expected.text}\nit shows\n{terminal.screen}'
        )
        return
    wait_until(
        lambda: matches(expected.text, terminal.screen, goes_on=True) or not terminal.busy,
        timeout_sec=STEP_WITHIN_SEC,
        what=lambda: f'line {expected.line}: what the sheet says; it shows\n{terminal.screen}',
    )
    assert terminal.busy, f'line {command.line}: it has ended and shows\n{terminal.screen}'
