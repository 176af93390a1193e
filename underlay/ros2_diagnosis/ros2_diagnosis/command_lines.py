# Copyright 2026 The Husky Playpen Lab authors
# SPDX-License-Identifier: Apache-2.0
"""What the programs of this user were told, by --ros-args or not, and the nodes they hold."""

from __future__ import annotations

from collections.abc import Iterator
import contextlib
from dataclasses import dataclass
import itertools
from pathlib import Path

from rtps_graph import host
from rtps_graph.graph import Graph, Node


@dataclass(frozen=True, kw_only=True)
class CommandLine:
    """A program that runs.

    :param file: the program, as it was called; of a module (`python3 -m`) its name.
    :param folder: the one that it was started in.
    :param words: what stands behind the program.
    :param nodes: those of a graph that it holds, one at least.
    """

    file: Path
    folder: Path
    words: tuple[str, ...]
    nodes: tuple[Node, ...]

    @property
    def program(self) -> str:
        return self.file.name

    @property
    def options(self) -> tuple[tuple[str, str], ...]:
        """Return each word behind --ros-args with the next one."""
        begin = self.words.index('--ros-args') if '--ros-args' in self.words else len(self.words)
        return tuple(itertools.pairwise(self.words[begin:]))


def with_nodes_in(graph: Graph) -> Iterator[CommandLine]:
    """Yield the programs of this user that hold nodes of a graph.

    What only starts another one with its own words, as `ros2 run` and `timeout`, holds none.
    """
    for process in sorted(Path('/proc').glob('[0-9]*')):
        with contextlib.suppress(OSError):  # it has ended, or is another user's
            words = (process / 'cmdline').read_bytes().decode(errors='replace').split('\0')
            if '--ros-args' not in words and not any(':=' in word for word in words):
                continue
            ports = host.ports_of(process)
            nodes = tuple(node for node in graph.nodes if node.port in ports)
            if nodes:
                if 'python' in Path(words[0]).name:
                    words = _behind_python(words)
                yield CommandLine(
                    file=Path(words[0]),
                    folder=(process / 'cwd').readlink(),
                    words=tuple(words[1:]),
                    nodes=nodes,
                )


def _behind_python(words: list[str]) -> list[str]:
    """Return the words without those of Python: program or module come first."""
    at = 1
    while at < len(words) - 1 and words[at].startswith('-') and words[at] != '-c':
        at += 2 if words[at] in ('-W', '-X') else 1
        if words[at - 1] == '-m':
            break
    return words[at:]
