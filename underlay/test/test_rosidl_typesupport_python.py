# Copyright 2026 The Husky Playpen Lab authors
# SPDX-License-Identifier: Apache-2.0
"""Messages in bytes and back, beside compiled types and an independent reader; the refusals."""

from __future__ import annotations

import json
from pathlib import Path
from random import Random
import struct
import subprocess
import sys
from typing import Any

from ament_index_python import get_package_share_directory
from example_interfaces.msg import Float64MultiArray, String, WString
from geometry_msgs.msg import Point, Pose
from husky_runtime.domains import in_own_domain
from husky_sim.messages.cdr import decode, encode
import numpy as np
from playpen_testing import interface_stress
from playpen_testing.fast_dds import without_port_race
from playpen_testing.random_messages import random_message
import pytest
from rclpy.serialization import deserialize_message, serialize_message
from rosidl_runtime_py import get_message_interfaces
from rosidl_runtime_py.utilities import get_message
from rosidl_typesupport_python.build_native import with_plain_stack
from rosidl_typesupport_python.cdr import codec_of
from rosidl_typesupport_python.cdr.row import CODES, Number, Place
from rosidl_typesupport_python.native import LIBRARY
from sensor_msgs.msg import JointState
from simulation_interfaces.msg import EntityInfo
from tf2_msgs.msg import TFMessage

HEADER = b'\0\1\0\0'  # CDR, little endian
SHIPPED = (
    *('action_tutorials_interfaces', 'composition_interfaces', 'example_interfaces'),
    *('control_msgs', 'rosbag2_interfaces', 'simulation_interfaces', 'tf2_msgs'),
)
NAMES = [
    f'{package}/{name}' for package, names in get_message_interfaces().items() for name in names
]
COMPILED = [name for name in NAMES if name.partition('/')[0] not in SHIPPED]
OURS = [name for name in NAMES if name.partition('/')[0] in SHIPPED]


@pytest.mark.parametrize('package', sorted({name.partition('/')[0] for name in COMPILED}))
def test_compiled_types_read_what_we_write_and_we_theirs(package: str) -> None:
    random = Random(package)
    for name in (name for name in COMPILED if name.startswith(f'{package}/')):
        kind = get_message(name)
        codec = codec_of(kind)
        for _ in range(3):
            message = random_message(kind, random)
            assert deserialize_message(HEADER + codec.encode(message), kind) == message, name
            assert codec.decode(bytes(serialize_message(message))[4:]) == message, name


@pytest.mark.parametrize('name', OURS)
def test_an_independent_reader_reads_shipped_messages(name: str) -> None:
    kind, random = get_message(name), Random(name)
    for _ in range(5):
        message = random_message(kind, random)
        data = bytes(serialize_message(message))
        assert data == encode(message)
        assert decode(kind, data) == message == deserialize_message(data, kind)


def test_what_is_read_is_as_if_it_had_been_made_in_python() -> None:
    made = JointState(name=['wheel'], position=[1.0])
    read = codec_of(JointState).decode(codec_of(JointState).encode(made))
    assert read == made
    assert [type(getattr(read, slot)) for slot in made.__slots__] == [
        type(getattr(made, slot)) for slot in made.__slots__
    ]
    read.position.append(2.0)
    assert list(read.position) == [1.0, 2.0]


@pytest.mark.parametrize('name', ['int64', 'uint64', 'int32', 'uint8'])
def test_an_array_that_is_read_prints_as_one_that_was_made(name: str) -> None:
    made = np.array([1, 2], dtype=name)
    read = Number(Place(('_numbers',), 0), CODES[name], 2).array(made.tobytes())
    assert (repr(read), read.dtype.char) == (repr(made), made.dtype.char)


def wrong(value: Any) -> Point:
    point = Point()
    point._x = value  # as `point.x = value` does where fields are not checked
    return point


def test_text_ends_at_its_first_zero_as_in_compiled_types() -> None:
    data = serialize_message(EntityInfo(description='a\0b'))
    assert deserialize_message(data, EntityInfo).description == 'a'


def test_a_value_of_another_type_is_refused_by_its_field() -> None:
    with pytest.raises(TypeError, match=r"^position\.x = 'left': not a double$"):
        codec_of(Pose).encode(Pose(position=wrong('left')))
    joints = JointState()
    joints._position = ['left']
    with pytest.raises(TypeError, match=r'^position: an item is not a double$'):
        codec_of(JointState).encode(joints)
    info = EntityInfo()
    info._tags = [7]
    with pytest.raises(TypeError, match=r'^tags: 7 is no str$'):
        serialize_message(info)
    info._tags, info.category._category = [], 256
    with pytest.raises(
        TypeError, match=r'^category\.category = 256: not an integer from 0 to 255'
    ):
        serialize_message(info)


def test_a_message_of_another_type_is_refused() -> None:
    transforms = TFMessage()
    transforms._transforms = [Point()]
    with pytest.raises(TypeError, match=r'^transforms: .*Point.* is no geometry_msgs/msg/Transf'):
        serialize_message(transforms)


def test_bytes_that_end_early_are_refused() -> None:
    whole = bytes(serialize_message(EntityInfo(description='a robot', tags=['fast', 'red'])))
    for length in range(4, len(whole)):
        with pytest.raises(ValueError, match='not the bytes of simulation_interfaces/msg/EntityI'):
            codec_of(EntityInfo).decode(whole[4:length])
        with pytest.raises(RuntimeError, match='failed to deserialize'):
            deserialize_message(whole[:length], EntityInfo)


def test_a_length_that_cannot_be_is_refused_at_once() -> None:
    for kind, before in ((TFMessage, 0), (Float64MultiArray, 8)):
        data = bytes(before) + b'\xff\xff\xff\xff'
        with pytest.raises(ValueError, match=f'the bytes end after {len(data)} of'):
            codec_of(kind).decode(data)


@pytest.mark.parametrize('kind', [0, 2, 3, 6, 7, 9, 11])
def test_other_encodings_are_refused_not_misread(kind: int) -> None:
    with pytest.raises(RuntimeError, match='deserialize'):
        deserialize_message(bytes([0, kind, 0, 0]) + bytes(16), TFMessage)


def test_text_that_is_no_text_is_read_as_far_as_it_is() -> None:
    assert codec_of(String).decode(b'\4\0\0\0a\xffb\0').data == 'a\N{REPLACEMENT CHARACTER}b'
    units = struct.pack('<4I', 3, ord('a'), 0xD800, 0x10000)
    assert codec_of(WString).decode(units).data == 'a' + 2 * '\N{REPLACEMENT CHARACTER}'


@pytest.mark.parametrize('kind', [String, WString])
def test_half_a_character_is_refused_by_its_field(kind: Any) -> None:
    with pytest.raises(ValueError, match=r"^data: .* can't encode .* surrogates not allowed$"):
        codec_of(kind).encode(kind(data='a\ud800'))


def test_the_library_asks_for_no_executable_stack() -> None:
    data = LIBRARY.read_bytes()
    begin, size, count = struct.unpack_from('<Q14xHH', data, 32)
    entries = [struct.unpack_from('<II', data, begin + size * i) for i in range(count)]
    assert (0x6474E551, 6) in entries, 'no PT_GNU_STACK that is only read and written'
    assert not any(flags & 3 == 3 for kind, flags in entries if kind == 1), 'written and executed'
    with pytest.raises(RuntimeError, match='without the header entry'):
        with_plain_stack(data)  # a second time


@pytest.mark.parametrize('part', ['library', 'fast_cdr'])
def test_what_cannot_be_loaded_is_told_in_a_line(part: str, tmp_path: Path) -> None:
    other = {
        'library': f'native.LIBRARY = native.Path({str(tmp_path / "none.so")!r})',
        'fast_cdr': "native._JUMP = '_ZN8eprosima7fastcdr3Cdr4leapEm'",
    }[part]
    program = (
        f'from rosidl_typesupport_python import native\n{other}\n'
        'from rclpy.serialization import serialize_message\n'
        'from tf2_msgs.msg import TFMessage\n'
        'serialize_message(TFMessage())\n'
    )
    done = subprocess.run([sys.executable, '-c', program], capture_output=True, text=True)
    last = done.stderr.splitlines()[-1]
    assert done.returncode == 1
    assert {'library': 'cannot be loaded', 'fast_cdr': 'not that of Fast CDR 2.2'}[part] in last
    assert 'lab' in last


@pytest.mark.parametrize('package', ['action_msgs', 'std_srvs'])
def test_a_package_made_again_has_the_hashes_of_its_wheel(package: str, tmp_path: Path) -> None:
    from colcon_rosidl_python.generator import generate

    share = Path(get_package_share_directory(package))
    definitions = [
        path for path in share.glob('*/*') if path.suffix in ('.msg', '.srv', '.action')
    ]
    needed = ['std_msgs', 'geometry_msgs']
    generate(
        package,
        [path.relative_to(share) for path in definitions],
        share,
        tmp_path,
        {name: Path(get_package_share_directory(name)) for name in needed},
    )
    for path in definitions:
        ours = (tmp_path / 'share' / package / path.relative_to(share)).with_suffix('.json')
        assert json.loads(ours.read_text()) == json.loads(path.with_suffix('.json').read_text())


@pytest.mark.parametrize(
    ('name', 'type_hash'),
    [  # as a Jazzy with C++ type supports announces them
        (
            'tf2_msgs/msg/TFMessage',
            'e369d0f05a23ae52508854b66f6aa0437f3449d652e8cbf22d5abe85d020f087',
        ),
        (
            'example_interfaces/srv/AddTwoInts',
            'e118de6bf5eeb66a2491b5bda11202e7b68f198d6f67922cf30364858239c81a',
        ),
    ],
)
def test_shipped_types_have_the_hashes_of_jazzy(name: str, type_hash: str) -> None:
    package, _, interface = name.partition('/')
    described = Path(get_package_share_directory(package), f'{interface}.json').read_text()
    assert {'type_name': name, 'hash_string': f'RIHS01_{type_hash}'} in json.loads(described)[
        'type_hashes'
    ]


def test_many_threads_at_once_neither_hang_nor_mix_up() -> None:
    with in_own_domain():
        words = [sys.executable, interface_stress.__file__, '3']
        done = subprocess.run(words, capture_output=True, text=True)
    assert done.returncode == 0, done.stderr
    counts = json.loads(without_port_race(done.stdout))
    assert all(map(counts.get, interface_stress.ALL)), counts


def test_a_message_loads_no_generator_and_the_generator_is_there() -> None:
    program = (
        'import sys\n'
        'from rclpy.serialization import serialize_message\n'
        'from std_msgs.msg import String\n'
        'serialize_message(String())\n'
        'print([name for name in ("em", "lark", "rosidl_pycommon") if name in sys.modules])\n'
        'import rosidl_generator_py\n'
        'print(hasattr(rosidl_generator_py, "generate_cpp"))\n'
        'print(rosidl_generator_py.generate_py.__module__)\n'
    )
    done = subprocess.run([sys.executable, '-c', program], capture_output=True, text=True)
    assert done.stdout.split('\n')[:3] == [
        '[]',
        'False',
        'rosidl_generator_py.generate_py_impl',
    ], done.stderr


def test_a_node_that_needs_no_arrays_does_not_load_numpy() -> None:
    program = (
        'import sys, rclpy, rosidl_runtime_py, rosidl_typesupport_python.cdr.codec\n'
        'from service_msgs.msg import ServiceEventInfo\n'
        'from std_msgs.msg import String\n'
        'rosidl_runtime_py.set_message_fields(message := String(), {"data": "said"})\n'
        'assert "said" in rosidl_runtime_py.message_to_yaml(message)\n'
        'rclpy.init()\n'
        "rclpy.create_node('plain')\n"
        "print('numpy' in sys.modules, ServiceEventInfo().client_gid.dtype)\n"
    )
    with in_own_domain():
        told = subprocess.check_output([sys.executable, '-c', program], text=True)
    assert without_port_race(told) == 'False uint8\n'
