# Copyright 2026 The Husky Playpen Lab authors
# SPDX-License-Identifier: Apache-2.0
"""What a markup launch file is made of."""

from __future__ import annotations

from typing import Any


class Entity:
    """Base of one element of a markup launch file.

    ``type_name`` is the name of the element, as 'node', and ``location`` its file and line, where
    they are known.
    """

    type_name: str
    parent: Entity | None
    location: tuple[str, int] | None = None

    @property
    def children(self) -> list[Entity]:
        raise NotImplementedError

    def assert_entity_completely_parsed(self) -> None:
        """Refuse attributes and children that no parser has read.

        :raises ValueError: names the attributes and elements that nothing knows.
        """
        raise NotImplementedError

    def get_attr(
        self,
        name: str,
        *,
        data_type: Any = str,
        optional: bool = False,
        can_be_str: bool = True,
    ) -> Any:
        """Return an attribute, or the elements of that name for ``List[Entity]``.

        :param can_be_str: text that does not mean the type, as a substitution, is returned as it
            is.
        :raises AttributeError: it is missing and not optional.
        :raises TypeError: it is not of the type.
        """
        raise NotImplementedError
