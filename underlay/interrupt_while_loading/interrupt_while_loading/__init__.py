# Copyright 2026 The Husky Playpen Lab authors
# SPDX-License-Identifier: Apache-2.0
"""
Ctrl-C while a program still loads ends it with one line instead of a traceback.

Python imports this at its start (interrupt_while_loading.pth). A node imports ROS for half a
second; interrupted there, Python would print a traceback of its imports. Once a function of the
program runs, an interrupt is a KeyboardInterrupt as always. Where the program does not catch it,
or what rclpy raises for it, the program ends without a traceback too.

Where Python is started with SIGINT blocked (`env --block-signal=INT`), the signal waits until
this module has set its handler, so that none is lost.

It imports nothing but what every Python has loaded or is written in C: signal and contextlib alone
would take a third of the time in which a small program starts.
"""

import _thread
import os
import sys
import time

TYPE_CHECKING = False  # typing's own takes its time
if TYPE_CHECKING:
    from collections.abc import Iterator, Sequence
    import signal
    from types import FrameType, TracebackType
else:
    import _signal as signal

_IMPORT = ('importlib', 'zipimport')  # parts of their file names
_RUNPY = ('<frozen runpy>', 'runpy.py')
_ENTRY_POINT_LOADERS = ('importlib_load_entry_point', 'load_entry_point')
_AGAIN_SEC = 0.01
_PYTHONS_OF_SYSTEM = (b'/usr/bin/python3', b'/bin/python3', b'/usr/bin/python3.12')
# What pybind11 makes of any error, as while rclpy makes an object of a message.
_LOST_BY_PYBIND11 = "Unable to convert call argument '0' to Python object"

_print_uncaught = sys.excepthook
_print_unraisable = sys.unraisablehook
_was_interrupted = False


def install() -> None:
    """Handle SIGINT as described above, unless it is ignored as in a shell's background job."""
    if signal.getsignal(signal.SIGINT) is signal.default_int_handler:
        signal.signal(signal.SIGINT, _on_interrupt)
        sys.excepthook = _on_uncaught
        sys.unraisablehook = _on_unraisable
    signal.pthread_sigmask(signal.SIG_UNBLOCK, (signal.SIGINT,))


def takes_blocked_interrupt(executable: str) -> bool:
    """Tell whether an executable is a script of this Python, which comes by here."""
    head = _head(executable)
    # The Python stands in the second line where the first one of a script cannot hold its path.
    interpreter = os.fsencode(sys.executable)
    return head[0].startswith(b'#!') and (
        any(interpreter in line for line in head[:2]) or _asks_for_python_of_ros(executable, head)
    )


def words_of(command: 'Sequence[str]') -> 'list[str]':
    """Return what runs a command: this Python, too, where it is a script for that of ROS.

    On Ubuntu ROS runs by the Python of the system, so that the scripts of many packages begin with
    #!/usr/bin/python3. The wheels of ROS are installed in a virtual environment, of which that
    Python knows nothing.
    """
    if _asks_for_python_of_ros(command[0], _head(command[0])):
        return [sys.executable, *command]
    return [*command]


def _asks_for_python_of_ros(executable: str, head: 'list[bytes]') -> bool:
    """Tell whether a program of a workspace is a script that names the Python of the system."""
    folder = os.path.dirname(os.path.dirname(executable))  # noqa: PTH120 -- as above
    return (
        sys.prefix != sys.base_prefix
        and head[0][:2] == b'#!'
        and head[0][2:].strip(b' ') in _PYTHONS_OF_SYSTEM
        and os.path.basename(folder) == 'lib'  # noqa: PTH119 -- as above
        and not executable.startswith('/usr/')
        and os.access(executable, os.X_OK)
    )


def _head(executable: str) -> 'list[bytes]':
    try:
        with open(executable, 'rb') as file:  # noqa: PTH123 -- pathlib takes its time
            return file.read(1024).split(b'\n')
    except OSError:
        return [b'']


def _on_interrupt(number: int, frame: 'FrameType | None') -> None:
    if not _loads(frame):
        global _was_interrupted  # noqa: PLW0603 -- a signal handler has no other place
        _was_interrupted = True
        signal.default_int_handler(number, frame)
    leave(number, frame)


def leave(number: int, _: 'FrameType | None') -> None:
    """Handle SIGINT: say so in one line, and let it end this process."""
    # The children of a launch are silent.
    try:
        if os.tcgetpgrp(2) == os.getpgrp():
            os.write(2, b'\ninterrupted\n')
    except OSError:  # no terminal, or that of another session
        pass
    signal.signal(number, signal.SIG_DFL)
    os.kill(os.getpid(), number)


def _on_uncaught(
    kind: type[BaseException], error: BaseException, trace: 'TracebackType | None'
) -> None:
    try:
        # rclpy shuts down in another thread, so that either error may come first.
        if not _was_interrupted or not any(map(_is_of_interrupt, _chain(error))):
            _print_uncaught(kind, error, trace)
    except KeyboardInterrupt:
        pass


def _on_unraisable(lost: 'sys.UnraisableHookArgs') -> None:
    # Python prints and drops an interrupt in some callbacks, as that of a weak reference.
    if lost.exc_type is KeyboardInterrupt and _was_interrupted:
        if not sys.is_finalizing():
            _thread.start_new_thread(_interrupt_again, ())
    else:
        _print_unraisable(lost)


def _interrupt_again() -> None:
    time.sleep(_AGAIN_SEC)  # until that callback has returned
    os.kill(os.getpid(), signal.SIGINT)


def _is_of_interrupt(error: BaseException) -> bool:
    return (
        isinstance(error, KeyboardInterrupt)
        or type(error).__module__.startswith('rclpy.')
        or str(error).startswith(_LOST_BY_PYBIND11)
    )


def _chain(error: BaseException | None) -> 'Iterator[BaseException]':
    while error is not None:
        yield error
        error = error.__cause__ or error.__context__


def _loads(frame: 'FrameType | None') -> bool:
    if hasattr(sys, 'ps1'):
        return False  # Python is interactive
    frames = list(_outermost_first(frame))
    for each in frames:
        code = each.f_code
        if code.co_name in _ENTRY_POINT_LOADERS or any(
            each in code.co_filename for each in _IMPORT
        ):
            return True
        if code.co_name != '<module>' and not code.co_filename.endswith(_RUNPY):
            return False
    # Nothing but the main script itself, or the text of `python -c`: what a package manager wrote
    # has no suffix.
    return not (frames and frames[-1].f_code.co_filename.endswith(('.py', '<string>')))


def _outermost_first(frame: 'FrameType | None') -> 'Iterator[FrameType]':
    if frame is not None:
        yield from _outermost_first(frame.f_back)
        yield frame


install()
