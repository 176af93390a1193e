# Copyright 2026 The Husky Playpen Lab authors
# SPDX-License-Identifier: Apache-2.0
"""Attributes that take only values of their type, as those of upstream's compiled classes do."""

from __future__ import annotations

from collections.abc import Callable
import operator
from typing import Any, Generic, overload, TypeVar

T = TypeVar('T')


class Field(Generic[T]):
    """An attribute whose values are converted or refused when they are set.

    Lists and dicts are given out as copies, as upstream does: to change one, set the attribute.

    :raises TypeError: on setting, with the attribute, the value and what it takes.
    """

    def __init__(self, convert: Callable[[Any], T]) -> None:
        self._convert = convert

    def __set_name__(self, owner: type, name: str) -> None:
        self._name = name
        self._slot = f'_{name}'

    @overload
    def __get__(self, instance: None, owner: type) -> Field[T]: ...

    @overload
    def __get__(self, instance: object, owner: type) -> T: ...

    def __get__(self, instance: object | None, owner: type) -> Field[T] | T:
        if instance is None:
            return self
        value: T = instance.__dict__[self._slot]
        return value.copy() if isinstance(value, list | dict) else value  # type: ignore[return-value]

    def __set__(self, instance: object, value: T) -> None:
        try:
            converted = self._convert(value)
        except (TypeError, ValueError, OverflowError) as error:
            place = f'{type(instance).__name__}.{self._name}'
            raise TypeError(f'{place}={value!r}: it takes {error}') from None
        instance.__dict__[self._slot] = converted


def text(value: Any) -> str:
    if isinstance(value, bytes):
        return value.decode()
    if not isinstance(value, str):
        hint = '; write str(...) around the path' if hasattr(value, '__fspath__') else ''
        raise TypeError(f'a str{hint}')
    return value


def whole(bits: int, *, signed: bool = False) -> Callable[[Any], int]:
    """Return a check for whole numbers of so many bits."""
    first = -(2 ** (bits - 1)) if signed else 0
    last = 2 ** (bits - 1 if signed else bits) - 1

    def convert(value: Any) -> int:
        if not hasattr(value, '__index__') or not first <= operator.index(value) <= last:
            raise TypeError(f'a whole number from {first} to {last}')
        return operator.index(value)

    return convert


def one(kind: type[T]) -> Callable[[Any], T]:
    """Return a check for instances of a class."""

    def convert(value: Any) -> T:
        if not isinstance(value, kind):
            raise TypeError(f'a {kind.__name__}')
        return value

    return convert


def many(convert: Callable[[Any], T]) -> Callable[[Any], list[T]]:
    """Return a check for lists and tuples, and for each item."""

    def convert_all(value: Any) -> list[T]:
        if not isinstance(value, list | tuple):
            raise TypeError('a list')
        try:
            return [convert(each) for each in value]
        except TypeError as error:
            raise TypeError(f'a list, each item {error}') from None

    return convert_all


def texts_by_text(value: Any) -> dict[str, str]:
    if not isinstance(value, dict):
        raise TypeError('a dict of str by str')
    return {text(key): text(each) for key, each in value.items()}


def nanoseconds_of(value: Any, *, first: int = -(2**63)) -> int:
    """
    Take a time as a whole number.

    :raises TypeError: it is none, or before the first.
    """
    if not hasattr(value, '__index__') or not first <= operator.index(value) < 2**63:
        hint = '; write .nanoseconds behind it' if hasattr(value, 'nanoseconds') else ''
        whole_number = f'a whole number from {first} to {2**63 - 1}'
        raise TypeError(f'{value!r}: a time is {whole_number}, nanoseconds{hint}')
    return operator.index(value)


def check_kind(value: object, kind: type) -> None:
    """Refuse what is not of a class of rosbag2_py, with a TypeError."""
    if not isinstance(value, kind):
        raise TypeError(f'{value!r}: this takes a rosbag2_py.{kind.__name__}')


def nanoseconds(value: Any) -> int:
    """Take the nanoseconds of an rclpy Time or Duration."""
    if not isinstance(getattr(value, 'nanoseconds', None), int):
        raise TypeError('what has nanoseconds: an rclpy.time.Time or rclpy.duration.Duration')
    return int(value.nanoseconds)
