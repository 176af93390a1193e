# Copyright 2026 The Husky Playpen Lab authors
# SPDX-License-Identifier: Apache-2.0
"""YAML mappings that know their line."""

from __future__ import annotations

from typing import Any

from launch.source_location import located_error
import yaml


class LocatedDict(dict[Any, Any]):
    """A mapping with the line it begins at."""

    line = 0


class _Loader(yaml.SafeLoader):
    def construct_located(self, node: yaml.MappingNode) -> LocatedDict:
        self.flatten_mapping(node)
        mapping = LocatedDict(self.construct_mapping(node, deep=True))
        if len(mapping) != len(node.value):
            raise yaml.constructor.ConstructorError(
                None, None, 'a key is given twice', node.start_mark
            )
        mapping.line = node.start_mark.line + 1
        return mapping


_Loader.add_constructor('tag:yaml.org,2002:map', _Loader.construct_located)


def read_yaml(text: str, name: str) -> Any:
    """Return what a document says.

    :raises ValueError: the document is not well formed; says where.
    """
    try:
        return yaml.load(text, Loader=_Loader)  # a SafeLoader
    except yaml.YAMLError as error:
        what = str(getattr(error, 'problem', None) or error)
        failure = ValueError(f'YAML syntax error: {what}')
        mark = getattr(error, 'problem_mark', None)
        line = 1 if mark is None else mark.line + 1
        raise located_error(failure, (name, line)) from None
