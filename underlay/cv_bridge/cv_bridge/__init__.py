# Copyright 2026 The Husky Playpen Lab authors
# SPDX-License-Identifier: Apache-2.0
"""Images between ROS and OpenCV."""

from cv_bridge.core import CvBridge
from cv_bridge.encodings import CvBridgeError, getCvType

__all__ = ['CvBridge', 'CvBridgeError', 'getCvType']
