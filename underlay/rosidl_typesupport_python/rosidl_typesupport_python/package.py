# Copyright 2026 The Husky Playpen Lab authors
# SPDX-License-Identifier: Apache-2.0
"""The type supports of a package, made when they are asked for."""

from __future__ import annotations

from collections.abc import Callable, Mapping
from functools import cache
from importlib import import_module
from pathlib import Path
import re
from typing import Any

from rosidl_typesupport_python.descriptions import Description, Descriptions
from rosidl_typesupport_python.type_support import ActionSupport, MessageSupport, ServiceSupport

_ATTRIBUTE = re.compile(r'(?P<function>\w+?)_(?P<kind>msg|srv|action)__(?P<name>\w+)')


def capsules_of(package: str, file: str, types: Mapping[str, str]) -> Callable[[str], Any]:
    """
    Return the __getattr__ of the module P_s__rosidl_typesupport_c of a package P.

    It makes the capsules that the classes of rosidl_generator_py ask for, and raises
    AttributeError where there is no such type.

    :param file: of that module, in prefix/lib/pythonX.Y/site-packages/P.
    :param types: the class of each name there: {'srv__set_bool__request': 'SetBool_Request'}.
    """
    return _Package(package, Path(file).parents[4] / 'share' / package, types).capsule


class _Package:
    def __init__(self, name: str, share: Path, types: Mapping[str, str]) -> None:
        self._name = name
        self._types = types
        self._descriptions = cache(lambda interface: Descriptions(share, interface))
        self._message = cache(self._new_message)

    def capsule(self, attribute: str) -> Any:
        asked = _ATTRIBUTE.fullmatch(attribute)
        if not asked or asked['name'] not in self._types:
            raise AttributeError(f'{self._name} has no type support {attribute}')
        support: MessageSupport | ServiceSupport | ActionSupport
        if asked['kind'] == 'msg':
            support = self._message(asked['name'])
        elif asked['kind'] == 'srv':
            support = self._new_service(asked['name'])
        else:
            support = ActionSupport(self._class(asked['name']), self._description(asked['name']))
        return support.capsules[asked['function']]

    def _new_message(self, name: str) -> MessageSupport:
        return MessageSupport(self._class(name), self._description(name))

    def _new_service(self, name: str) -> ServiceSupport:
        parts = tuple(
            self._message(f'{name}__{part}') for part in ('request', 'response', 'event')
        )
        return ServiceSupport(self._class(name), parts, self._description(name))

    def _class(self, name: str) -> Any:
        folder = import_module(f'{self._name}.{name.partition("__")[0]}')
        kind = self._types[name]
        # a part of a service or of an action is in the module of the whole
        whole = getattr(folder, kind.partition('_')[0])
        return getattr(import_module(whole.__module__), kind)

    def _description(self, name: str) -> Description:
        folder, kind = name.partition('__')[0], self._types[name]
        descriptions = self._descriptions(f'{folder}/{kind.partition("_")[0]}')
        return descriptions.addresses(f'{self._name}/{folder}/{kind}')
