# Copyright 2026 The Husky Playpen Lab authors
# SPDX-License-Identifier: Apache-2.0
"""Where in a launch file something was written, for error messages."""

from __future__ import annotations

from collections.abc import Callable
from pathlib import Path
import sys
from types import FrameType, TracebackType

_OWN_FOLDERS = tuple(
    f'{Path(__file__).parent.parent / name}/'
    for name in ('launch', 'launch_ros', 'launch_xml', 'launch_yaml')
)
# What a command line tool builds around a launch file has no place worth naming.
_TOOLS_FOLDER = f'{Path(__file__).parent.parent / "ros2launch"}/'
_launch_files: set[str] = set()
_explainers: list[Callable[[BaseException], str]] = []


def register_launch_file(path: str) -> None:
    """Remember a Python launch file, whose lines then name themselves in errors."""
    _launch_files.add(path)


def caller_location() -> tuple[str, int] | None:
    """Return file and line of the nearest caller outside of the launch packages."""
    frame: FrameType | None = sys._getframe(1)
    while frame is not None:
        name = frame.f_code.co_filename
        if not name.startswith(_OWN_FOLDERS):
            return None if name.startswith(_TOOLS_FOLDER) else (name, frame.f_lineno)
        frame = frame.f_back
    return None


def launch_file_location() -> tuple[str, int] | None:
    """Return the line of a Python launch file that is being read; None while none is."""
    frame: FrameType | None = sys._getframe(1)
    while frame is not None:
        if frame.f_code.co_filename in _launch_files:
            return frame.f_code.co_filename, frame.f_lineno
        frame = frame.f_back
    return None


def traceback_location(trace: TracebackType | None) -> tuple[str, int] | None:
    """Return the innermost place of a traceback that is in a launch file."""
    found = None
    while trace is not None:
        name = trace.tb_frame.f_code.co_filename
        if name in _launch_files:
            found = name, trace.tb_lineno
        trace = trace.tb_next
    return found


def located_error(error: Exception, location: tuple[str, int] | None) -> Exception:
    """Return the error with a note where it came from, unless it has one."""
    if location is not None and getattr(error, 'launch_location', None) is None:
        error.launch_location = location  # type: ignore[attr-defined]
    return error


def attach_location(error: Exception, location: tuple[str, int] | None) -> None:
    """Note at an error where it came from, unless an inner place is already known."""
    located_error(error, traceback_location(error.__traceback__) or location)


def explain_errors_with(explainer: Callable[[BaseException], str]) -> None:
    """Let a function say what to do about an error; it returns '' for those it does not know."""
    _explainers.append(explainer)


def describe_error(error: BaseException) -> str:
    """Return the message with what to do and the launch file and line, where they are known."""
    message = str(error) or type(error).__name__
    if isinstance(error, KeyError) and error.args:
        said = str(error.args[0])
        message = f'KeyError: {said!r}' if type(error) is KeyError else said
    for explainer in _explainers:
        hint = explainer(error) or (explainer(error.__cause__) if error.__cause__ else '')
        message = f'{message.rstrip()}: {hint}' if hint else message
    location = getattr(error, 'launch_location', None) or traceback_location(error.__traceback__)
    if location is None or f'{location[0]}:{location[1]}' in message:
        return message
    return f'{message} (at {location[0]}:{location[1]})'
