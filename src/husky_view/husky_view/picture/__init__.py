# Copyright 2026 The Husky Playpen Lab authors
# SPDX-License-Identifier: Apache-2.0
"""What is drawn in the browser."""

from husky_view.picture.camera import BACK_M, Cameras, FOLLOW, FREE, TOP, UP_M

__all__ = ['BACK_M', 'FOLLOW', 'FREE', 'TOP', 'UP_M', 'Cameras']
