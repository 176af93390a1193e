# Copyright 2026 The Husky Playpen Lab authors
# SPDX-License-Identifier: Apache-2.0
"""ROS messages in serialized form, of which only the numbers change."""

from husky_sim.messages.messages import packed_messages
from husky_sim.messages.packed_message import prove

__all__ = ['packed_messages', 'prove']
