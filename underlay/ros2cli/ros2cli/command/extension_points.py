# Copyright 2026 The Husky Playpen Lab authors
# SPDX-License-Identifier: Apache-2.0

from __future__ import annotations

import argparse

from ros2cli.command.extensions import ListingCommand


class ExtensionPointsCommand(ListingCommand):
    """List extension points."""

    WHAT = 'extension points'

    def main(self, *, parser: argparse.ArgumentParser, args: argparse.Namespace) -> None:
        from ros2cli.entry_points import EXTENSION_POINT_GROUP_NAME, get_entry_points

        for _, entry_point in sorted(get_entry_points(EXTENSION_POINT_GROUP_NAME).items()):
            self.show(args, entry_point)
