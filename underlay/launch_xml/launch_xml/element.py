# Copyright 2026 The Husky Playpen Lab authors
# SPDX-License-Identifier: Apache-2.0
"""XML elements that know their line."""

from __future__ import annotations

from xml.parsers import expat

from launch.source_location import located_error


class Element:
    """One element with its attributes, children and text."""

    def __init__(self, tag: str, attributes: dict[str, str], location: tuple[str, int]) -> None:
        self.tag = tag
        self.attributes = attributes
        self.location = location
        self.children: list[Element] = []
        self.text = ''


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
        open_elements[-1].text += characters

    parser.StartElementHandler = start
    parser.EndElementHandler = end
    parser.CharacterDataHandler = data
    try:
        parser.Parse(text.encode(), True)
    except expat.ExpatError as error:
        failure = ValueError(f'XML syntax error: {error}')
        raise located_error(failure, (name, error.lineno)) from None
    return top.children[0]
