# Copyright 2026 The Husky Playpen Lab authors
# SPDX-License-Identifier: Apache-2.0
"""Which topics and services of a graph are recorded."""

from __future__ import annotations

import argparse
import re

from ros2cli import arguments
from ros2cli.errors import UsageError
from rosbag2_py.selection import EVENTS, Selection
from rtps_graph import names

_MANY_TOPICS = ('all', 'all_topics', 'topic_types', 'regex')
# Upstream's rule: what leaves something out needs one of those that choose more than by name.
_NEEDED = {
    'exclude_regex': (*_MANY_TOPICS, 'all_services'),
    'exclude_topics': _MANY_TOPICS,
    'exclude_topic_types': _MANY_TOPICS,
    'exclude_services': ('all', 'all_services', 'regex'),
}
# Who gives these beside one that takes all means to choose among them, and upstream warns, too.
_OVERRIDING = {
    'topics': ('all', 'all_topics'),
    'services': ('all', 'all_services'),
    'regex': ('all', 'all_topics', 'all_services'),
}
_TAKEN = {'all': 'everything', 'all_topics': 'every topic', 'all_services': 'every service'}


def add_arguments(parser: argparse.ArgumentParser) -> None:
    arguments.add_topic(
        parser, 'topics_positional', nargs='*', metavar='topics', help='Topics to be recorded'
    )
    lists = {
        '--topics': ('Topic', 'Topics to record.'),
        '--services': ('Service', 'Services to record, whose introspection is on.'),
        '--topic-types': ('Type', 'Record the topics of these types, as std_msgs/msg/String.'),
        '--exclude-topics': ('Topic', 'Topics not to record.'),
        '--exclude-topic-types': ('Type', 'Types whose topics are not recorded.'),
        '--exclude-services': ('Service', 'Services not to record.'),
    }
    for option, (metavar, text) in lists.items():
        parser.add_argument(option, nargs='+', default=[], metavar=metavar, help=text)
    arguments.add_flags(
        parser,
        {
            '-a --all': 'Record all topics, hidden ones excluded, and all services.',
            '--all-topics': 'Record all topics, hidden ones excluded.',
            '--all-services': 'Record all services whose introspection is on.',
            '--include-hidden-topics': 'Record hidden topics as well.',
        },
    )
    add_expression(parser, '-e', '--regex', help='Record what has a match of this in its name.')
    add_expression(parser, '--exclude-regex', help='Leave out what has a match in its name.')


def add_expression(parser: argparse.ArgumentParser, *spellings: str, help: str) -> None:  # noqa: A002
    parser.add_argument(*spellings, type=_expression, default='', help=help)


def event_topics(services: list[str]) -> list[str]:
    """Return the topics that tell what services do."""
    return [names.expand(service) + EVENTS for service in services]


def selection(args: argparse.Namespace) -> Selection:
    """
    Return what the options choose.

    :raises UsageError: they choose nothing, or do not go together.
    """
    chosen = [names.expand(topic) for topic in (*args.topics_positional, *args.topics)]
    choosing = (*_MANY_TOPICS, 'all_services', 'topics', 'services')
    if not (chosen or any(getattr(args, name) for name in choosing)):
        raise UsageError(f'Need to specify one option out of {_options(choosing)}')
    for name, needed in _NEEDED.items():
        if getattr(args, name) and not any(getattr(args, each) for each in needed):
            raise UsageError(f'{_options([name])} goes with one of {_options(needed)}')
    found = Selection()
    found.all_topics = args.all or args.all_topics
    found.all_services = args.all or args.all_services
    found.include_hidden_topics = args.include_hidden_topics
    found.topics, found.topic_types = chosen, args.topic_types
    found.services = [*event_topics(args.services), *(t for t in chosen if t.endswith(EVENTS))]
    found.regex, found.exclude_regex = args.regex, args.exclude_regex
    found.exclude_topics = [names.expand(topic) for topic in args.exclude_topics]
    found.exclude_topic_types = args.exclude_topic_types
    found.exclude_services = event_topics(args.exclude_services)
    return found


def overridden(args: argparse.Namespace) -> list[str]:
    """Return a line for each option that leaves nothing out, because another takes all."""
    given = {**vars(args), 'topics': [*args.topics_positional, *args.topics]}
    lines = []
    for name, overriding in _OVERRIDING.items():
        over = next((each for each in overriding if given[each]), None)
        if given[name] and over:
            option = _options([over])
            lines.append(
                f'{option} records {_TAKEN[over]}: {_options([name])} beside it leaves none out; '
                f'to choose, leave out {option}'
            )
    return lines


def _options(attributes: tuple[str, ...] | list[str]) -> str:
    return ', '.join('--' + name.replace('_', '-') for name in attributes)


def _expression(text: str) -> str:
    try:
        re.compile(text)
    except re.error as error:
        message = f"'{text}' is no regular expression: {error}"
        raise argparse.ArgumentTypeError(message) from None
    return text
