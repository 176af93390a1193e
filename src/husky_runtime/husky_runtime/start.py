# Copyright 2026 The Husky Playpen Lab authors
# SPDX-License-Identifier: Apache-2.0
"""
Start the programs of the lab so that they can be interrupted at any moment.

Their imports take a second. Until then nothing is open, so an interrupt ends the process at once;
Python itself would print a traceback from the middle of an import.
"""

from __future__ import annotations

import atexit
from collections.abc import Callable, Iterator
from contextlib import contextmanager, suppress
import gc
import os
from pathlib import Path
import re
import select
import signal
import sys
from types import FrameType
from typing import Any, NoReturn

from husky_runtime.parent_death import die_with_parent

_SIGNALS = (signal.SIGINT, signal.SIGTERM)
_BAD_INPUT = 2
_AGAIN_SEC = 0.01
_UNREAD_MS = 200
_LAST_DOMAIN = 232  # above it the ports do not suffice: RTPS 2.2, 9.6.1.3
_ASSIGNS = re.compile(r'[\w~/]+:=')
_CHECK_FIELDS = 'ROS_PYTHON_CHECK_FIELDS'

Load = Callable[[], Callable[[], int]]
INTERRUPTED = 130  # the exit status of a program that SIGINT ends


def run(load: Load, *, interrupted: int = 0, catches: bool = False) -> int:
    """
    Load a program and run it.

    :param load: imports what the program needs, and returns its main().
    :param interrupted: the exit status of a start that was interrupted.
    :param catches: main() is interrupted by a KeyboardInterrupt; else it sets its own handlers,
        and has nothing to close before.
    """

    def leave(number: int, _: object) -> NoReturn:
        if number != signal.SIGTERM and _is_at_keyboard():
            os.write(2, b'\ninterrupted\n')
        if number == signal.SIGINT and interrupted == INTERRUPTED:
            _end_by_interrupt()
        os._exit(interrupted)  # an exception would be raised inside an import

    _open_closed_streams()
    status = 0

    def end() -> None:
        if status == INTERRUPTED:
            with suppress(OSError, ValueError):  # nobody reads it any more
                sys.stdout.flush()
            _end_by_interrupt()

    atexit.register(end)  # what is registered later comes before
    # MuJoCo would start a second Python to find out whether it can open a window, and fail for
    # lack of what a variable names. The camera takes what there is, see husky_sim.sensors.camera.
    os.environ['MUJOCO_GL'] = 'disabled'

    def interrupt(number: int, frame: FrameType | None) -> None:
        discard_unread()
        if _is_importing(frame):
            interrupt_soon(number)  # what main() has open is closed then
        else:
            signal.default_int_handler(number, frame)

    def interrupt_soon(number: int) -> None:
        signal.signal(signal.SIGALRM, lambda *_: signal.raise_signal(number))
        signal.setitimer(signal.ITIMER_REAL, _AGAIN_SEC)

    def interrupt_again(lost: sys.UnraisableHookArgs) -> None:
        # Python prints and drops an interrupt in some callbacks, as the garbage collector's.
        if lost.exc_type is KeyboardInterrupt:
            interrupt_soon(signal.SIGINT)
        else:
            sys.__unraisablehook__(lost)

    for number in _SIGNALS:
        signal.signal(number, leave)
    if signal.getsignal(signal.SIGHUP) is not signal.SIG_IGN:  # as nohup has it
        signal.signal(signal.SIGHUP, lambda *_: signal.raise_signal(signal.SIGTERM))
    # The parent may have blocked signals until this process can handle them.
    signal.pthread_sigmask(signal.SIG_UNBLOCK, _SIGNALS)
    gc.disable()  # what is loaded stays: to look through it takes a tenth of the time
    try:
        main = load()
        gc.freeze()  # nor is it looked through later
        gc.enable()
        if catches:
            sys.unraisablehook = interrupt_again
            for number in _SIGNALS:
                signal.signal(number, interrupt)
        status = int(main())
    except KeyboardInterrupt:
        status = interrupted
    except SystemExit as asked:
        status = asked.code if isinstance(asked.code, int) else 0
        raise
    except ModuleNotFoundError as error:
        if (error.name or 'husky').startswith('husky'):
            raise
        print(_how_to_install(error.name), file=sys.stderr)
        return _BAD_INPUT
    finally:
        # An interrupt while the interpreter shuts down would kill it.
        for number in (*_SIGNALS, signal.SIGHUP, signal.SIGALRM):
            signal.signal(number, signal.SIG_IGN)
    return status


def _end_by_interrupt() -> None:
    """
    Let SIGINT end this process, where it is in the foreground of a terminal.

    A shell goes on with its loop after a program that exits with 130, as if Ctrl-C had been meant
    for that program alone: https://www.cons.org/cracauer/sigint.html
    """
    if _is_at_keyboard():
        signal.signal(signal.SIGINT, signal.SIG_DFL)
        signal.raise_signal(signal.SIGINT)


def _open_closed_streams() -> None:
    """Open what is closed (`>&-`): what is printed would go into the next file that is opened."""
    for number, name in enumerate(('stdin', 'stdout', 'stderr')):
        if getattr(sys, name) is None:
            # Another number if a library has taken this one: libffi keeps a file open.
            opened = os.open(os.devnull, os.O_RDWR)
            os.set_inheritable(opened, opened == number)
            setattr(sys, name, os.fdopen(opened, 'w' if number else 'r', encoding='utf-8'))


def discard_unread() -> None:
    """
    Let go nowhere what is printed from now on into a pipe that is full and that nobody reads.

    A program that is asked to end would wait for its reader, and not end.
    """
    for number in (1, 2):
        room = select.poll()
        room.register(number, select.POLLOUT)
        if not room.poll(_UNREAD_MS):
            nowhere = os.open(os.devnull, os.O_WRONLY)
            os.dup2(nowhere, number)
            os.close(nowhere)


def _how_to_install(module: str | None) -> str:
    return (
        f'{Path(sys.argv[0]).name}: {sys.executable} has no module {module!r}; in the folder of '
        'the lab, `rosdep install --from-paths src --ignore-src` and `pip install '
        '--break-system-packages -r requirements/without_rosdep.in` install what is missing'
    )


def _is_importing(frame: FrameType | None) -> bool:
    while frame is not None:
        if '<frozen importlib' in frame.f_code.co_filename:
            return True
        frame = frame.f_back
    return False


def _is_at_keyboard() -> bool:
    """Return whether this process is in the foreground; the children of a launch are not."""
    try:
        return os.tcgetpgrp(2) == os.getpgrp()
    except OSError:  # no terminal, or that of another session
        return False


def run_node(load: Load, *, interrupted: int = 0, catches: bool = False) -> int:
    """
    Run a node of the lab: it ends with its parent, and its messages are not checked.

    Under nohup it outlives its parent. The check of each field is for the code of students; with
    it, reading an odometry message takes 46 us instead of 29.
    """
    domain = os.environ.get('ROS_DOMAIN_ID') or '0'
    if not (domain.isascii() and domain.isdecimal() and int(domain) <= _LAST_DOMAIN):
        print(
            f'ROS_DOMAIN_ID={domain!r} is refused: a domain is a number from 0 to {_LAST_DOMAIN} '
            '(on Linux at best from 0 to 101); use `export ROS_DOMAIN_ID=0`',
            file=sys.stderr,
        )
        return _BAD_INPUT
    if signal.getsignal(signal.SIGHUP) is not signal.SIG_IGN:
        die_with_parent(signal.SIGTERM)
    os.environ[_CHECK_FIELDS] = '0'

    def checked() -> Callable[[], int]:
        main = load()
        if wrong := _wrong_of_words(sys.argv) or _wrong_of_ros_arguments():
            print(wrong, file=sys.stderr)
            return lambda: _BAD_INPUT
        return lambda: _refused_in_one_line(main)

    return run(checked, interrupted=interrupted, catches=catches)


def _refused_in_one_line(main: Callable[[], int]) -> int:
    """Run it; what ROS itself refuses, as a variable of the environment, is one line."""
    from rclpy.impl.implementation_singleton import rclpy_implementation

    try:
        return main()
    except rclpy_implementation.RCLError as error:
        print(f'{Path(sys.argv[0]).name}: {" ".join(str(error).split())}', file=sys.stderr)
        return _BAD_INPUT


def _wrong_of_ros_arguments() -> str:
    """Return in one line what is wrong with the arguments that are for ROS, or nothing."""
    from rclpy.utilities import remove_ros_args  # the program has loaded it

    try:
        remove_ros_args(sys.argv)
    except UnicodeEncodeError:
        return 'an argument is no UTF-8, and ROS takes nothing else: rename that file'
    except RuntimeError as error:
        return f'wrong ROS arguments: {" ".join(str(error).split())}'
    return ''


def _wrong_of_words(argv: list[str]) -> str:
    """
    Return in one line what is wrong with the words that are not for ROS, or nothing.

    Without `--ros-args` rcl passes over a parameter, or takes it for the name of a topic.
    """
    for_ros = False
    for word in argv[1:]:
        if word == ('--' if for_ros else '--ros-args'):
            for_ros = not for_ros
        elif not for_ros and _ASSIGNS.match(word):
            program = Path(argv[0]).name
            return (
                f'{program}: {word!r} is refused: parameters and other names stand behind '
                f'--ros-args: `{program} --ros-args -p {word}`'
            )
    return ''


class SignalsHeldBack:
    """Delays SIGINT and SIGTERM until a node is made: rclpy would lose the exception."""

    def __init__(self) -> None:
        self._pending: list[int] = []
        self._handlers: dict[int, Any] = {}

    def __enter__(self) -> SignalsHeldBack:
        self._handlers = {number: signal.signal(number, self._on_signal) for number in _SIGNALS}
        return self

    def _on_signal(self, number: int, _: FrameType | None) -> None:
        self._pending.append(number)

    def __exit__(self, *_: object) -> None:
        for number, handler in self._handlers.items():
            signal.signal(number, handler)
        if self._pending:
            signal.raise_signal(self._pending.pop(0))

    @contextmanager
    def let_through(self) -> Iterator[None]:
        """Handle signals as before, in a part that takes long and does not use rclpy."""
        self.__exit__()
        try:
            yield
        finally:
            self.__enter__()


def run_moved(package: str) -> NoReturn:
    """Run the program of this name in its new package, and print where it is."""
    name = Path(sys.argv[0]).name
    print(f'{name} has moved: ros2 run {package} {name}', file=sys.stderr, flush=True)
    os.execvp('ros2', ['ros2', 'run', package, name, *sys.argv[1:]])
