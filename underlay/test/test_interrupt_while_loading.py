# Copyright 2026 The Husky Playpen Lab authors
# SPDX-License-Identifier: Apache-2.0
"""Ctrl-C at moments when Python itself would print and drop it, and go on."""

import os
from pathlib import Path
import signal
import subprocess
import sys

from husky_runtime.domains import OwnDomain
import pytest

SLEEP = """
import time
time.sleep(20.0)
print('never interrupted')
"""
# What is raised in the callback of a weak reference goes nowhere.
IN_A_CALLBACK = f"""
import os, signal, weakref

class Thing:
    pass

thing = Thing()
reference = weakref.ref(thing, lambda _: os.kill(os.getpid(), signal.SIGINT))
del thing
{SLEEP}
"""
# rclpy makes the object of a message in C++, where it loses what is raised.
IN_A_MESSAGE = """
import os, signal
import rclpy
from std_msgs.msg import Empty

rclpy.init()
node = rclpy.create_node('interrupted')
publisher, message, make = node.create_publisher(Empty, 'a', 1), Empty(), Empty.__init__
node.create_subscription(Empty, 'a', print, 1)
node.create_timer(0.01, lambda: publisher.publish(message))

def interrupted(self, **fields):
    os.kill(os.getpid(), signal.SIGINT)
    make(self, **fields)

Empty.__init__ = interrupted
rclpy.spin(node)
"""
# Python looks whether its script is a zip file; what is raised there is printed, and it goes on.
AT_THE_SCRIPT = """
import os, signal, sys

def interrupt(frame, event, _):
    if event == 'call' and 'zipimport' in frame.f_code.co_filename:
        sys.setprofile(None)
        os.kill(os.getpid(), signal.SIGINT)

sys.setprofile(interrupt)
"""


def run(program: Path) -> tuple[int, str, str]:
    ended = subprocess.run(
        [sys.executable, str(program)],
        env={**os.environ, 'PYTHONPATH': str(program.parent)},
        capture_output=True,
        text=True,
        timeout=15.0,
        start_new_session=True,
    )
    return ended.returncode, ended.stdout, ended.stderr


def test_an_interrupt_in_a_callback_is_raised_after_it(tmp_path: Path) -> None:
    program = tmp_path / 'program.py'
    program.write_text(IN_A_CALLBACK)
    assert run(program) == (-signal.SIGINT, '', '')


def test_an_interrupt_while_a_message_is_made_is_no_traceback(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    program = tmp_path / 'program.py'
    program.write_text(IN_A_MESSAGE)
    with OwnDomain() as domain:
        monkeypatch.setenv('ROS_DOMAIN_ID', str(domain.number))
        monkeypatch.setenv('ROS_AUTOMATIC_DISCOVERY_RANGE', 'LOCALHOST')
        status, _, err = run(program)
    assert (status, err) == (1, '')


@pytest.mark.parametrize('name', ['program', 'program.py'])
def test_an_interrupt_before_the_script_is_read_ends_python(tmp_path: Path, name: str) -> None:
    (tmp_path / 'sitecustomize.py').write_text(AT_THE_SCRIPT)
    program = tmp_path / name
    program.write_text(SLEEP)
    assert run(program) == (-signal.SIGINT, '', '')
