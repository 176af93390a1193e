# Copyright 2026 The Husky Playpen Lab authors
# SPDX-License-Identifier: Apache-2.0
"""The YAML files that tell what to record, play and rewrite."""

from __future__ import annotations

from pathlib import Path
from typing import Any

import yaml

from rosbag2_py.errors import BagError


def read(path: Path) -> Any:
    """
    Return what a YAML file holds.

    :raises BagError: it cannot be read, or is no YAML.
    """
    try:
        return yaml.safe_load(path.read_text(encoding='utf-8'))
    except OSError as error:
        raise BagError(f"'{path}' cannot be read: {error.strerror}") from None
    except UnicodeDecodeError:
        raise BagError(f"'{path}' is no text in UTF-8") from None
    # Besides its own errors, those of a date that is none, and of a text that is too deep.
    except (yaml.YAMLError, ValueError, OverflowError, RecursionError) as error:
        raise BagError(f"'{path}' is no YAML: {' '.join(str(error).split())}") from None
