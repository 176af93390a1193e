# Copyright 2026 The Husky Playpen Lab authors
# SPDX-License-Identifier: Apache-2.0
"""The definitions of messages as bags keep them, so that a bag can be read anywhere."""

from __future__ import annotations

import re

from rosbag2_py._log import warn
from rosbag2_py._metadata import MessageDefinition
from rosbag2_py.errors import BagError

_NAME = re.compile(r'(\w+)/(?:(msg|srv)/)?(\w+)')
_SEPARATOR = '=' * 80
_EVENT = '_Event'


class LocalMessageDefinitionSource:
    """Finds definitions among the packages that are installed."""

    def get_full_text(self, root_type: str) -> MessageDefinition:
        """
        Join the definition of a message or service and those of all messages inside.

        A name that cannot be one of a type has the encoding 'unknown' and no text.

        :raises BagError: there is no such definition, or it is in IDL.
        """
        from rosidl_runtime_py import definitions  # with numpy: most readers need neither

        match = _NAME.fullmatch(root_type)
        if match is None:
            return empty(root_type)
        package, kind, name = match.groups()
        full_name = f'{package}/{kind or "msg"}/{name}'
        try:
            text, contained = _text(full_name), []
            for each in definitions.contained_types(full_name):
                short = each.replace('/msg/', '/')
                contained.append(f'{_SEPARATOR}\nMSG: {short}\n{_text(each)}')
        except (LookupError, OSError, ValueError) as error:
            raise BagError(f"'{root_type}' has no definition here: {error}") from None
        encoding = 'ros2msg'
        if kind == 'srv':
            text = f'{_SEPARATOR}\nSRV: {root_type}\n{text}'
            encoding = 'ros2msg' if contained else 'unknown'  # as upstream
        return MessageDefinition(root_type, encoding, '\n'.join([text, *contained]), '')


def empty(type_name: str) -> MessageDefinition:
    return MessageDefinition(type_name, 'unknown', '', '')


def definition_or_empty(type_name: str) -> MessageDefinition:
    """Return what a writer keeps of a type: for a service's events the service, or no text."""
    if type_name.endswith(_EVENT) and '/srv/' in type_name:
        type_name = type_name.removesuffix(_EVENT)
    try:
        return LocalMessageDefinitionSource().get_full_text(type_name)
    except BagError as error:
        warn(f'{error}; the bag has none either')
        return empty(type_name)


def _text(type_name: str) -> str:
    from rosidl_runtime_py import definitions, get_interface_path

    if get_interface_path(type_name).endswith('.idl'):
        raise ValueError(f"'{type_name}' is defined in IDL, which is not read here")
    return definitions.text_of(type_name).rstrip('\n') + '\n'
