# Copyright 2026 The Husky Playpen Lab authors
# SPDX-License-Identifier: Apache-2.0
"""What a file of `output_bags` says: into which bags others are written, and what of them."""

from __future__ import annotations

from dataclasses import dataclass, field
import difflib
from pathlib import Path

from rosbag2_py import yaml_files
from rosbag2_py._fields import Field
from rosbag2_py._options import StorageOptions
from rosbag2_py.errors import BagError
from rosbag2_py.selection import pattern, Selection

_KEY = 'output_bags'
# Of a recording; to rewrite a bag, upstream takes them as well and does nothing by them.
_OF_RECORDINGS = (
    'compression_queue_size',
    'compression_threads',
    'compression_threads_priority',
    'disable_keyboard_controls',
    'ignore_leaf_topics',
    'include_unpublished_topics',
    'is_discovery_disabled',
    'node_prefix',
    'start_paused',
    'topic_polling_interval',
    'topic_qos_profile_overrides',
    'use_sim_time',
)
_OLDER = {'exclude': ('exclude_regex',), 'all': ('all_topics', 'all_services')}


@dataclass
class OutputBag:
    storage: StorageOptions = field(default_factory=lambda: StorageOptions(''))
    selection: Selection = field(default_factory=Selection)


def read_output_bags(path: Path) -> list[OutputBag]:
    """
    Read such a file, which is YAML.

    :raises BagError: there is none, or something in it is not understood.
    """
    content = yaml_files.read(path)
    bags = content.get(_KEY) if isinstance(content, dict) else None
    if not isinstance(bags, list) or not bags:
        raise BagError(
            f"'{path}' has no list {_KEY}; for one bag write "
            f'{_KEY}: [{{uri: new_bag, all_topics: true}}]'
        )
    return [
        _output_bag(options, f"'{path}': {_KEY}, number {number}")
        for number, options in enumerate(bags, start=1)
    ]


def _output_bag(options: object, place: str) -> OutputBag:
    if not isinstance(options, dict):
        raise BagError(f'{place}: {options!r} is no options; a bag has at least a uri')
    bag = OutputBag()
    offered = {name: part for part in (bag.storage, bag.selection) for name in _fields_of(part)}
    for name, value in options.items():
        if name in _OF_RECORDINGS or (name == 'all' and value is False):
            continue
        for each in _OLDER.get(name, (name,)):
            if each not in offered:
                near = difflib.get_close_matches(str(each), offered, 1)
                hint = f'did you mean {near[0]}?' if near else f'there are {", ".join(offered)}'
                raise BagError(f'{place}: there is no option {each}; {hint}')
            try:
                setattr(offered[each], each, value)
            except TypeError as error:
                raise BagError(f'{place}: {str(error).partition(".")[2]}') from None
    if not bag.storage.uri:
        raise BagError(f'{place}: it has no uri, the folder to make')
    for expression in (bag.selection.regex, bag.selection.exclude_regex):
        pattern(expression)
    return bag


def _fields_of(part: object) -> list[str]:
    return [name for name, value in vars(type(part)).items() if isinstance(value, Field)]
