# Copyright 2026 The Husky Playpen Lab authors
# SPDX-License-Identifier: Apache-2.0
"""What is written down of a simulation while it runs, and what can be read from it again."""

from husky_sim.recording.played_run import PlayedRun
from husky_sim.recording.recorded_scans import RecordedScans, SCAN_RATE_HZ
from husky_sim.recording.recorder import loose_bodies, loose_body_ids, MOVED, RunRecorder

__all__ = [
    'MOVED',
    'SCAN_RATE_HZ',
    'PlayedRun',
    'RecordedScans',
    'RunRecorder',
    'loose_bodies',
    'loose_body_ids',
]
