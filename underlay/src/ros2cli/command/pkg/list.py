# Copyright 2026 The Husky Playpen Lab authors
# SPDX-License-Identifier: Apache-2.0
"""Output a list of available packages."""

from __future__ import annotations

import argparse

from ros2cli import packages


def main(_: argparse.Namespace) -> None:
    for name in sorted(packages.installed()):
        print(name)
