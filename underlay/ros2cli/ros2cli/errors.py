# Copyright 2026 The Husky Playpen Lab authors
# SPDX-License-Identifier: Apache-2.0
"""What a verb raises instead of answering; the command line shows it as one line.

CommandError        the command ends with this line, exit status 1
├── ServiceTimeout  nobody has offered a service in time
└── UsageError      the call itself is wrong: exit status 2, as for an unknown option
"""

from __future__ import annotations


class CommandError(RuntimeError):
    """Say what was refused or missing, and what to do."""

    exit_status = 1


class ServiceTimeout(CommandError):
    """Name the service."""


class UsageError(CommandError):
    """Refuse an argument."""

    exit_status = 2
