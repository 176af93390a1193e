# Copyright 2026 The Husky Playpen Lab authors
# SPDX-License-Identifier: Apache-2.0
"""What processes have written."""

from __future__ import annotations

from collections.abc import Callable
from functools import partial
from typing import Any

from launch.actions import ExecuteLocal
from osrf_pycommon.terminal_color import remove_ansi_escape_sequences

from ..text_matching import build_text_match, decode_output, Expected
from ..util import resolveProcesses
from ..util.proc_lookup import name_of

_Filter = Callable[[str], str]


def assertInStream(
    proc_output: Any,
    expected_output: Expected,
    process: ExecuteLocal | str | None,
    cmd_args: object = None,
    *,
    output_filter: _Filter | None = None,
    strict_proc_matching: bool = True,
    strip_ansi_escape_sequences: bool = True,
    stream: str = 'stderr',
) -> None:
    """Assert that a process has written something.

    Process and cmd_args are those of resolveProcesses; of several processes one will do.

    :param proc_output: the IoHandler of a test.
    :param expected_output: text, a pattern, or several of them in order.
    :param output_filter: a function of text that leaves out what is not looked at.
    :param strip_ansi_escape_sequences: leave out colours first.
    :param stream: 'stdout' or 'stderr'.
    :raises ValueError: the filter or the stream is none.
    """
    if output_filter is not None and not callable(output_filter):
        raise ValueError(f'output_filter={output_filter!r} is not callable')
    if stream not in ('stdout', 'stderr'):
        raise ValueError(f"stream={stream!r}: it must be 'stdout' or 'stderr'")
    actions = resolveProcesses(
        proc_output,
        process=process,
        cmd_args=cmd_args,
        strict_proc_matching=strict_proc_matching,
    )
    match = build_text_match(expected_output)
    for action in actions:
        events = proc_output[action]
        text = decode_output(event for event in events if getattr(event, f'from_{stream}'))
        if strip_ansi_escape_sequences:
            text = remove_ansi_escape_sequences(text)
        if output_filter is not None:
            text = output_filter(text)
        if match(text) is not None:
            return
    names = ', '.join(sorted(map(name_of, actions)))
    raise AssertionError(
        f"Did not find '{expected_output}' in {stream} of any of the matching processes: {names}"
    )


assertInStdout = partial(assertInStream, stream='stdout')
assertInStderr = partial(assertInStream, stream='stderr')


def assertDefaultStream() -> str:
    """Return the stream that assertInStream looks at where none is named."""
    return 'stderr'
