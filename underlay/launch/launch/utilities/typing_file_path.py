# Copyright 2026 The Husky Playpen Lab authors
# SPDX-License-Identifier: Apache-2.0
"""What a path of a file may be."""

import os
from typing import Union

FilePath = Union[bytes, str, 'os.PathLike[str]']
