# Copyright 2026 The Husky Playpen Lab authors
# SPDX-License-Identifier: Apache-2.0
"""ROS of the wheels waits without a limit where its time has overflowed, and else as it did."""

from __future__ import annotations

import ctypes
import errno
import os
from pathlib import Path
import re
import signal
import subprocess
import sys
import threading
from typing import Any

import pytest
import rclpy

LIB = Path(sys.prefix, 'lib')
WAITS = 'libunlimited_waits.so'
ROOM = 64  # bytes: more than a mutex or a condition variable has; all 0 is their initial state
OVERFLOWED = [(-9223372035, 145224191), (-1, 0), (5, -1)]


class Time(ctypes.Structure):
    """The struct timespec: timespec(3type)."""

    _fields_ = [('sec', ctypes.c_long), ('nsec', ctypes.c_long)]


@pytest.fixture(name='libc')
def load_libc() -> ctypes.CDLL:
    return ctypes.CDLL(None)


@pytest.fixture(name='waits')
def load_waits() -> ctypes.CDLL:
    return ctypes.CDLL(str(LIB / WAITS))


# patchelf leaves the old name where it stood.
@pytest.mark.parametrize(
    'file',
    [
        file
        for file in sorted((*LIB.glob('*.so*'), *Path(rclpy.__file__).parent.glob('*.so')))
        if not file.is_symlink() and b'\0pthread_cond_timedwait\0' in file.read_bytes()
    ],
    ids=lambda file: file.name,
)
def test_each_library_of_ros_waits_by_the_function_that_is_made_for_it(file: Path) -> None:
    told = subprocess.run(
        [sys.executable, '-c', 'import ctypes, sys; ctypes.CDLL(sys.argv[1])', file],
        env={**os.environ, 'LD_DEBUG': 'bindings', 'LD_BIND_NOW': '1'},
        capture_output=True,
        text=True,
        check=True,
    ).stderr
    bound = rf'binding file {re.escape(str(file))} .* to (\S+) .*`(\w+_cond_timedwait)'
    assert re.findall(bound, told) == [(str(LIB / WAITS), 'unlimited_cond_timedwait')]


EVENTS = """
import rclpy
from rclpy.executors import ExternalShutdownException
from rclpy.experimental import EventsExecutor
from std_msgs.msg import Empty

heard = []

def hear(message):
    heard.append(message)
    print(f'heard {len(heard)}', flush=True)

rclpy.init()
node = rclpy.create_node('events')
publisher = node.create_publisher(Empty, 'events', 1)
node.create_subscription(Empty, 'events', hear, 1)
node.create_timer(0.01, lambda: publisher.publish(Empty()))
executor = EventsExecutor()
executor.add_node(node)
try:
    executor.spin()
except (KeyboardInterrupt, ExternalShutdownException):
    print('ended')
"""


@pytest.mark.usefixtures('domain')
def test_an_executor_of_events_hears_of_them_and_of_an_interrupt(processes: Any) -> None:
    process = processes.start(sys.executable, '-c', EVENTS, ready='heard 3')
    process.send_signal(signal.SIGINT)
    assert 'ended' in process.communicate(timeout=10)[0].splitlines()
    assert process.returncode == 0


@pytest.mark.parametrize('time', OVERFLOWED)
def test_a_time_that_overflowed_gives_up_the_mutex_until_it_is_signalled(
    libc: ctypes.CDLL, waits: ctypes.CDLL, time: tuple[int, int]
) -> None:
    mutex, condition = ctypes.create_string_buffer(ROOM), ctypes.create_string_buffer(ROOM)
    is_locked, answers = threading.Event(), list[int]()

    def wait() -> None:
        libc.pthread_mutex_lock(mutex)
        is_locked.set()
        answers.append(waits.unlimited_cond_timedwait(condition, mutex, ctypes.byref(Time(*time))))
        libc.pthread_mutex_unlock(mutex)

    waiter = threading.Thread(target=wait, daemon=True)
    waiter.start()
    assert is_locked.wait(10.0)
    in_ten_seconds = Time()
    libc.clock_gettime(0, ctypes.byref(in_ten_seconds))
    in_ten_seconds.sec += 10
    got = libc.pthread_mutex_timedlock(mutex, ctypes.byref(in_ten_seconds))
    assert got == 0, f'the mutex is not given up: {os.strerror(got)}'
    assert not answers, f'the wait is over before a signal: {answers}'
    libc.pthread_cond_signal(condition)
    libc.pthread_mutex_unlock(mutex)
    waiter.join(10.0)
    assert answers == [0]


def test_a_time_that_is_over_ends_the_wait(libc: ctypes.CDLL, waits: ctypes.CDLL) -> None:
    mutex, condition = ctypes.create_string_buffer(ROOM), ctypes.create_string_buffer(ROOM)
    libc.pthread_mutex_lock(mutex)
    answer = waits.unlimited_cond_timedwait(condition, mutex, ctypes.byref(Time(1, 0)))
    assert answer == errno.ETIMEDOUT
