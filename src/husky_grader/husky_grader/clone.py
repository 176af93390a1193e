# Copyright 2026 The Husky Playpen Lab authors
# SPDX-License-Identifier: Apache-2.0
"""Where the clone of the lab lies."""

from pathlib import Path

CLONE = Path(__file__).resolve().parents[3]
