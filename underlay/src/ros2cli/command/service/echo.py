# Copyright 2026 The Husky Playpen Lab authors
# SPDX-License-Identifier: Apache-2.0
"""Echo a service.

The requests and responses are those that clients and servers tell of themselves: they do so only
where their code (or the parameter for it) turns service introspection on.
"""

from __future__ import annotations

import argparse
from typing import Any

from rclpy.qos import QoSPresetProfiles
from rosidl_runtime_py import message_to_csv, message_to_yaml

from ros2cli import completion, discovery, interfaces, names
from ros2cli.arguments import nonnegative_int
from ros2cli.errors import CommandError
from ros2cli.node import command_node


def add_arguments(parser: argparse.ArgumentParser) -> None:
    discovery.add_arguments(parser)
    completion.service(
        parser.add_argument(
            'service_name', help="Name of the ROS service to echo (e.g. '/add_two_ints')"
        )
    )
    completion.service_type(
        parser.add_argument(
            'service_type', nargs='?', help="Type of the ROS service (e.g. 'std_srvs/srv/Empty')"
        )
    )
    parser.add_argument(
        '--csv', action='store_true', help='Output all recursive fields separated by commas'
    )
    parser.add_argument(
        '--full-length',
        '-f',
        action='store_true',
        help='Output all elements of arrays and strings',
    )
    parser.add_argument(
        '--truncate-length',
        '-l',
        type=nonnegative_int,
        default=128,
        help='The length to truncate arrays, bytes, and string to (default: %(default)s)',
    )
    parser.add_argument(
        '--no-arr', action='store_true', help="Don't print array fields of messages"
    )
    parser.add_argument(
        '--no-str', action='store_true', help="Don't print string fields of messages"
    )
    parser.add_argument(
        '--flow-style', action='store_true', help='Print collections in the block style'
    )


def main(args: argparse.Namespace) -> None:
    name = names.expand(args.service_name)
    service_class = interfaces.service(args.service_type or _type_of(args, name))
    options = {
        'truncate_length': None if args.full_length else args.truncate_length,
        'no_arr': args.no_arr,
        'no_str': args.no_str,
    }

    def on_event(msg: Any) -> None:
        if args.csv:
            print(message_to_csv(msg, **options))
        else:
            print(message_to_yaml(msg, flow_style=args.flow_style, **options), end='---\n')

    with command_node(args) as node:
        node.node.create_subscription(
            service_class.Event,
            f'{name}/_service_event',
            on_event,
            QoSPresetProfiles.get_from_short_key('services_default'),
        )
        node.spin_until(lambda: False)


def _type_of(args: argparse.Namespace, name: str) -> str:
    types = discovery.read_graph(args).services().get(name)
    if not types:
        raise CommandError(
            f'WARNING: service [{name}] does not appear to be available yet\n'
            'Could not load the type for the passed service'
        )
    return types[0]
