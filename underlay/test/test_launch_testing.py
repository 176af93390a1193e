# Copyright 2026 The Husky Playpen Lab authors
# SPDX-License-Identifier: Apache-2.0
"""Tests of launches, run by pytest and by launch_test, each in a process of its own."""

from __future__ import annotations

from collections.abc import Callable
import os
from pathlib import Path
import subprocess
import sys
import textwrap
from xml.etree import ElementTree

from ament_index_python import get_package_share_directory
import pytest

_UNITTEST = """
    import sys, unittest
    from launch import LaunchDescription
    from launch.actions import ExecuteProcess
    import launch_testing
    import pytest

    @pytest.mark.launch_test
    @launch_testing.parametrize('word', ['right', {word!r}])
    def generate_test_description(word):
        writer = ExecuteProcess(cmd=[sys.executable, '-c', f'print("I say {{word}}")'])
        return LaunchDescription([
            writer, launch_testing.util.KeepAliveProc(), launch_testing.actions.ReadyToTest(),
        ]), {{'writer': writer}}

    class TestBeside(unittest.TestCase):
        def test_it_says_right(self, proc_info, proc_output, writer):
            proc_info.assertWaitForShutdown(writer)
            proc_output.assertWaitFor('I say right', writer, stream='stdout', timeout=0.1)

    @launch_testing.post_shutdown_test()
    class TestAfterwards(unittest.TestCase):
        def test_it_has_ended_well(self, proc_info, writer):
            assert len(proc_info.processes()) == 2
            launch_testing.asserts.assertExitCodes(proc_info, process=writer)
"""
_LAUNCH_PYTEST = """
    import asyncio, sys
    from launch import LaunchDescription
    from launch.actions import ExecuteProcess, Shutdown, TimerAction
    import launch_pytest
    from launch_pytest.tools import assert_output_sync, wait_for_exit
    import pytest

    PROGRAM = 'import time; print("ready", flush=True); time.sleep(60)'
    order = []

    @launch_pytest.fixture(scope='module', params=['a', 'b'])
    def sleeper(request):
        process = ExecuteProcess(cmd=[sys.executable, '-c', PROGRAM], cached_output=True)
        return LaunchDescription([process]), process, request.param

    def writes_ready(output):
        assert output.splitlines() == ['ready']

    @pytest.mark.launch(fixture=sleeper, shutdown=True)
    def test_ended(sleeper):
        order.append('ended')
        assert sleeper[1].return_code == -2

    @pytest.mark.launch(fixture=sleeper)
    def test_function(sleeper, launch_context):
        order.append(sleeper[2])
        assert_output_sync(launch_context, sleeper[1], writes_ready, timeout=10)

    @pytest.mark.launch(fixture=sleeper)
    async def test_coroutine(sleeper, launch_context, event_loop):
        order.append('coroutine')
        assert event_loop is asyncio.get_running_loop()
        assert not await wait_for_exit(launch_context, sleeper[1], timeout=0.1)

    @pytest.mark.launch(fixture=sleeper)
    def test_generator(sleeper):
        assert sleeper[1].return_code is None
        order.append('first half')
        yield
        order.append('second half')

    def test_order():
        rest = ['coroutine', 'first half', 'ended', 'second half']
        assert order == ['a', *rest, 'b', *rest]

    @launch_pytest.fixture
    def never_ready():
        later = TimerAction(period=60.0, actions=[launch_pytest.actions.ReadyToTest()])
        return LaunchDescription([later, Shutdown()])

    @pytest.mark.launch(fixture=never_ready)
    def test_never_run():
        assert False
"""
_ROSTEST = """
    import sys, unittest
    from launch import LaunchDescription
    from launch.actions import ExecuteProcess
    import launch_testing
    from launch_testing_ros import WaitForTopics
    import pytest
    from std_msgs.msg import String

    PROGRAM = '''
    import rclpy
    from std_msgs.msg import String
    rclpy.init()
    node = rclpy.create_node("talker")
    publisher = node.create_publisher(String, "chatter", 10)
    node.create_timer(0.1, lambda: publisher.publish(String(data="hello")))
    rclpy.spin(node)
    '''.replace('\\n    ', '\\n')

    @pytest.mark.rostest
    def generate_test_description():
        talker = ExecuteProcess(cmd=[sys.executable, '-c', PROGRAM])
        return LaunchDescription([talker, launch_testing.actions.ReadyToTest()])

    class TestTalker(unittest.TestCase):
        def test_it_talks_on_chatter_alone(self):
            with WaitForTopics([('chatter', String)], timeout=20.0) as heard:
                assert heard.received_messages('chatter')[0].data == 'hello'
            silent = WaitForTopics([('chatter', String), ('other', String)], timeout=0.5)
            assert not silent.wait()
            assert 'other' in silent.topics_not_received()
            silent.shutdown()
"""
_PLAIN = """
    import sys

    def test_generate_test_description_is_only_a_word_here():
        python = sys.version_info[:2]
        by_pytest = {'asyncio'} if python == (3, 10) or python >= (3, 14) else set()
        assert not {'asyncio', 'launch', 'launch_ros', 'rclpy'} & set(sys.modules) - by_pytest
"""


@pytest.fixture
def run_pytest(tmp_path: Path, launch_environment: None) -> Callable[..., tuple[int, str]]:
    """Return a function that writes files and runs pytest on them, with warnings as errors."""

    def run(*arguments: str, **files: str) -> tuple[int, str]:
        for name, text in files.items():
            (tmp_path / f'{name}.py').write_text(textwrap.dedent(text))
        options = ['-c', os.devnull, '-p', 'no:cacheprovider', '-W', 'error', '-v']
        done = subprocess.run(
            [sys.executable, '-m', 'pytest', *options, '--rootdir=.', *arguments],
            cwd=tmp_path,
            capture_output=True,
            text=True,
            timeout=100.0,
            check=False,
        )
        return done.returncode, done.stdout + done.stderr

    return run


def test_other_tests_do_not_import_launch(run_pytest: Callable[..., tuple[int, str]]) -> None:
    broken = 'import no_such_module\ngenerate_test_description = None'
    files = {'test_plain': _PLAIN, 'test_broken': broken}
    _, output = run_pytest('--continue-on-collection-errors', **files)
    assert "No module named 'no_such_module'" in output
    assert '1 passed, 1 error in' in output, output


def test_pytest_names_the_failed_test_of_a_launch(
    run_pytest: Callable[..., tuple[int, str]],
) -> None:
    status, output = run_pytest(
        test_good=_UNITTEST.format(word='right so'), test_bad=_UNITTEST.format(word='wrong')
    )
    assert status == 1, output
    assert 'FAIL: test_bad.TestBeside.test_it_says_right[wrong]' in output
    assert 'Waiting for output timed out' in output
    assert 'test_bad FAILED' in output
    assert 'test_good PASSED' in output


def test_a_description_that_is_none_is_told_in_a_line(
    run_pytest: Callable[..., tuple[int, str]],
) -> None:
    status, output = run_pytest(
        test_none="""
            import launch, pytest

            @pytest.mark.launch_test
            def generate_test_description():
                launch.LaunchDescription([])
        """
    )
    assert status == 1
    assert 'generate_test_description has returned None: a LaunchDescription' in output
    assert 'is a `return` missing?' in output
    assert 'loader.py' not in output


def test_launch_test_writes_which_tests_failed(tmp_path: Path, launch_environment: None) -> None:
    file, report = tmp_path / 'words.py', tmp_path / 'report.xml'
    file.write_text(textwrap.dedent(_UNITTEST.format(word='wrong')))
    command = ['launch_test', str(file), '--junit-xml', str(report), '--package-name', 'words']
    done = subprocess.run(command, capture_output=True, text=True, timeout=60.0, check=False)
    assert done.returncode == 1, done.stderr
    failed = [
        case.get('name')
        for case in ElementTree.parse(report).iter('testcase')
        if case.find('failure') is not None
    ]
    assert failed == ['test_it_says_right[wrong]']


def test_launch_pytest_runs_tests_beside_a_launch_and_after_it(
    run_pytest: Callable[..., tuple[int, str]],
) -> None:
    _, output = run_pytest(test_sleeper=_LAUNCH_PYTEST)
    assert '11 passed, 1 error in' in output, output
    assert "fixture 'never_ready': the launch ended before it came to ReadyToTest" in output


def test_a_launch_test_waits_for_topics(run_pytest: Callable[..., tuple[int, str]]) -> None:
    # that of lark, see pyproject.toml
    status, output = run_pytest('-W', 'ignore::DeprecationWarning', test_talker=_ROSTEST)
    assert status == 0, output


def test_the_examples_pass(run_pytest: Callable[..., tuple[int, str]]) -> None:
    examples = Path(get_package_share_directory('launch_testing')) / 'examples'
    status, output = run_pytest(str(examples), '--launch-args', 'dut_arg:=word')
    assert status == 0, output
    assert '2 passed in' in output
