# Copyright 2026 The Husky Playpen Lab authors
# SPDX-License-Identifier: Apache-2.0
"""From markup launch files to launch descriptions."""

from __future__ import annotations

from pathlib import Path
from typing import Any, TextIO, TYPE_CHECKING
import warnings

# Upstream's name of what finds the entry points.
import entry_point_index as importlib_metadata

from ..invalid_launch_file_error import InvalidLaunchFileError
from ..source_location import attach_location
from ..substitution import Substitution
from ..utilities.encoding import refuse_utf_16
from .entity import Entity
from .expose import instantiate_action, load_entry_points, load_extensions
from .parse_substitution import (
    parse_if_substitutions,
    parse_substitution,
    replace_escaped_characters,
)

if TYPE_CHECKING:
    from ..action import Action
    from ..launch_description import LaunchDescription


class InvalidFrontendLaunchFileError(InvalidLaunchFileError):
    """Raised when a markup launch file cannot be read."""


class Parser:
    """Base of the parsers of the markup languages, which implement :meth:`load`."""

    frontend_parsers: dict[str, type[Parser]] | None = None

    @classmethod
    def load_launch_extensions(cls) -> None:
        """Make the actions and substitutions of launch and launch_ros known."""
        load_extensions()

    @classmethod
    def load_parser_implementations(cls) -> None:
        if Parser.frontend_parsers is None:
            group = 'launch.frontend.parser'
            Parser.frontend_parsers = load_entry_points(group, 'parser extension')

    @classmethod
    def _parsers(cls) -> dict[str, type[Parser]]:
        cls.load_parser_implementations()
        return Parser.frontend_parsers or {}

    def parse_action(self, entity: Entity) -> Action:
        """Return the action that an element means.

        Errors are told the file and line.
        """
        try:
            action = instantiate_action(entity, self)
            entity.assert_entity_completely_parsed()
        except Exception as error:
            attach_location(error, entity.location)
            raise
        return action

    def parse_substitution(self, value: str) -> list[Substitution]:
        return parse_substitution(value)

    def parse_if_substitutions(self, value: Any) -> Any:
        return parse_if_substitutions(value)

    def parse_pairs(
        self, entity: Entity, tag: str, first: str, second: str
    ) -> list[tuple[list[Substitution], list[Substitution]]]:
        """Return two attributes of each child with the tag, which may have no others."""
        pairs = []
        for child in entity.get_attr(tag, data_type=list[Entity], optional=True) or ():
            text = self.parse_substitution(child.get_attr(first))
            pairs.append((text, self.parse_substitution(child.get_attr(second))))
            child.assert_entity_completely_parsed()
        return pairs

    def escape_characters(self, value: str) -> str:
        return replace_escaped_characters(value)

    def parse_description(self, entity: Entity) -> LaunchDescription:
        """Return the launch description of the root element."""
        from ..launch_description import LaunchDescription

        try:
            if entity.type_name != 'launch':
                raise RuntimeError(f"Expected 'launch' as root tag, got '{entity.type_name}'")
            actions = [self.parse_action(child) for child in entity.children]
            deprecated = entity.get_attr('deprecated', optional=True)
            # As upstream, other attributes are passed over: many files have a version.
        except Exception as error:
            attach_location(error, entity.location)
            raise
        return LaunchDescription(actions, deprecated_reason=deprecated)

    @classmethod
    def may_parse(cls, filename: str) -> bool:
        """Return whether the name is one of a file of this language."""
        return any(filename.endswith('.' + end) for end in cls.get_file_extensions())

    @classmethod
    def get_file_extensions(cls) -> set[str]:
        """Return the endings of file names of this language, without the dot."""
        return set()

    @classmethod
    def get_available_extensions(cls) -> list[str]:
        return list(cls._parsers())

    @classmethod
    def is_extension_valid(cls, extension: str) -> bool:
        _warn_of('is_extension_valid', 'is_filename_valid')
        return extension in cls._parsers()

    @classmethod
    def get_parser_from_extension(cls, extension: str) -> type[Parser]:
        """Return the parser that is registered under a name, as 'xml'.

        :raises RuntimeError: there is none.
        """
        _warn_of('get_parser_from_extension', 'get_parsers_from_filename')
        if extension not in cls._parsers():
            raise RuntimeError(f"no parser is registered under the name '{extension}'")
        return cls._parsers()[extension]

    @classmethod
    def is_filename_valid(cls, filename: str) -> bool:
        return any(parser.may_parse(filename) for parser in cls._parsers().values())

    @classmethod
    def get_parsers_from_filename(cls, filename: str) -> list[type[Parser]]:
        return [parser for parser in cls._parsers().values() if parser.may_parse(filename)]

    @classmethod
    def get_file_extensions_from_parsers(cls) -> list[str]:
        ends = [parser.get_file_extensions() for parser in cls._parsers().values()]
        return sorted(set().union(*ends))

    @classmethod
    def load(cls, file: str | TextIO) -> tuple[Entity, Parser]:
        """Read a file in the language its name says, else in any that reads it.

        :raises InvalidFrontendLaunchFileError: none could.
        """
        if isinstance(file, (str, Path)):
            refuse_utf_16(file)
            with Path(file).open(encoding='utf-8') as opened:
                return Parser.load(opened)
        name = str(getattr(file, 'name', ''))
        errors: list[Exception] = []
        for parser in cls.get_parsers_from_filename(name) or list(cls._parsers().values()):
            try:
                return parser.load(file)
            except Exception as error:
                errors.append(error)
                file.seek(0)
        known = bool(cls.get_parsers_from_filename(name))
        extension = Path(name).suffix[1:] if known else ''
        raise InvalidFrontendLaunchFileError(extension, likely_errors=errors)


def _warn_of(old: str, new: str) -> None:
    warnings.warn(f'Parser.{old} is deprecated, use Parser.{new} instead', stacklevel=3)


__all__ = ['InvalidFrontendLaunchFileError', 'Parser', 'importlib_metadata']
