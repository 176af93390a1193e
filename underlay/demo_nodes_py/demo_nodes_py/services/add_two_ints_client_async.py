# Copyright 2026 The Husky Playpen Lab authors
# SPDX-License-Identifier: Apache-2.0
"""Do what add_two_ints_client does: upstream's two wait in two ways, which nobody sees."""

from __future__ import annotations

import sys

from demo_nodes_py.services.add_two_ints_client import main

__all__ = ['main']

if __name__ == '__main__':
    sys.exit(main())
