# Copyright 2026 The Husky Playpen Lab authors
# SPDX-License-Identifier: Apache-2.0

from __future__ import annotations

import argparse
import sys
import time

from ros2cli import arguments, discovery, interfaces
from ros2cli.errors import CommandError
from ros2cli.node.direct import command_node
from ros2cli.verb import VerbExtension
from ros2topic import qos, topics


class CallVerb(VerbExtension):
    """Call a service."""

    def add_arguments(self, parser: argparse.ArgumentParser, cli_name: str) -> None:
        arguments.add_service(
            parser, help="Name of the ROS service to call to (e.g. '/add_two_ints')"
        )
        arguments.add_type(
            parser,
            'service_type',
            'srv',
            help="Type of the ROS service (e.g. 'std_srvs/srv/Empty')",
        )
        group = parser.add_mutually_exclusive_group()
        arguments.add_values(
            group,
            'values',
            'service_type',
            help="Values to fill the service request with in YAML format (e.g. '{a: 1, b: 2}'), "
            'otherwise the service request will be published with default values',
        )
        group.add_argument('--stdin', action='store_true', help='Read values from standard input')
        parser.add_argument(
            '-r',
            '--rate',
            metavar='N',
            type=arguments.positive_float,
            help='Repeat the call at a specific rate in Hz',
        )
        qos.add_qos_arguments(parser, 'service client', 'services_default')

    def main(self, *, args: argparse.Namespace) -> None:
        service_class = interfaces.service(args.service_type)
        request = service_class.Request()
        text = sys.stdin.read() if args.stdin else args.values
        interfaces.populate(request, interfaces.yaml_mapping(text))
        with command_node(args) as node:
            client = node.node.create_client(
                service_class,
                topics.checked_name(args.service_name),
                qos_profile=qos.profile(args),
            )
            if not node.spin_until(client.service_is_ready, 0.2):
                print('waiting for service to become available...')
                discovery.hint_when_not_offered(client.service_name)
                node.spin_until(client.service_is_ready)
            with node.found(client.service_name):
                while True:
                    print(f'requester: making request: {request!r}\n')
                    start = time.monotonic()
                    future = client.call_async(request)
                    node.spin_until_answered(future, client.service_name, client.service_is_ready)
                    if future.exception() is not None:
                        raise CommandError(
                            f'Exception while calling service: {future.exception()!r}'
                        )
                    print(f'response:\n{future.result()!r}\n')
                    if args.rate is None:
                        return
                    left = start + 1.0 / args.rate - time.monotonic()
                    node.spin_until(lambda: False, max(left, 0.0))
