# Copyright 2026 The Husky Playpen Lab authors
# SPDX-License-Identifier: Apache-2.0
"""Hang a carrot at the left of the first turtle."""

from __future__ import annotations

import sys

from node_program import run_node

from turtle_tf2_py.carrot import Carrot

NAME = 'fixed_frame_tf2_broadcaster'
PLACE_M = 0.0, 2.0, 0.0


def main(argv: list[str] | None = None) -> int:
    argv = sys.argv if argv is None else argv
    return run_node(lambda _: Carrot(NAME, lambda _: PLACE_M), argv)


if __name__ == '__main__':
    sys.exit(main())
