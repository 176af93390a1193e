# Copyright 2026 The Husky Playpen Lab authors
# SPDX-License-Identifier: Apache-2.0

from __future__ import annotations

import argparse

from ros2cli.node.daemon import is_daemon_running
from ros2cli.verb.daemon import VerbExtension


class StatusVerb(VerbExtension):
    """Output the status of the daemon."""

    def main(self, *, args: argparse.Namespace) -> None:
        print(f'The daemon is {"" if is_daemon_running(args) else "not "}running')
