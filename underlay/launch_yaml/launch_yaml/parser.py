# Copyright 2026 The Husky Playpen Lab authors
# SPDX-License-Identifier: Apache-2.0
"""From YAML to launch descriptions."""

from __future__ import annotations

from pathlib import Path
from typing import TextIO

from launch.frontend import Parser as BaseParser

from .entity import Entity
from .located_yaml import read_yaml


class Parser(BaseParser):
    """Reads launch files in YAML."""

    @classmethod
    def load(cls, file: str | TextIO) -> tuple[Entity, BaseParser]:
        if isinstance(file, str):
            with Path(file).open(encoding='utf-8') as opened:
                return cls.load(opened)
        name = str(getattr(file, 'name', '<text>'))
        tree = read_yaml(file.read(), name)
        if not isinstance(tree, dict) or len(tree) != 1:
            raise RuntimeError("a launch file in YAML is one mapping, with the key 'launch:'")
        ((type_name, element),) = tree.items()
        return Entity(element, str(type_name), file=name), cls()

    @classmethod
    def get_file_extensions(cls) -> set[str]:
        return {'launch.yaml', 'launch.yml', 'yaml', 'yml'}
