# Copyright 2026 The Husky Playpen Lab authors
# SPDX-License-Identifier: Apache-2.0
"""The codec against the rules, byte for byte, and against the middleware, for every type."""

from array import array
from functools import cache
from importlib import import_module
from typing import Any
from unittest import mock

from husky_sim.messages.cdr import decode, encode, encode_with_places
from hypothesis import example, given, settings, strategies
import numpy as np
import pytest
from rclpy.serialization import deserialize_message, serialize_message
from rosidl_parser import definition as idl
from std_msgs.msg import ByteMultiArray, Float32, Float64, Header, String, UInt8

PACKAGES = (
    *('std_msgs.msg', 'geometry_msgs.msg', 'nav_msgs.msg', 'sensor_msgs.msg'),
    *('diagnostic_msgs.msg', 'visualization_msgs.msg', 'builtin_interfaces.msg'),
    *('rosgraph_msgs.msg', 'rcl_interfaces.msg', 'lifecycle_msgs.msg', 'action_msgs.msg'),
    *('type_description_interfaces.msg', 'std_srvs.srv', 'action_msgs.srv', 'nav_msgs.srv'),
)


def kinds_of(package: str) -> list[Any]:
    """Return every message of a package, and the parts of its services."""
    kinds = []
    for kind in vars(import_module(package)).values():
        parts = [getattr(kind, name, None) for name in ('Request', 'Response', 'Event')]
        kinds += [each for each in (kind, *parts) if hasattr(each, 'SLOT_TYPES')]
    return kinds


def numbers_of(name: str) -> Any:
    if name == 'float':  # rosidl's own check refuses the greatest of all
        return strategies.floats(-(2.0**127), 2.0**127, width=32)
    if name == 'double':
        return strategies.floats(allow_nan=False)
    if name == 'boolean':
        return strategies.booleans()
    if name == 'octet':
        return strategies.binary(min_size=1, max_size=1)
    bits = int(name.lstrip('uint'))
    low = 0 if name.startswith('u') else -(1 << (bits - 1))
    return strategies.integers(low, low + (1 << bits) - 1)


def values_of(slot: Any) -> Any:
    if isinstance(slot, idl.AbstractNestedType):
        size = slot.size if isinstance(slot, idl.Array) else 0
        most = size or min(getattr(slot, 'maximum_size', 3), 3)
        return strategies.lists(values_of(slot.value_type), min_size=size, max_size=most)
    if isinstance(slot, idl.NamespacedType):
        whole = getattr(import_module('.'.join(slot.namespaces)), slot.name.partition('_')[0])
        return messages_of(getattr(import_module(whole.__module__), slot.name))
    if isinstance(slot, idl.AbstractString):
        letters = strategies.characters(exclude_characters='\0', codec='utf-8')
        return strategies.text(letters, max_size=9)
    return numbers_of(slot.typename)


@cache
def messages_of(kind: Any) -> Any:
    fields = zip(kind.get_fields_and_field_types(), kind.SLOT_TYPES, strict=True)
    return strategies.builds(kind, **{name: values_of(slot) for name, slot in fields})


def padding_of(message: Any) -> set[int]:
    """Return the places of the padding bytes."""
    with mock.patch('husky_sim.messages.cdr_stream._PADDING', b'\xff'):
        filled = encode(message)
    pairs = enumerate(zip(filled, encode(message), strict=True))
    return {place for place, (one, other) in pairs if one != other}


@pytest.mark.parametrize('package', PACKAGES)
@settings(max_examples=60)
@given(data=strategies.data())
def test_it_writes_and_reads_what_the_middleware_does(package: str, data: Any) -> None:
    message = data.draw(strategies.sampled_from(kinds_of(package)).flatmap(messages_of))
    kind, ours, theirs = type(message), encode(message), serialize_message(message)
    read = set(range(len(ours))) - padding_of(message)
    assert {place: ours[place] for place in read} == {place: theirs[place] for place in read}
    assert deserialize_message(ours, kind) == message
    assert decode(kind, theirs) == decode(kind, ours) == message


@pytest.mark.parametrize('package', PACKAGES)
def test_every_type_is_read_as_it_was_written(package: str) -> None:
    kinds = kinds_of(package)
    assert kinds
    for kind in kinds:
        data = encode(kind())
        message, received = decode(kind, data), deserialize_message(data, kind)
        assert message == kind() == received
        for name in kind.get_fields_and_field_types():
            field, other = getattr(message, name), getattr(received, name)
            assert type(field) is type(other)
            assert getattr(field, 'dtype', None) == getattr(other, 'dtype', None)


@pytest.mark.parametrize('value', [float('nan'), float('inf'), -0.0, 5e-324])
def test_numbers_beside_the_common_ones_stay_what_they_are(value: float) -> None:
    theirs = deserialize_message(encode(Float64(data=value)), Float64)
    assert encode(decode(Float64, encode(Float64(data=value)))) == encode(theirs)
    assert repr(theirs.data) == repr(value)


def kind_with(*slots: Any) -> Any:
    """Return a message class as rosidl makes it, with fields a, b, ... of these types."""

    class Made:
        SLOT_TYPES = slots

        def __init__(self, **fields: Any) -> None:
            vars(self).update(fields)

        @classmethod
        def get_fields_and_field_types(cls) -> dict[str, str]:
            return {'abcdef'[index]: str(slot) for index, slot in enumerate(slots)}

    return Made


BYTE, SHORT, LONG = (idl.BasicType(name) for name in ('uint8', 'int16', 'int64'))
BOOLEAN, OCTET = idl.BasicType('boolean'), idl.BasicType('octet')
FLOAT, DOUBLE = idl.BasicType('float'), idl.BasicType('double')
HEADER = idl.NamespacedType(['std_msgs', 'msg'], 'Header')
EMPTY = idl.NamespacedType(['std_msgs', 'msg'], 'Empty')


@pytest.mark.parametrize(
    ('slots', 'values', 'written'),
    [
        ([BYTE, SHORT], [1, -2], '01 00 feff'),
        ([BYTE, LONG, BYTE], [1, 2, 3], '01 00000000000000 0200000000000000 03'),
        ([idl.UnboundedString(), SHORT], ['ä', 1], '03000000 c3a400 00 0100'),
        ([idl.BoundedString(2)], [''], '01000000 00'),
        ([idl.UnboundedWString()], ['a€'], '02000000 61000000 ac200000'),
        ([idl.BoundedWString(1)], ['\uffff'], '01000000 ffff0000'),
        ([idl.BoundedString(1)], ['€'], '04000000 e282ac00'),
        ([idl.BoundedWString(3)], ['\U0001f600'], '02000000 3dd80000 00de0000'),
        ([idl.UnboundedSequence(LONG), BYTE], [array('q'), 7], '00000000 07'),
        ([idl.UnboundedSequence(LONG)], [array('q', [7])], '01000000 00000000 0700000000000000'),
        ([BYTE, idl.Array(SHORT, 2)], [1, np.array([2, 3], 'h')], '01 00 0200 0300'),
        ([idl.BoundedSequence(BOOLEAN, 2)], [[True, False]], '02000000 01 00'),
        ([idl.Array(OCTET, 2), BYTE], [[b'\1', b'\2'], 3], '01 02 03'),
        ([idl.Array(idl.UnboundedString(), 2)], [['a', '']], '02000000 6100 0000 01000000 00'),
        ([idl.Array(FLOAT, 2)], [np.array([1.5, np.inf], 'f')], '0000c03f 0000807f'),
        ([BYTE, EMPTY, BYTE], [1, import_module('std_msgs.msg').Empty(), 2], '01 00 02'),
        ([BYTE, HEADER], [1, Header(frame_id='m')], '01 000000 00000000 00000000 02000000 6d00'),
    ],
)
def test_the_rules_give_these_bytes(slots: list[Any], values: list[Any], written: str) -> None:
    kind = kind_with(*slots)
    fields = dict(zip('abcdef', values, strict=False))
    data = encode(kind(**fields))
    assert data.hex() == '00010000' + written.replace(' ', '')
    received = vars(decode(kind, data))
    assert {name: type(value) for name, value in received.items()} == {
        name: type(value) for name, value in fields.items()
    }
    for name, value in fields.items():
        assert np.array_equal(received[name], value)


def test_every_number_has_its_place() -> None:
    message = ByteMultiArray(data=[b'a', b'b'])
    data, place = encode_with_places(message)
    names = [name for name, _ in place.leaves()]
    assert names == ['layout.data_offset', 'data']
    assert (place['data'].begin, place['data'].count, place['data'].code) == (16, 2, 'c')
    assert bytes(data[16:18]) == b'ab'
    with pytest.raises(KeyError, match="'date': the parts are layout, data"):
        place['date']


def test_a_text_has_its_place_with_its_length_before_it() -> None:
    data, place = encode_with_places(String(data='ab'))
    assert (place['data'].begin, place['data'].size) == (4, 7)
    assert bytes(data[4:]) == b'\3\0\0\0ab\0'
    data, place = encode_with_places(kind_with(idl.UnboundedWString())(a='a€'))
    assert (place['a'].begin, place['a'].size) == (4, 12)
    assert bytes(data[4:]) == bytes.fromhex('02000000 61000000 ac200000')


@pytest.mark.parametrize(
    ('message', 'says'),
    [
        (UInt8(data=1), 'data: 300 is not of uint8'),
        (Float64(data=1.0), "data: 'x' is not of double"),
        (Float32(data=1.0), 'data: 1e[+]300 is not of float'),
        (String(data=''), r"data: 'a\\x00b' is no text without NUL"),
        (ByteMultiArray(), 'data: a row of 2 is not of octet'),
    ],
)
def test_a_value_of_another_kind_is_refused(message: Any, says: str) -> None:
    wrong = {'uint8': 300, 'double': 'x', 'float': 1e300, 'string': 'a\0b'}
    slot = type(message).get_fields_and_field_types()['data']
    message._data = wrong.get(slot, ['a', 1])  # as where no field is checked
    with pytest.raises(ValueError, match=says):
        encode(message)


def test_bytes_given_for_numbers_are_numbers() -> None:
    kind = kind_with(idl.UnboundedSequence(SHORT))
    assert encode(kind(a=b'abcd')) == encode(kind(a=array('h', [97, 98, 99, 100])))


def test_a_field_deep_within_is_named() -> None:
    header = Header()
    header.stamp._sec = 0.5
    with pytest.raises(ValueError, match=r'^stamp: sec: 0[.]5 is not of int32$'):
        encode(header)


@pytest.mark.parametrize(
    ('slot', 'value', 'says'),
    [
        (idl.BoundedSequence(BYTE, 2), array('B', b'abc'), '3 items; at most 2 are allowed'),
        (idl.Array(DOUBLE, 2), [0.0], '1 items; the array has 2'),
        (idl.BoundedString(2), 'abc', '3 characters; at most 2 are allowed'),
        (idl.BoundedWString(2), 'abc', '3 characters; at most 2 are allowed'),
        (HEADER, 3, '3 is no Header'),
        (idl.UnboundedSequence(BYTE), 3, 'has no len'),
        (idl.UnboundedString(), 3, '3 is no text'),
        (idl.UnboundedWString(), ['a'], r"\['a'\] is no text"),
        (idl.Array(FLOAT, 2), [0.0, 1e300], 'a row of 2 is not of float'),
        (idl.Array(SHORT, 2), [0.0, 1.0], 'a row of 2 is not of int16'),
        (idl.UnboundedSequence(BYTE), [255, 256], 'a row of 2 is not of uint8'),
    ],
)
def test_what_a_field_cannot_hold_is_refused(slot: Any, value: Any, says: str) -> None:
    with pytest.raises(ValueError, match=says):
        encode(kind_with(slot)(a=value))


@pytest.mark.parametrize(
    ('slot', 'data', 'says'),
    [
        (BYTE, '', 'begins with nothing; only 00 01 00 00 is read'),
        (BYTE, '00000000 01', 'begins with 00 00 00 00'),
        (DOUBLE, '00010000 01', 'a: ends after 5 bytes of 12 or more'),
        (BOOLEAN, '00010000 02', 'a: 02 is neither true'),
        (idl.UnboundedString(), '00010000 02000000 4142', 'no text with one NUL, at its end'),
        (idl.UnboundedString(), '00010000 03000000 410000', 'no text with one NUL, at its end'),
        (idl.UnboundedString(), '00010000 02000000 ff00', "can't decode byte 0xff"),
        (idl.UnboundedString(), '00010000 ffffffff 00', 'a: ends after 9 bytes'),
        (idl.UnboundedWString(), '00010000 01000000 00000100', '0x10000 is no unit of UTF-16'),
        (
            idl.UnboundedWString(),
            '00010000 02000000 61000000 00000200',
            '0x20000 is no unit of UTF-16',
        ),
        (idl.BoundedSequence(BYTE, 1), '00010000 02000000 0000', 'at most 1 are allowed'),
        (idl.BoundedString(1), '00010000 03000000 616200', '2 characters; at most 1 are allowed'),
        (
            idl.BoundedWString(1),
            '00010000 02000000 61000000 62000000',
            '2 characters; at most 1 are allowed',
        ),
        (idl.UnboundedSequence(HEADER), '00010000 ffffffff', 'a: stamp: sec: ends after 8'),
    ],
)
def test_bytes_that_are_no_such_message_are_refused(slot: Any, data: str, says: str) -> None:
    with pytest.raises(ValueError, match=f'^Made: .*{says}'):
        decode(kind_with(slot), bytes.fromhex(data))


@given(strategies.sampled_from(kinds_of('sensor_msgs.msg')), strategies.binary(max_size=200))
@example(Header, b'\xff' * 12)
def test_any_bytes_are_read_or_refused(kind: Any, data: bytes) -> None:
    try:
        decode(kind, b'\0\1\0\0' + data)
    except ValueError as error:
        assert str(error).startswith(f'{kind.__name__}: ')  # and no other error


@pytest.mark.parametrize('name', ['wchar', 'long double', 'char'])
def test_a_type_that_no_msg_file_has_is_refused(name: str) -> None:
    with pytest.raises(TypeError, match=f'{name}: no .msg file can ask for it; use boolean'):
        encode(kind_with(idl.BasicType(name))(a=1))


def test_what_is_no_message_type_is_refused() -> None:
    with pytest.raises(TypeError, match='int is no type of a message'):
        encode(3)
