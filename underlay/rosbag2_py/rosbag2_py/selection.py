# Copyright 2026 The Husky Playpen Lab authors
# SPDX-License-Identifier: Apache-2.0
"""Which topics are written, and which are read."""

from __future__ import annotations

from collections.abc import Callable
import re
from typing import Any

from rosbag2_py._compression_options import CompressionMode
from rosbag2_py._fields import Field, many, text
from rosbag2_py._options import StorageFilter
from rosbag2_py.errors import BagError

EVENTS = '/_service_event'
"""Ends the names of the topics that tell what a service does."""


def pattern(text: str) -> re.Pattern[str] | None:
    """
    Compile an expression; None where none is given.

    :raises BagError: it is none.
    """
    try:
        return re.compile(text) if text else None
    except re.error as error:
        raise BagError(f"'{text}' is no regular expression: {error}") from None


def wanted(storage_filter: StorageFilter) -> Callable[[str], bool]:
    """
    Return whether a filter lets a topic pass.

    :raises BagError: an expression is none.
    """
    regex = pattern(storage_filter.regex)
    exclude_regex = pattern(storage_filter.regex_to_exclude)
    topics, events = storage_filter.topics, storage_filter.services_events
    exclude_topics = storage_filter.exclude_topics
    exclude_events = storage_filter.exclude_service_events

    def passes(topic: str) -> bool:
        is_event = topic.endswith(EVENTS) and topic != EVENTS
        included, excluded = (events, exclude_events) if is_event else (topics, exclude_topics)
        if topic in excluded or (exclude_regex and exclude_regex.fullmatch(topic)):
            return False
        if not included and not regex:
            return True
        return topic in included or bool(regex and regex.fullmatch(topic))

    return passes


def _yes_or_no(value: Any) -> bool:
    if not isinstance(value, bool):
        raise TypeError('true or false')
    return value


def _mode(value: Any) -> CompressionMode:
    """Take a mode, or its name in letters of either kind; nothing is NONE."""
    if isinstance(value, CompressionMode):
        return value
    try:
        return CompressionMode[text(value).upper() or 'NONE']
    except KeyError:
        raise TypeError('none, file or message') from None


def _unset(why: str) -> Any:
    """Return a check of what is not offered: it may be empty."""

    def convert(value: Any) -> str:
        if value:
            raise TypeError(f'nothing: {why}')
        return ''

    return convert


class Selection:
    """Which topics a bag is given; the names are those of upstream's RecordOptions."""

    all_topics = Field(_yes_or_no)
    all_services = Field(_yes_or_no)
    topics = Field(many(text))
    topic_types = Field(many(text))
    services = Field(many(text))
    regex = Field(text)
    exclude_topics = Field(many(text))
    exclude_topic_types = Field(many(text))
    exclude_services = Field(many(text))
    exclude_regex = Field(text)
    include_hidden_topics = Field(_yes_or_no)
    compression_mode = Field(_mode)
    compression_format = Field(text)
    rmw_serialization_format = Field(_unset('messages stay as they are'))

    def __init__(self) -> None:
        self.all_topics = self.all_services = self.include_hidden_topics = False
        self.topics = self.topic_types = self.services = []
        self.exclude_topics = self.exclude_topic_types = self.exclude_services = []
        self.regex = self.exclude_regex = self.compression_format = ''
        self.compression_mode = CompressionMode.NONE

    def is_empty(self) -> bool:
        return not (
            self.all_topics
            or self.all_services
            or self.topics
            or self.topic_types
            or self.services
            or self.regex
        )

    def wants(self, name: str, type_name: str, *, also_hidden: bool = False) -> bool:
        """Return whether a topic is chosen; one whose name is hidden only where that is asked."""
        if name.endswith(EVENTS) and type_name.endswith('_Event'):
            service = name.removesuffix(EVENTS)
            named = bool({name, service} & set(self.services))
            excluded = bool({name, service} & set(self.exclude_services))
            return not excluded and self._passes(service, named or self.all_services)
        named = name in self.topics or type_name in self.topic_types
        if name in self.exclude_topics or type_name in self.exclude_topic_types:
            return False
        if not (self.include_hidden_topics or also_hidden) and '/_' in name:
            return False
        return self._passes(name, named or self.all_topics)

    def _passes(self, name: str, named: bool) -> bool:  # noqa: FBT001
        wanted, unwanted = pattern(self.regex), pattern(self.exclude_regex)
        if unwanted and unwanted.search(name):
            return False
        return named or bool(wanted and wanted.search(name))
