# Copyright 2026 The Husky Playpen Lab authors
# SPDX-License-Identifier: Apache-2.0
"""Listen as one does to sensors, where messages may be lost, or reliably; a number of times."""

from __future__ import annotations

import sys

from rclpy.qos import QoSProfile

from demo_nodes_py.topics.listener import Listener
from demo_nodes_py.topics.quality import reliability_of, run_cycles


class ListenerQos(Listener):
    """Subscribes with a quality of service of choice."""

    def __init__(self, qos_profile: QoSProfile) -> None:
        super().__init__('listener_qos', qos_profile)
        self.get_logger().info(f'{reliability_of(qos_profile)} listener')


def main(argv: list[str] | None = None) -> int:
    return run_cycles(ListenerQos, argv, 'listener_qos', 'how many messages to hear')


if __name__ == '__main__':
    sys.exit(main())
