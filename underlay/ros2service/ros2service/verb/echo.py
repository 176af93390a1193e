# Copyright 2026 The Husky Playpen Lab authors
# SPDX-License-Identifier: Apache-2.0

from __future__ import annotations

import argparse
import sys
from typing import Any

from rclpy.qos import QoSPresetProfiles
from ros2cli import arguments, discovery, interfaces
from ros2cli.errors import CommandError
from ros2cli.node.direct import command_node
from ros2cli.verb import VerbExtension
from ros2topic import printing
from rtps_graph import names
from rtps_graph.graph import Role
from service_msgs.msg import ServiceEventInfo

_EVENTS = {
    getattr(ServiceEventInfo, name): name
    for name in ('REQUEST_SENT', 'REQUEST_RECEIVED', 'RESPONSE_SENT', 'RESPONSE_RECEIVED')
}


class EchoVerb(VerbExtension):
    """Echo a service.

    The requests and responses are those that clients and servers tell of themselves: they do so
    only where their code (or the parameter for it) turns service introspection on.
    """

    def add_arguments(self, parser: argparse.ArgumentParser, cli_name: str) -> None:
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
        events = f'{name}/_service_event'

        def on_event(msg: Any) -> None:
            if args.csv:
                printing.show(msg, args)
                return
            number = msg.info.event_type
            # The event's own type comes first, in front of the request and the response.
            told = f'event_type: {_EVENTS.get(number, number)}'
            text = printing.as_yaml(msg, args).replace(f'event_type: {number}', told, 1)
            print(text, end='---\n')

        with command_node(args) as node:
            node.node.create_subscription(
                service_class.Event,
                events,
                on_event,
                QoSPresetProfiles.get_from_short_key('services_default'),
            )
            if not discovery.read_graph(args, quiet=True).with_role(Role.PUBLISHER, events):
                print(
                    f"hint: nobody publishes '{events}': service introspection is off, at the "
                    'server as at the clients',
                    file=sys.stderr,
                )
            node.spin_until(lambda: False)


def _type_of(args: argparse.Namespace, name: str) -> str:
    known = discovery.read_graph(args).services()
    types = known.get(name)
    if not types:
        raise CommandError(f"Cannot find type for '{name}'{discovery.near(name, known)}")
    if len(types) > 1:
        raise CommandError(f"More than one type associated with service '{name}'")
    return types[0]
