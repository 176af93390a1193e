# Copyright 2026 The Husky Playpen Lab authors
# SPDX-License-Identifier: Apache-2.0
"""Every message that is kept packed."""

from husky_sim.messages import messages, transforms
from husky_sim.messages.packed_message import PackedMessage


def packed_messages() -> list[PackedMessage]:
    """Return one of each kind, to prove their layouts."""
    return [
        *(messages.WheelOdometryMessage(), messages.FilteredOdometryMessage()),
        *(messages.GroundTruthMessage(), messages.ImuMessage(), messages.JointStateMessage()),
        *(messages.CommandMessage(), messages.FixMessage(), messages.ClockMessage()),
        *(messages.StampedCommandMessage(), messages.EmergencyStopMessage()),
        *(messages.BatteryMessage(), messages.ScanMessage()),
        *([] if transforms.TFMessage is None else [transforms.TransformsMessage()]),
    ]
