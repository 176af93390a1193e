# Copyright 2026 The Husky Playpen Lab authors
# SPDX-License-Identifier: Apache-2.0
"""
What a page of ours may send: five kinds of messages, each with fields of the right type and size.

viser takes any of its messages from a page, also those that only a server sends, and of a control
any property, also the list of its callbacks. What is not here is not taken; a new element that
sends a message of its own needs it here. The names and fields are those of `viser._messages`.
"""

import math
from typing import Annotated, Literal

import msgspec
from msgspec import Meta

LONGEST = 200
"""Characters of a name or of a text."""

Number = Annotated[float, Meta(ge=-1e6, le=1e6)]  # refuses NaN, too
Angle = Annotated[float, Meta(gt=0.0, lt=math.pi)]
Pixels = Annotated[int, Meta(ge=0, le=65536)]
Text = Annotated[str, Meta(max_length=LONGEST)]
Index = Annotated[int, Meta(ge=0, lt=2**31)]
Vector = tuple[Number, Number, Number]
Place = tuple[Number, Number]


class Refused(Exception):
    """A message that no page of ours sends."""


class _Message(msgspec.Struct, frozen=True, tag=True, forbid_unknown_fields=True):
    pass


class ViewerCameraMessage(_Message, frozen=True):
    """Where the camera of the page is."""

    wxyz: tuple[Number, Number, Number, Number]
    position: Vector
    fov: Angle
    near: Number
    far: Number
    image_height: Pixels
    image_width: Pixels
    look_at: Vector
    up_direction: Vector


FIRST_CAMERA = msgspec.msgpack.encode(
    ViewerCameraMessage(
        wxyz=(1.0, 0.0, 0.0, 0.0),
        position=(-10.0, -10.0, 10.0),
        fov=math.radians(50.0),
        near=0.01,
        far=1000.0,
        image_height=800,
        image_width=1200,
        look_at=(0.0, 0.0, 0.0),
        up_direction=(0.0, 0.0, 1.0),
    )
)
"""The first message of a page that was clicked on before it told of its own camera."""


class NewValue(msgspec.Struct, frozen=True, forbid_unknown_fields=True):
    """The one property of a control that a page sets."""

    value: bool | Number | Text


class GuiUpdateMessage(_Message, frozen=True):
    """A control was clicked or has a new value."""

    uuid: Text
    updates: NewValue


class GuiButtonHoldMessage(_Message, frozen=True):
    """A button is held."""

    uuid: Text
    frequency: Number


class ScenePointerMessage(_Message, frozen=True):
    """A click into the scene."""

    event_type: Literal['click']
    ray_origin: Vector
    ray_direction: Vector
    screen_pos: tuple[Place]
    modifier: Text | None


class SceneNodeDragMessage(_Message, frozen=True):
    """A drag of something in the scene."""

    phase: Literal['start', 'update', 'end']
    name: Text
    instance_index: Index | None
    start_position: Vector
    start_screen_pos: Place
    end_position: Vector
    end_screen_pos: Place
    button: Literal['left', 'middle', 'right']
    modifier: Text | None
    owner: Text


Incoming = (
    ViewerCameraMessage
    | GuiUpdateMessage
    | GuiButtonHoldMessage
    | ScenePointerMessage
    | SceneNodeDragMessage
)
_decoder = msgspec.msgpack.Decoder(Incoming)


def read_message(raw: str | bytes) -> Incoming:
    """
    Read what a page has sent.

    :raises Refused: if it is none of these messages.
    """
    if isinstance(raw, str):
        raise Refused('text instead of MessagePack')
    try:
        return _decoder.decode(raw)
    except (msgspec.DecodeError, RecursionError, UnicodeError) as error:
        raise Refused(str(error)) from error
