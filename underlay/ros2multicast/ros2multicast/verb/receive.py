# Copyright 2026 The Husky Playpen Lab authors
# SPDX-License-Identifier: Apache-2.0

from __future__ import annotations

import argparse
from contextlib import suppress

from ros2multicast import verb
from ros2multicast.api import receive


class ReceiveVerb(verb.VerbExtension):
    """Receive a single UDP multicast packet."""

    def add_arguments(self, parser: argparse.ArgumentParser, cli_name: str) -> None:
        verb.add_group_argument(parser)
        verb.add_port_argument(parser)

    def main(self, *, args: argparse.Namespace) -> None:
        print('Waiting for UDP multicast datagram...')
        with suppress(KeyboardInterrupt), verb.refusals(args):
            data, (host, port) = receive(group=args.group, port=args.port)
            print(f"Received from {host}:{port}: '{data.decode(errors='replace')}'")
