# Copyright 2026 The Husky Playpen Lab authors
# SPDX-License-Identifier: Apache-2.0
"""
What can be wrong with what the simulator is given.

SimulatorError
├── WorldError        the file, or what stands in it
├── StartPoseError    where a robot should start
└── SettingError      any other parameter

Each message is one line for the person who started the simulator.
"""

from typing import Any

from husky_runtime.settings import Setting


class SimulatorError(Exception):
    """The simulator cannot run with what it was given."""


class WorldError(SimulatorError):
    """The world file cannot be used."""


class StartPoseError(SimulatorError):
    """A robot cannot start where it should."""


class SettingError(SimulatorError):
    """A parameter has a value that is not allowed."""


def refused(setting: Setting, given: Any) -> SettingError:
    """Return the error that says which values of a parameter are allowed."""
    return SettingError(f'{setting.name}={given!r}: {setting.allowed} is allowed')
