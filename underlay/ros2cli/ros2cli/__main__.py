# Copyright 2026 The Husky Playpen Lab authors
# SPDX-License-Identifier: Apache-2.0
"""Let `python -m ros2cli` be `ros2`."""

import sys

from ros2cli.cli import main

sys.exit(main())
