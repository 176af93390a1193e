# Copyright 2026 The Husky Playpen Lab authors
# SPDX-License-Identifier: Apache-2.0
"""Parameters that a program is given and that set nothing: none of its nodes has or hears them."""

from __future__ import annotations

from collections.abc import Iterator
import contextlib
from dataclasses import dataclass, replace
from pathlib import Path
import re
from typing import Any

from ros2_diagnosis import command_lines, nearest, ros_arguments
from ros2_diagnosis.command_lines import CommandLine
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
    """

    nodes: str
    name: str


@dataclass
class _Source:
    """An option that gives parameters.

    :param held: the nodes that are given them; of all programs where several have one file.
    """

    where: str
    given: list[_Given]
    held: set[str]


def check_parameters(graph: Graph) -> Iterator[Finding]:
    """Compare what the programs of this user are given with what their nodes have declared."""
    lines = [
        line
        for line in command_lines.with_nodes_in(graph)
        if any(not node.is_hidden for node in line.nodes)
    ]
    for line in lines:
        yield from _passed_over(line)
    sources = _sources(lines)
    if not sources:
        return
    known = answers.parameter_names(graph)
    of_nobody: list[Finding] = []
    for source in sources:
        if any(known[node] is None for node in source.held):
            continue  # That node may have it.
        missed: set[str] = set()
        for each in source.given:
            pattern = _expression(each.nodes)
            nodes = [node for node in source.held if pattern.fullmatch(node)]
            there = {name for node in nodes for name in known[node] or ()}
            if not nodes:
                missed.add(each.nodes)
            elif each.name not in there and not each.name.startswith(_READ_BY_ROS):
                yield Finding(
                    source.where,
                    f'{each.name} sets nothing: no node that it is for has such a parameter',
                    f"call declare_parameter('{each.name}', ...) in the node, or mend the name"
                    f'{nearest.hint(each.name, there, at_most=0)}',
                )
        of_nobody += [
            Finding(
                source.where,
                f'what it gives to {nodes} sets nothing, because no such node is given it',
                f"name one that is, or '{_ALL}' for all; there is "
                f'{", ".join(sorted(source.held))}',
                serious=missed == {each.nodes for each in source.given},
            )
            for nodes in sorted(missed)
        ]
    yield from of_nobody


def _passed_over(line: CommandLine) -> Iterator[Finding]:
    """Find what stands behind no --ros-args, as the `arguments` of a launch file do."""
    package = line.file.parent.name if line.file.parent.parent.name == 'lib' else ''
    command = f'ros2 run {package} {line.program}' if package else line.program
    if ros_arguments.is_of_a_student(package) if package else line.file.suffix == '.py':
        for found in ros_arguments.passed_over(command, line.words):
            mend = f'{found.mend}; in a launch file, `parameters` or `remappings` of its Node'
            yield replace(found, where=f'{line.program} {found.where}', mend=mend)


def _sources(lines: list[CommandLine]) -> list[_Source]:
    found: dict[tuple[str, str, str], _Source] = {}
    for line in lines:
        held = {node.full_name for node in line.nodes if not node.is_hidden}
        for option, value in line.options:
            given = sorted(set(_given(line.folder, option, value)), key=lambda each: each.name)
            where = f'{line.program} {option} {value}'
            is_file = option == '--params-file'
            to = str(line.folder / value) if is_file else ', '.join(sorted(held))
            if given:
                found.setdefault((option, value, to), _Source(where, given, set())).held |= held
    return sorted(found.values(), key=lambda each: each.where)


def _given(folder: Path, option: str, value: str) -> Iterator[_Given]:
    """Yield the parameters that an option gives, or its file."""
    if option in ('-p', '--param') and ':=' in value:
        node, _, name = value.partition(':=')[0].rpartition(':')
        yield _Given(f'/**/{node}' if node else _ALL, name)
    elif option == '--params-file':
        with contextlib.suppress(OSError, yaml.YAMLError, UnicodeDecodeError):
            yield from _of_sections(yaml.safe_load((folder / value).read_text()), '')


def _of_sections(sections: Any, nodes: str) -> Iterator[_Given]:
    """Yield what a file gives to the nodes that its sections name, one within another."""
    for key, inner in sections.items() if isinstance(sections, dict) else ():
        if key == _VALUES:
            yield from (_Given(nodes, name) for name in _flat(inner))
        else:
            yield from _of_sections(inner, f'{nodes}/{str(key).strip("/")}')


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
