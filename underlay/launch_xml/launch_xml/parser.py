# Copyright 2026 The Husky Playpen Lab authors
# SPDX-License-Identifier: Apache-2.0
"""From XML to launch descriptions."""

from __future__ import annotations

from pathlib import Path
from typing import TextIO

from launch.frontend import Parser as BaseParser

from .entity import Entity, read_xml


class Parser(BaseParser):
    """Reads launch files in XML."""

    @classmethod
    def load(cls, file: str | TextIO) -> tuple[Entity, BaseParser]:
        if isinstance(file, str):
            with Path(file).open(encoding='utf-8') as opened:
                return cls.load(opened)
        root = read_xml(file.read(), str(getattr(file, 'name', '<text>')))
        return Entity(root), cls()

    @classmethod
    def get_file_extensions(cls) -> set[str]:
        return {'launch.xml', 'xml', 'launch'}
