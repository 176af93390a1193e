# Copyright 2026 The Husky Playpen Lab authors
# SPDX-License-Identifier: Apache-2.0
"""Names of signals."""

import signal


def get_signal_name(signal_number: int) -> str:
    """Return 'SIGINT' for 2, and the number as text where it has no name."""
    try:
        return signal.Signals(signal_number).name
    except ValueError:
        return str(signal_number)
