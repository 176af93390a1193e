# Copyright 2026 The Husky Playpen Lab authors
# SPDX-License-Identifier: Apache-2.0
"""XML elements that know their line, and as entities."""

from __future__ import annotations

from collections.abc import Iterable
from typing import Any
from xml.parsers import expat

from launch.frontend import Entity as BaseEntity
from launch.frontend.type_utils import check_is_list_entity
from launch.logging import get_logger
from launch.source_location import located_error
from launch.utilities.type_utils import get_typed_value

# What took the place of attributes of elements.
_OF_ROS_1 = {
    ('arg', 'doc'): 'description',
    ('arg', 'value'): 'default',
    ('group', 'ns'): '<push_ros_namespace namespace="NS"/> inside of it',
    ('include', 'ns'): 'a <group> around it that begins with <push_ros_namespace namespace="NS"/>',
    ('node', 'ns'): 'namespace',
    ('node', 'required'): 'on_exit="shutdown"',
    ('node', 'type'): 'exec',
}


class Element:
    """One element with its attributes and children, and whether it has text, too."""

    def __init__(self, tag: str, attributes: dict[str, str], location: tuple[str, int]) -> None:
        self.tag = tag
        self.attributes = attributes
        self.location = location
        self.children: list[Element] = []
        self.has_text = False


def read_xml(text: str, name: str) -> Element:
    """Return the root element of a document.

    :raises ValueError: the document is not well formed; says where.
    """
    parser = expat.ParserCreate()
    top = Element('', {}, (name, 0))
    open_elements = [top]

    def start(tag: str, attributes: dict[str, str]) -> None:
        element = Element(tag, attributes, (name, parser.CurrentLineNumber))
        open_elements[-1].children.append(element)
        open_elements.append(element)

    def end(_tag: str) -> None:
        open_elements.pop()

    def data(characters: str) -> None:
        text, element = characters.strip(), open_elements[-1]
        if text and not element.has_text:
            element.has_text = True
            get_logger('launch').warning(
                f"{name}:{parser.CurrentLineNumber}: text '{text}' in element '{element.tag}' is "
                'passed over: values are attributes'
            )

    parser.StartElementHandler = start
    parser.EndElementHandler = end
    parser.CharacterDataHandler = data
    try:
        parser.Parse(text, True)  # as text: what the document says of its encoding is over
    except expat.ExpatError as error:
        failure = ValueError(f'XML syntax error: {error}')
        raise located_error(failure, (name, error.lineno)) from None
    return top.children[0]


class Entity(BaseEntity):
    """One XML element, whose attributes are read as the wanted types."""

    def __init__(self, xml_element: Element, *, parent: Entity | None = None) -> None:
        self.__xml = xml_element
        self.type_name = xml_element.tag
        self.parent = parent
        self.location = xml_element.location
        self.__read_attributes: set[str] = set()
        self.__read_children: set[str] = set()

    @property
    def children(self) -> list[BaseEntity]:
        self.__read_children = {child.tag for child in self.__xml.children}
        return [Entity(child, parent=self) for child in self.__xml.children]

    def assert_entity_completely_parsed(self) -> None:
        tags = {child.tag for child in self.__xml.children} - self.__read_children
        if tags:
            raise ValueError(
                f'Unexpected nested tag(s) found in `{self.type_name}`: {", ".join(sorted(tags))}'
            )
        attributes = set(self.__xml.attributes) - self.__read_attributes
        if attributes:
            raise ValueError(
                f'Unexpected attribute(s) found in `{self.type_name}`: '
                f'{", ".join(sorted(attributes))}{self.__hint(attributes)}'
            )

    def __hint(self, attributes: Iterable[str]) -> str:
        old = [each for each in sorted(attributes) if (self.type_name, each) in _OF_ROS_1]
        news = [f'{each} of ROS 1 is {_OF_ROS_1[self.type_name, each]} now' for each in old]
        return f' ({", ".join(news)})' if news else ''

    def get_attr(
        self,
        name: str,
        *,
        data_type: Any = str,
        optional: bool = False,
        can_be_str: bool = True,
    ) -> Any:
        value: Any
        if check_is_list_entity(data_type):
            value = [
                Entity(child, parent=self) for child in self.__xml.children if child.tag == name
            ]
            self.__read_children.add(name)
            value = value or None
        else:
            value = self.__value(name, data_type, can_be_str)
        if value is None and not optional:
            kind = getattr(data_type, '__name__', data_type)
            raise AttributeError(
                f"Attribute '{name}' of type '{kind}' not found in Entity '{self.type_name}'"
                f'{self.__hint(self.__xml.attributes)}'
            )
        return value

    def __value(self, name: str, data_type: Any, can_be_str: bool) -> Any:
        self.__read_attributes |= {name, f'{name}-sep'} & set(self.__xml.attributes)
        text = self.__xml.attributes.get(name)
        if text is None:
            return None
        separator = self.__xml.attributes.get(f'{name}-sep')
        value = text if separator is None else text.split(separator)
        try:
            return get_typed_value(value, data_type, can_be_str=can_be_str)
        except ValueError:
            raise TypeError(
                f"Attribute '{name}' of Entity '{self.type_name}' expected to be of type "
                f"'{data_type}'. '{text}' can not be converted to one of those types"
            ) from None
