# Copyright 2026 The Husky Playpen Lab authors
# SPDX-License-Identifier: Apache-2.0
"""Tell values of numpy without loading it, which takes half as long as a whole command."""

from __future__ import annotations

import sys
from typing import Any


def is_numpy(value: Any, kind: str) -> bool:
    """Tell whether a value is of that class of numpy; where nobody has loaded it, none is."""
    return isinstance(value, getattr(sys.modules.get('numpy'), kind, ()))
