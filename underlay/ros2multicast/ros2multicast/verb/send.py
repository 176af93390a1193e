# Copyright 2026 The Husky Playpen Lab authors
# SPDX-License-Identifier: Apache-2.0

from __future__ import annotations

import argparse

from ros2multicast import verb
from ros2multicast.api import send


class SendVerb(verb.VerbExtension):
    """Send a single UDP multicast packet."""

    def add_arguments(self, parser: argparse.ArgumentParser, cli_name: str) -> None:
        verb.add_group_argument(parser)
        verb.add_port_argument(parser)
        parser.add_argument('--ttl', type=verb.positive_int, help='The multicast TTL')

    def main(self, *, args: argparse.Namespace) -> None:
        print('Sending one UDP multicast datagram...')
        with verb.refusals(args):
            send(b'Hello World!', group=args.group, port=args.port, ttl=args.ttl)
