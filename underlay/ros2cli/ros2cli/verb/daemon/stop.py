# Copyright 2026 The Husky Playpen Lab authors
# SPDX-License-Identifier: Apache-2.0

from __future__ import annotations

import argparse

from ros2cli.node.daemon import shutdown_daemon
from ros2cli.verb.daemon import VerbExtension

_TIMEOUT_SEC = 10.0


class StopVerb(VerbExtension):
    """Stop the daemon if it is running."""

    def main(self, *, args: argparse.Namespace) -> None:
        stopped = shutdown_daemon(args, timeout=_TIMEOUT_SEC)
        print(f'The daemon {"has been stopped" if stopped else "is not running"}')
