# Copyright 2026 The Husky Playpen Lab authors
# SPDX-License-Identifier: Apache-2.0
"""Talk as sensors do, where messages may be lost, or reliably; a number of times."""

from __future__ import annotations

import sys

from rclpy.qos import QoSProfile

from demo_nodes_py.topics.quality import reliability_of, run_cycles
from demo_nodes_py.topics.talker import Talker


class TalkerQos(Talker):
    """Publishes with a quality of service of choice."""

    def __init__(self, qos_profile: QoSProfile) -> None:
        super().__init__('talker_qos', qos_profile)
        self.get_logger().info(f'{reliability_of(qos_profile)} talker')


def main(argv: list[str] | None = None) -> int:
    return run_cycles(TalkerQos, argv, 'talker_qos', 'how many messages to send')


if __name__ == '__main__':
    sys.exit(main())
