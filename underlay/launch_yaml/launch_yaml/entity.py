# Copyright 2026 The Husky Playpen Lab authors
# SPDX-License-Identifier: Apache-2.0
"""YAML mappings as entities."""

from __future__ import annotations

from collections.abc import Mapping
from typing import Any

from launch.frontend import Entity as BaseEntity
from launch.frontend.type_utils import check_is_list_entity
from launch.source_location import located_error
from launch.utilities.type_utils import is_instance_of


class Entity(BaseEntity):
    """One YAML mapping of attributes, or a list of children."""

    def __init__(
        self,
        element: Any,
        type_name: str,
        *,
        file: str,
        line: int = 1,
        parent: Entity | None = None,
    ) -> None:
        self.__element = {} if element is None else element
        self.type_name = type_name
        self.parent = parent
        self.location: tuple[str, int] = file, line
        self.__read_keys: set[str] = set()
        if not isinstance(self.__element, (Mapping, list)):
            raise located_error(
                TypeError(
                    f"'{type_name}' is {element!r}, expected its attributes (key: value) or a list"
                ),
                self.location,
            )

    @property
    def children(self) -> list[BaseEntity]:
        children = self.__element
        if isinstance(children, Mapping):
            if 'children' not in children:
                raise ValueError(f"Expected entity `{self.type_name}` to have 'children'")
            self.__read_keys.add('children')
            children = children['children']
        if not isinstance(children, list):
            raise TypeError(f'Expected a list in `{self.type_name}`, got {children!r}')
        return [self.__child(child) for child in children]

    def __child(self, child: Any) -> Entity:
        if not isinstance(child, Mapping) or len(child) != 1:
            raise RuntimeError(
                f'{child!r} in `{self.type_name}`: Subentities must be dictionaries with a '
                'single key, as "- node: ..." (check the indentation)'
            )
        ((name, element),) = child.items()
        return self.__entity(element, str(name), child)

    def __entity(self, element: Any, name: str, mapping: Any) -> Entity:
        """Return an entity that begins at the line of the mapping."""
        file, line = self.location
        return Entity(element, name, file=file, line=getattr(mapping, 'line', line), parent=self)

    def assert_entity_completely_parsed(self) -> None:
        if isinstance(self.__element, list):
            return
        unread = {str(key) for key in self.__element} - self.__read_keys
        if unread:
            raise ValueError(
                f'Unexpected key(s) found in `{self.type_name}`: {", ".join(sorted(unread))}'
            )

    def get_attr(
        self,
        name: str,
        *,
        data_type: Any = str,
        optional: bool = False,
        can_be_str: bool = True,
    ) -> Any:
        if not isinstance(self.__element, Mapping) or name not in self.__element:
            if optional:
                return None
            raise AttributeError(f"Can not find attribute '{name}' in Entity '{self.type_name}'")
        self.__read_keys.add(name)
        value = self.__element[name]
        where = f"Attribute '{name}' of Entity '{self.type_name}'"
        if check_is_list_entity(data_type):
            if isinstance(value, list) and all(isinstance(item, Mapping) for item in value):
                return [self.__entity(item, name, item) for item in value]
            raise TypeError(f'{where} expected to be a list of dictionaries, got {value!r}')
        if not is_instance_of(value, data_type, can_be_str=can_be_str):
            kind = getattr(data_type, '__name__', data_type)
            hint = {str: ': put it in quotes', float: ': write it with a point'}.get(data_type, '')
            raise TypeError(f"{where} expected to be of type '{kind}', got {value!r}{hint}")
        return value
