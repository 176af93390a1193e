# Copyright 2026 The Husky Playpen Lab authors
# SPDX-License-Identifier: Apache-2.0

from __future__ import annotations

import argparse

from rclpy.qos import QoSPresetProfiles
from ros2cli import arguments, discovery, interfaces
from ros2cli.errors import CommandError
from ros2cli.node.direct import command_node
from ros2cli.verb import VerbExtension
from ros2topic import printing
from rtps_graph import names


class EchoVerb(VerbExtension):
    """Echo a service.

    The requests and responses are those that clients and servers tell of themselves: they do so
    only where their code (or the parameter for it) turns service introspection on.
    """

    def add_arguments(self, parser: argparse.ArgumentParser, cli_name: str) -> None:
        discovery.add_arguments(parser)
        arguments.add_service(
            parser, help="Name of the ROS service to echo (e.g. '/add_two_ints')"
        )
        arguments.add_type(
            parser,
            'service_type',
            'srv',
            nargs='?',
            help="Type of the ROS service (e.g. 'std_srvs/srv/Empty')",
        )
        printing.add_arguments(parser)

    def main(self, *, args: argparse.Namespace) -> None:
        name = names.expand(args.service_name)
        service_class = interfaces.service(args.service_type or _type_of(args, name))
        with command_node(args) as node:
            node.node.create_subscription(
                service_class.Event,
                f'{name}/_service_event',
                lambda msg: printing.show(msg, args),
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
