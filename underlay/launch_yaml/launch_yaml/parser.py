# Copyright 2026 The Husky Playpen Lab authors
# SPDX-License-Identifier: Apache-2.0
"""From YAML to launch descriptions."""

from __future__ import annotations

from pathlib import Path
from typing import Any, TextIO

from launch.frontend import Parser as BaseParser
from launch.logging import get_logger
from launch.source_location import located_error
import yaml

from .entity import Entity


class _LocatedDict(dict[Any, Any]):
    """A mapping with the line it begins at."""

    line = 0


class _Loader(yaml.SafeLoader):
    def construct_located(self, node: yaml.MappingNode) -> _LocatedDict:
        keys = [str(key.value) for key, _ in node.value]
        for key in sorted({key for key in keys if keys.count(key) > 1} - {'<<'}):
            get_logger('launch').warning(
                f"{self.name}:{node.start_mark.line + 1}: '{key}' is given twice: the last counts"
            )
        mapping = _LocatedDict(self.construct_mapping(node, deep=True))
        mapping.line = node.start_mark.line + 1
        return mapping


_Loader.add_constructor('tag:yaml.org,2002:map', _Loader.construct_located)


def _read_yaml(text: str, name: str) -> Any:
    """Return what a document says.

    :raises ValueError: the document is not well formed; says where.
    """
    try:
        loader = _Loader(text)
        loader.name = name
        return loader.get_single_data()
    except yaml.YAMLError as error:
        what = str(getattr(error, 'problem', None) or error)
        failure = ValueError(f'YAML syntax error: {what}')
        mark = getattr(error, 'problem_mark', None)
        line = 1 if mark is None else mark.line + 1
        raise located_error(failure, (name, line)) from None


class Parser(BaseParser):
    """Reads launch files in YAML."""

    @classmethod
    def load(cls, file: str | TextIO) -> tuple[Entity, BaseParser]:
        if isinstance(file, str):
            with Path(file).open(encoding='utf-8') as opened:
                return cls.load(opened)
        name = str(getattr(file, 'name', '<text>'))
        tree = _read_yaml(file.read(), name)
        if not isinstance(tree, dict) or len(tree) != 1:
            raise RuntimeError("a launch file in YAML is one mapping, with the key 'launch:'")
        ((type_name, element),) = tree.items()
        return Entity(element, str(type_name), file=name), cls()

    @classmethod
    def get_file_extensions(cls) -> set[str]:
        return {'launch.yaml', 'launch.yml', 'yaml', 'yml', 'launch'}
