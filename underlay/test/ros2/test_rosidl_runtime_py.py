# Copyright 2026 The Husky Playpen Lab authors
# SPDX-License-Identifier: Apache-2.0
"""rosidl_runtime_py: messages from and to text, and where their definitions are."""

from __future__ import annotations

import array
from collections import OrderedDict
from pathlib import Path
from typing import Any

from builtin_interfaces.msg import Time
from diagnostic_msgs.msg import DiagnosticStatus, KeyValue
from geometry_msgs.msg import Point, Point32, Polygon, Twist
import pytest
from rosidl_parser.definition import UnboundedSequence
import rosidl_runtime_py
from rosidl_runtime_py import (
    get_interface_path,
    get_interfaces,
    get_message_slot_types,
    import_message_from_namespaced_type,
    message_to_csv,
    message_to_ordereddict,
    message_to_yaml,
    set_message_fields,
)
from rosidl_runtime_py.utilities import (
    get_action,
    get_interface,
    get_message,
    get_message_namespaced_type,
    get_service,
)
from sensor_msgs.msg import Imu, JointState
from std_msgs.msg import Bool, Header, String, UInt8MultiArray
from turtlesim.srv import SetPen
import yaml


def test_the_module_exports_what_upstream_does() -> None:
    assert {
        'get_action_interfaces', 'get_interface_packages', 'get_interface_path',
        'get_interfaces', 'get_message_interfaces', 'get_message_slot_types',
        'get_service_interfaces', 'import_message_from_namespaced_type', 'message_to_csv',
        'message_to_ordereddict', 'message_to_yaml', 'set_message_fields',
    } <= set(rosidl_runtime_py.__all__)  # fmt: skip


def test_yaml_shows_fields_in_their_order_and_reads_back() -> None:
    msg = Twist()
    set_message_fields(msg, {'linear': {'y': 2}, 'angular': {'z': -1.5}})
    text = message_to_yaml(msg)
    assert text.startswith('linear:\n  x: 0.0\n  y: 2.0\n')
    again = Twist()
    set_message_fields(again, yaml.safe_load(text))
    assert again == msg


def test_long_values_are_cut_or_abbreviated() -> None:
    msg = UInt8MultiArray(data=[1, 2, 3, 4])
    assert message_to_ordereddict(msg, truncate_length=2)['data'] == [1, 2, '...']
    assert message_to_ordereddict(msg, no_arr=True)['data'] == '<sequence type: uint8, length: 4>'
    imu = message_to_ordereddict(Imu(), no_arr=True)
    assert imu['orientation_covariance'] == '<array type: double[9]>'
    assert message_to_yaml(String(data='abcdef'), truncate_length=3) == 'data: abc...\n'
    assert message_to_yaml(String(data='abc'), no_str=True) == "data: '<string length: <3>>'\n"


def test_csv_is_one_line_and_flow_style_has_arrays_in_one() -> None:
    msg = Header(stamp=Time(sec=1, nanosec=2), frame_id='map')
    assert message_to_csv(msg) == '1,2,map'
    # As upstream: no comma before the first text that is not empty, and no other is left out.
    assert message_to_csv(UInt8MultiArray(data=[1, 2])) == '0,1,2'
    assert message_to_csv(JointState(name=['a'], position=[1.0])) == '0,0,,a,1.0,,'
    joints = JointState(header=msg, name=['a', 'b'])
    assert message_to_yaml(joints, flow_style=True) == (
        'header:\n  stamp:\n    sec: 1\n    nanosec: 2\n  frame_id: map\n'
        'name: [a, b]\nposition: []\nvelocity: []\neffort: []\n'
    )
    polygon = Polygon(points=[Point32(x=1.0)])
    assert message_to_yaml(polygon, flow_style=True) == 'points: [{x: 1.0, y: 0.0, z: 0.0}]\n'


def test_dictionaries_keep_the_order_of_the_definition() -> None:
    assert list(message_to_ordereddict(JointState())) == [
        'header', 'name', 'position', 'velocity', 'effort',
    ]  # fmt: skip
    assert isinstance(get_message_slot_types(Point()), OrderedDict)


def test_arrays_of_messages_bytes_and_numbers_are_filled() -> None:
    status = DiagnosticStatus()
    set_message_fields(status, {'level': 2, 'values': [{'key': 'a', 'value': 1}]})
    assert status.level == b'\x02'
    set_message_fields(status, {'level': [3]})  # as upstream takes a byte
    assert status.level == b'\x03'
    assert status.values == [KeyValue(key='a', value='1')]
    joints = JointState()
    set_message_fields(joints, {'name': ['a', 'b'], 'position': [1, '2.5']})
    assert joints.position == array.array('d', [1.0, 2.5])
    polygon = Polygon()
    set_message_fields(polygon, {'points': [{'x': 1}]})
    assert polygon.points[0].x == 1.0


def test_a_truth_may_stand_in_quotes() -> None:
    for text, truth in (('true', True), ('True', True), ('off', False), ('FALSE', False)):
        msg = Bool(data=not truth)
        set_message_fields(msg, {'data': text})
        assert msg.data is truth


def test_auto_and_now_give_functions_that_set_the_time() -> None:
    msg = Imu()
    (set_stamp,) = set_message_fields(msg, {'header': 'auto'}, expand_header_auto=True)
    set_stamp(Time(sec=7))
    assert msg.header.stamp.sec == 7
    header = Header()
    (set_stamp,) = set_message_fields(header, {'stamp': 'now'}, expand_time_now=True)
    set_stamp(Time(sec=8))
    assert header.stamp.sec == 8
    with pytest.raises(
        TypeError, match=r"^Value 'auto' is expected to be a dictionary but is a str$"
    ):
        set_message_fields(Imu(), {'header': 'auto'})


@pytest.mark.parametrize(
    ('values', 'error', 'message'),
    [
        ({'lin': {}}, AttributeError, "no attribute 'lin'; its fields are linear, angular"),
        (
            {'linear': {'x:0.5': None}},
            AttributeError,
            "'x:0.5'; its fields are x, y, z; write 'x: 0.5', with a blank behind the colon",
        ),
        (
            {'linear': {'x': 0, 5: None}},
            AttributeError,
            "no attribute '5'; its fields are x, y, z; decimals have a point, as in 0.5",
        ),
        ({'linear': 1}, TypeError, 'expected to be a dictionary but is a int'),
        ({'linear': {'x': 'fast'}}, ValueError, r"linear\.x: 'fast' is refused"),
        ([], TypeError, 'expected to be a dictionary'),
    ],
)
def test_a_value_that_does_not_fit_is_refused(
    values: Any, error: type[Exception], message: str
) -> None:
    with pytest.raises(error, match=message):
        set_message_fields(Twist(), values)


def test_a_field_that_yaml_takes_for_a_truth_value_is_told() -> None:
    meant = "no attribute 'False'; .*; YAML takes off for False: put it in quotes, 'off'$"
    with pytest.raises(AttributeError, match=meant):
        set_message_fields(SetPen.Request(), yaml.safe_load('{r: 1, off: 0}'))
    set_message_fields(SetPen.Request(), yaml.safe_load("{r: 1, 'off': 0}"))
    with pytest.raises(AttributeError, match=r"no attribute 'True'; its fields are [a-z, ]*$"):
        set_message_fields(SetPen.Request(), yaml.safe_load('{on: 0}'))


def test_the_length_of_an_array_is_checked() -> None:
    with pytest.raises(ValueError, match='2 elements, expected exactly 9'):
        set_message_fields(Imu(), {'orientation_covariance': [1, 2]})
    with pytest.raises(TypeError, match=r"level: '\[1, 2\]' is refused"):
        set_message_fields(DiagnosticStatus(), {'level': [1, 2]})
    with pytest.raises(ValueError, match=r'data\[1\]: 300 does not fit uint8'):
        set_message_fields(UInt8MultiArray(), {'data': [1, 300]})


def test_interfaces_are_found_by_name() -> None:
    assert get_message('std_msgs/msg/String') is String
    assert get_message('std_msgs/String') is String
    assert get_service('std_srvs/srv/Empty').Request
    assert get_interface('std_msgs/msg/String') is String
    string = get_message_namespaced_type('std_msgs/String')
    assert import_message_from_namespaced_type(string) is String
    with pytest.warns(DeprecationWarning, match='pass its value_type'):
        assert import_message_from_namespaced_type(UnboundedSequence(string)) is String
    with pytest.raises(ValueError, match="full name of a message, got 'std_srvs/srv/Empty'"):
        get_message('std_srvs/srv/Empty')
    with pytest.raises(ValueError, match='is no interface'):
        get_message('String')
    with pytest.raises(ModuleNotFoundError):
        get_action('nothing/action/A')


def test_definitions_are_found_by_name() -> None:
    assert Path(get_interface_path('std_msgs/msg/String')).name == 'String.msg'
    assert Path(get_interface_path('std_srvs/srv/Empty')).name == 'Empty.srv'
    assert Path(get_interface_path('std_msgs/msg/String.idl')).suffix == '.idl'
    assert get_interfaces(['std_srvs']) == {
        'std_srvs': ['srv/Empty', 'srv/SetBool', 'srv/Trigger']
    }
    with pytest.raises(LookupError, match="Unknown package 'nothing'"):
        get_interfaces(['nothing'])
    with pytest.raises(LookupError, match=r"Could not find the interface '.*\.idl'"):
        get_interface_path('std_msgs/msg/Nothing')
    with pytest.raises(ValueError, match='Invalid name'):
        get_interface_path('std_msgs')
