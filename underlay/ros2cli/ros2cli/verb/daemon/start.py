# Copyright 2026 The Husky Playpen Lab authors
# SPDX-License-Identifier: Apache-2.0

from __future__ import annotations

import argparse

from ros2cli import arguments
from ros2cli.node.daemon import spawn_daemon
from ros2cli.verb.daemon import VerbExtension

_TIMEOUT_SEC = 10.0


class StartVerb(VerbExtension):
    """Start the daemon if it isn't running.

    Commands here read the graph themselves, completely; only verbs of other packages may ask it.
    """

    def add_arguments(self, parser: argparse.ArgumentParser, cli_name: str) -> None:
        arguments.add_flags(parser, {'-d --debug': 'Let the daemon write to this terminal'})

    def main(self, *, args: argparse.Namespace) -> None:
        started = spawn_daemon(args, timeout=_TIMEOUT_SEC, debug=args.debug)
        print(f'The daemon {"has been started" if started else "is already running"}')
