# Copyright 2026 The Husky Playpen Lab authors
# SPDX-License-Identifier: Apache-2.0

from __future__ import annotations

import argparse

from ros2cli.verb import VerbExtension


class DaemonVerb(VerbExtension):
    """Base of the verbs of a daemon that does not exist."""

    def main(self, *, args: argparse.Namespace) -> None:
        print(
            'There is no daemon here, and none is needed: each command reads the graph itself, '
            'completely, in a quarter of a second'
        )
