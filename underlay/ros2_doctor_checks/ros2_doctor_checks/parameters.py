# Copyright 2026 The Husky Playpen Lab authors
# SPDX-License-Identifier: Apache-2.0
"""Parameters that a program is given, and that none of its nodes has: they set nothing."""

from __future__ import annotations

from collections.abc import Iterator
import contextlib
from dataclasses import dataclass
import itertools
from pathlib import Path
import re
from typing import Any

from ros2_diagnosis import nearest
from ros2_diagnosis.finding import Finding
from rtps_graph.graph import Graph
import yaml

from ros2_doctor_checks import answers

_VALUES = 'ros__parameters'
_ALL = '/**'
_READ_BY_ROS = 'qos_overrides.'


@dataclass(frozen=True)
class _Given:
    """A parameter as it is given.

    :param nodes: a pattern of the names of those that it is for.
    :param where: the option or the file that gives it.
    """

    nodes: str
    name: str
    where: str


def check_parameters(graph: Graph, domain_id: int) -> Iterator[Finding]:
    """Compare what the programs of this user are given with what the nodes have declared."""
    given = {each for command in _commands(domain_id) for each in _given(*command)}
    if not given:
        return
    known = answers.parameter_names(graph)
    if any(names is None for names in known.values()):
        return  # That node may have it.
    absent = {}
    for each in sorted(given, key=lambda each: (each.where, each.name)):
        pattern = _expression(each.nodes)
        nodes = [node for node in known if pattern.fullmatch(node)]
        there = {name for node in nodes for name in known[node] or ()}
        if not nodes:
            absent[each.where, each.nodes] = ', '.join(sorted(known))
        elif each.name not in there and not each.name.startswith(_READ_BY_ROS):
            yield Finding(
                each.where,
                f'{each.name} sets nothing: no node that it is for has such a parameter',
                f"call declare_parameter('{each.name}', ...) in the node, or mend the name"
                f'{nearest.hint(each.name, there, at_most=0)}',
            )
    for (where, pattern_of_nodes), others in absent.items():
        yield Finding(
            where,
            f'what it gives to {pattern_of_nodes} sets nothing, because no such node runs',
            f"name one that does, or '{_ALL}' for all; there is {others}",
            serious=False,
        )


def _commands(domain_id: int) -> Iterator[tuple[Path, list[str]]]:
    """Yield the folders and command lines of this user's programs for ROS in a domain."""
    for process in Path('/proc').glob('[0-9]*'):
        with contextlib.suppress(OSError):  # it has ended, or is another user's
            words = _texts(process / 'cmdline')
            # `ros2 run` hands its words on to the program.
            if '--ros-args' not in words or any(Path(word).name == 'ros2' for word in words[:2]):
                continue
            settings = dict(line.partition('=')[::2] for line in _texts(process / 'environ'))
            if (settings.get('ROS_DOMAIN_ID') or '0') == str(domain_id):
                yield (process / 'cwd').readlink(), words


def _texts(file: Path) -> list[str]:
    return file.read_bytes().decode(errors='replace').split('\0')


def _given(folder: Path, words: list[str]) -> Iterator[_Given]:
    """Yield the parameters of a command line, and those of its files."""
    program = Path(words[1] if 'python' in Path(words[0]).name else words[0]).name
    for option, value in itertools.pairwise(words[words.index('--ros-args') :]):
        where = f'{program} {option} {value}'
        if option in ('-p', '--param') and ':=' in value:
            node, _, name = value.partition(':=')[0].rpartition(':')
            yield _Given(f'/**/{node}' if node else _ALL, name, where)
        elif option == '--params-file':
            with contextlib.suppress(OSError, yaml.YAMLError, UnicodeDecodeError):
                yield from _of_sections(yaml.safe_load((folder / value).read_text()), '', where)


def _of_sections(sections: Any, nodes: str, where: str) -> Iterator[_Given]:
    """Yield what a file gives to the nodes that its sections name, one within another."""
    for key, inner in sections.items() if isinstance(sections, dict) else ():
        if key == _VALUES:
            yield from (_Given(nodes, name, where) for name in _flat(inner))
        else:
            yield from _of_sections(inner, f'{nodes}/{str(key).strip("/")}', where)


def _flat(values: Any, prefix: str = '') -> Iterator[str]:
    for key, value in values.items() if isinstance(values, dict) else ():
        if isinstance(value, dict):
            yield from _flat(value, f'{prefix}{key}.')
        else:
            yield f'{prefix}{key}'


def _expression(pattern: str) -> re.Pattern[str]:
    """Return what matches the full names of nodes as rcl does: ** is any namespace, * a part."""
    parts = [
        '(?:/[^/]+)*' if part == '**' else '/' + re.escape(part).replace(r'\*', '[^/]*')
        for part in pattern.strip('/').split('/')
    ]
    return re.compile(''.join(parts))
