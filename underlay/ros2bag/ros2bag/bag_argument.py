# Copyright 2026 The Husky Playpen Lab authors
# SPDX-License-Identifier: Apache-2.0
"""How a bag is named that is read."""

from __future__ import annotations

import argparse
from pathlib import Path

from rosbag2_py.storages import STORAGES


def add_bag_argument(parser: argparse.ArgumentParser) -> None:
    parser.add_argument('bag_path', type=Path, help='Bag to open')
    parser.add_argument(
        '-s',
        '--storage',
        choices=sorted(STORAGES),
        default='',
        help='Storage implementation of bag (default: found out from its files)',
    )
