# Copyright 2026 The Husky Playpen Lab authors
# SPDX-License-Identifier: Apache-2.0
"""`ros2 service` and `ros2 param` with a node that has both."""

from __future__ import annotations

from collections.abc import Callable
from pathlib import Path
import threading
from typing import Any

from playpen_testing.forks import run_forked
from playpen_testing.processes import find_line
from playpen_testing.spinning import SpunNodes
import pytest
import rclpy
from rclpy.executors import SingleThreadedExecutor
from rclpy.node import Node
from rclpy.parameter import Parameter
from ros2param import api
import yaml


@pytest.fixture(scope='module')
def world(shared_processes: Any) -> Any:
    shared_processes.node('service', 'server')
    shared_processes.node('parameters', 'owner')
    return shared_processes


@pytest.mark.usefixtures('world')
def test_a_service_answers(ros2: Callable[..., Any]) -> None:
    answer = ros2('service', 'call', '/flip', 'std_srvs/srv/SetBool', 'data: true')
    assert answer.status == 0
    assert 'requester: making request: std_srvs.srv.SetBool_Request(data=True)' in answer.lines
    assert "std_srvs.srv.SetBool_Response(success=True, message='flipped')" in answer.lines


@pytest.mark.usefixtures('world')
def test_a_request_may_come_from_stdin(ros2: Callable[..., Any]) -> None:
    words = ('service', 'call', '/flip', 'std_srvs/srv/SetBool', '--stdin')
    assert 'success=False' in ros2(*words, text='data: false\n').out


@pytest.mark.usefixtures('world')
def test_a_bad_call_is_refused(ros2: Callable[..., Any]) -> None:
    bad = {
        ('std_srvs/srv/SetBool', 'data: 5'): 'expected true or false',
        ('std_srvs/srv/SetBol',): "no service 'SetBol'; did you mean 'SetBool'",
        ('std_msgs/msg/String',): 'the full name of a service',
        ('std_srvs/msg/SetBool',): "is no service; did you mean 'std_srvs/srv/SetBool'?",
        ('std_srvs/srv/SetBool', '{{'): 'is no YAML',
    }
    calls = [('service', 'call', '/flip', *words) for words in bad]
    preload = ('ros2service.verb.call', 'rclpy')
    results = run_forked(*(('ros2cli.cli', *words) for words in calls), preload=preload)
    for (words, message), ended in zip(bad.items(), results, strict=True):
        assert ended.status == 1, (words, ended)
        assert message in ended.err, words
    answer = ros2(*calls[0])
    assert (answer.status, answer.err) == (1, results[0].err)


def test_a_call_of_a_name_that_nobody_has_gets_a_hint(world: Any) -> None:
    hint = "hint: nobody offers '/flp'; did you mean '/flip'?"
    call = world.ros2('service', 'call', '/flp', 'std_srvs/srv/SetBool', ready=hint)
    call.terminate()


def test_a_server_that_ends_instead_of_answering_is_told(world: Any) -> None:
    world.node('forgetful', 'forgetful')
    hint = "hint: '/forget' gave no answer: its node has ended, and its terminal says why, as "
    call = world.ros2('service', 'call', '/forget', 'std_srvs/srv/SetBool', ready=hint)
    call.terminate()


def test_echo_shows_requests_and_responses(world: Any) -> None:
    words = ('/flip', 'std_srvs/srv/SetBool', 'data: true', '-r', '5')
    calls = world.ros2('service', 'call', *words, ready='response')
    echo = world.ros2('service', 'echo', '/flip', ready='event_type: RESPONSE_SENT')
    assert any('message: flipped' in line for line in echo.stdout)
    for process in (calls, echo):
        process.terminate()
        rest, _ = process.communicate(timeout=5)
        assert 'Traceback' not in rest


@pytest.mark.usefixtures('world')
def test_parameters_are_listed_with_types(ros2_here: Callable[..., Any]) -> None:
    answer = ros2_here('param', 'list', '/owner', '--param-type')
    assert '  speed (type: double)' in answer.lines
    assert '  names (type: string array)' in answer.lines
    everything = ros2_here('param', 'list')
    assert '/owner:' in everything.lines
    assert '  wheel.radius' in everything.lines
    assert ros2_here('param', 'list', 'owner', '--filter', 'wh.*').lines == ['  wheel.radius']


@pytest.mark.parametrize(
    ('name', 'shown'),
    [
        ('speed', 'Double value is: 0.5'),
        ('wheel.radius', 'Integer value is: 3'),
        ('names', "String values are: ['x', 'y']"),
        ('use_sim_time', 'Boolean value is: False'),
    ],
)
@pytest.mark.usefixtures('world')
def test_a_parameter_is_shown(ros2_here: Callable[..., Any], name: str, shown: str) -> None:
    assert ros2_here('param', 'get', '/owner', name).out == f'{shown}\n'


def test_bytes_are_shown_and_what_is_not_set_is_left_out(
    domain: int, ros2_here: Callable[..., Any]
) -> None:
    with SpunNodes(domain) as nodes:
        node = nodes.start(Node, 'odd')
        node.declare_parameter('raw', [b'A', b'\xff'])
        node.declare_parameter('unset', Parameter.Type.STRING)
        shown = ros2_here('param', 'get', '/odd', 'raw').out
        dump = ros2_here('param', 'dump', '/odd').out
    assert shown == "Byte values are: [b'A', b'\\xff']\n"
    dumped = yaml.safe_load(dump)['/odd']['ros__parameters']
    assert dumped['raw'] == [b'A', b'\xff']
    assert 'use_sim_time' in dumped
    assert 'unset' not in dumped


def test_a_busy_node_is_waited_for(processes: Any, domain: int) -> None:
    may_go_on = threading.Event()
    hint = 'gave no answer within 5 s; its node is busy or stopped, .*; Ctrl-C ends the waiting'
    asked = (('set', '/busy', 'load', '1.0'), ('dump', '/busy'), ('list', '/busy'))
    with SpunNodes(domain) as nodes:
        node = nodes.start(Node, 'busy', load=0.5)
        node.declare_parameter('load', 0.0)
        assert node.executor is not None
        node.executor.create_task(may_go_on.wait)
        commands = [processes.ros2('param', *words) for words in asked]
        for command in commands:
            find_line(command.stdout, hint)
        may_go_on.set()
        rests = [command.communicate(timeout=20.0)[0] for command in commands]
        assert node.get_parameter('load').value == 1.0
    assert [command.returncode for command in commands] == [0, 0, 0]
    for rest, said in zip(rests, ('Set parameter successful', 'load: ', '  load'), strict=True):
        assert said in rest


@pytest.mark.usefixtures('world')
def test_a_parameter_that_is_set_stays_set(ros2_here: Callable[..., Any]) -> None:
    assert (
        ros2_here('param', 'set', '/owner', 'wheel.radius', '7').out
        == 'Set parameter successful\n'
    )
    assert ros2_here('param', 'get', '/owner', 'wheel.radius', '--hide-type').out == '7\n'


@pytest.mark.usefixtures('world')
def test_what_cannot_be_done_is_said(ros2: Callable[..., Any]) -> None:
    bad = {
        ('get', '/owner', 'nothing'): (1, 'Parameter not set'),
        ('get', '/owner', 'sped'): (1, "Parameter not set; did you mean 'speed'?"),
        ('set', '/owner', 'sped', '0.7'): (0, "parameter(s): []; did you mean 'speed'?"),
        ('set', '/owner', 'speed', '1'): (0, "got 'Type.INTEGER'; write 1.0"),
        ('get', '/owne', 'speed'): (1, "Node not found: '/owne'; did you mean '/owner'?"),
        ('set', '/owner', 'speed', '7.0'): (0, 'Setting parameter failed: Parameter speed out'),
        ('set', '/owner', 'speed', 'fast'): (0, 'Setting parameter failed: Wrong parameter type'),
        ('set', '/owner', 'fixed', 'a'): (0, 'read-only'),
        ('set', '/owner', 'wheel.radius', '9' * 30): (1, 'an integer parameter has 64 bits'),
        ('delete', '/owner', 'speed'): (0, 'Deleting parameter failed'),
        ('load', '/owner', '/nothing.yaml'): (1, "'/nothing.yaml' cannot be read: No such file"),
        ('list', '--filter', '('): (1, 'is no regular expression'),
    }
    calls = [('ros2cli.cli', 'param', *words) for words in bad]
    results = run_forked(*calls, preload=('ros2param.verb.set', 'rclpy'))
    for (words, (status, message)), ended in zip(bad.items(), results, strict=True):
        assert ended.status == status, (words, ended)
        assert message in ended.err, words
    answer = ros2('param', 'get', '/owner', 'nothing')
    assert (answer.status, 'Parameter not set' in answer.err) == (1, True)


@pytest.mark.usefixtures('world')
def test_a_dump_can_be_loaded(ros2: Callable[..., Any], tmp_path: Path) -> None:
    dump = ros2('param', 'dump', '/owner').out
    assert '/owner:\n  ros__parameters:\n' in dump
    file = tmp_path / 'owner.yaml'
    file.write_text(dump)
    answer = ros2('param', 'load', '/owner', str(file))
    assert answer.status == 0  # although some can only be read
    assert 'Set parameter speed successful' in answer.lines
    assert 'Set parameter start_type_description_service failed: ' in answer.err


@pytest.mark.usefixtures('world')
def test_a_wildcard_is_loaded_unless_refused(
    ros2_here: Callable[..., Any], tmp_path: Path
) -> None:
    file = tmp_path / 'any.yaml'
    file.write_text('/**:\n  ros__parameters:\n    speed: 0.25\n    wheel:\n      radius: 9\n')
    refused = ros2_here('param', 'load', '/owner', str(file), '--no-use-wildcard')
    assert refused.status == 1
    assert 'does not contain selected parameters' in refused.err
    answer = ros2_here('param', 'load', '/owner', str(file))
    assert answer.lines == [
        'Set parameter speed successful',
        'Set parameter wheel.radius successful',
    ]
    assert ros2_here('param', 'get', '/owner', 'speed').out == 'Double value is: 0.25\n'


@pytest.mark.usefixtures('world')
def test_any_node_can_ask_for_parameters() -> None:
    context = rclpy.Context()
    rclpy.init(context=context)
    node = rclpy.create_node('asking', context=context)
    executor = SingleThreadedExecutor(context=context)
    executor.add_node(node)
    try:
        listed = api.call_list_parameters(node=node, node_name='/owner', prefixes=['wheel'])
        assert listed is not None
        assert list(listed.result().result.names) == ['wheel.radius']
        (value,) = api.call_get_parameters(
            node=node, node_name='/owner', parameter_names=['names']
        ).values
        assert api.get_value(parameter_value=value) == ['x', 'y']
        assert executor.get_nodes() == [node]
    finally:
        node.destroy_node()
        rclpy.shutdown(context=context)


def test_a_node_that_comes_late_is_waited_for(world: Any) -> None:
    asking = world.ros2('param', 'get', '/late', 'speed', '--timeout', '20')
    world.node('parameters', 'late')
    out, _ = asking.communicate(timeout=20)
    assert out == 'Double value is: 0.5\n'


@pytest.mark.usefixtures('world')
def test_descriptions_show_ranges(ros2: Callable[..., Any]) -> None:
    assert ros2('param', 'describe', '/owner', 'speed', 'fixed').lines == [
        'Parameter name: speed',
        '  Type: double',
        '  Description: how fast',
        '  Constraints:',
        '    Min value: 0.0',
        '    Max value: 1.0',
        'Parameter name: fixed',
        '  Type: string',
        '  Constraints:',
        '    Read only: true',
    ]
    missed = ros2('param', 'describe', '/owner', 'speed', 'fixd')
    assert missed.err == "Parameter not set: fixd; did you mean 'fixed'?\n", missed


@pytest.mark.usefixtures('world')
def test_a_loose_parameter_can_be_deleted(ros2: Callable[..., Any]) -> None:
    assert ros2('param', 'delete', '/owner', 'loose').out == 'Deleted parameter successfully\n'
