# Copyright 2026 The Husky Playpen Lab authors
# SPDX-License-Identifier: Apache-2.0
"""What is drawn of a run beside its paths, as markers: the surroundings, and the robot itself."""

from collections.abc import Callable, Sequence
from itertools import count
import math
from typing import Any

from geometry_msgs.msg import Point, Pose, Quaternion, Vector3
from husky_course.outline import Outline
from husky_course.record import Collision
from husky_course.robot import ROBOT_LENGTH_M, ROBOT_WIDTH_M
from husky_course.route import Route
from husky_sim.messages import PackedMessage
from std_msgs.msg import ColorRGBA
from visualization_msgs.msg import Marker, MarkerArray

OUTLINE_HEIGHT_M = 0.1  # an outline has none, but is seen from the side, too
ROBOT_HEIGHT_M = 0.39  # of the A200, from the ground
FRONT_M = 0.12  # how much of the length is darker: where it drives to
_LETTER_M, _PIN_M = 0.35, 0.25

_GREY, _RED, _GREEN = (0.62, 0.63, 0.66), (0.83, 0.18, 0.18), (0.18, 0.49, 0.2)
_YELLOW, _BLACK = (0.99, 0.75, 0.1), (0.13, 0.13, 0.13)
Color = tuple[float, float, float]


def surroundings(
    obstacles: Sequence[Outline], touches: Sequence[Collision], route: Route
) -> MarkerArray:
    """Return outlines of obstacles, numbers of waypoints, and a pin where each collision was."""
    touched = {touch.obstacle for touch in touches}
    ids = count()
    markers = [_obstacle(outline, outline.name in touched) for outline in obstacles]
    for number, waypoint in enumerate(route.course.waypoints, 1):
        place = (waypoint.x_m, waypoint.y_m, 0.2)
        markers.append(_text('waypoints', 'odom', str(number), place, _GREEN))
    for touch in touches:
        x, y, z = touch.position
        pin = _marker('collisions', 'world', Marker.SPHERE, (_PIN_M,) * 3, _RED)
        pin.pose.position = Point(x=x, y=y, z=z)
        told = f'{touch.obstacle}, {touch.time_sec:.1f} s'
        markers += [pin, _text('collisions', 'world', told, (x, y, z + 0.6), _RED)]
    for marker in markers:
        marker.id = next(ids)
    return MarkerArray(markers=markers)


class RobotMarkers(PackedMessage):
    """The robot in the frame world, a box with a darker front, of which only the pose changes."""

    def __init__(self) -> None:
        back_m = ROBOT_LENGTH_M - FRONT_M
        self._along_m = -FRONT_M / 2, back_m / 2  # the middles of the parts
        parts = [
            _marker('robot', 'world', Marker.CUBE, (length, ROBOT_WIDTH_M, ROBOT_HEIGHT_M), color)
            for length, color in ((back_m, _YELLOW), (FRONT_M, _BLACK))
        ]
        parts[1].id = 1
        super().__init__(MarkerArray(markers=parts))
        places = self.places['markers']
        self._stamps = [self.packer(places[i]['header']['stamp']) for i in range(2)]
        self._poses: list[Callable[..., None]] = [self.packer(places[i]['pose']) for i in range(2)]

    def pack(self, stamp: tuple[int, int], x: float, y: float, yaw: float) -> None:
        """Pack where the robot is."""
        z, w = math.sin(yaw / 2), math.cos(yaw / 2)
        for pack_stamp, pack, along in zip(self._stamps, self._poses, self._along_m, strict=True):
            pack_stamp(*stamp)
            east, north = x + along * math.cos(yaw), y + along * math.sin(yaw)
            pack(east, north, ROBOT_HEIGHT_M / 2, 0.0, 0.0, z, w)


def _obstacle(outline: Outline, is_touched: bool) -> Marker:
    kind = Marker.CYLINDER if outline.type == 'circle' else Marker.CUBE
    x, y = (2 * outline.size[0],) * 2 if outline.type == 'circle' else outline.size
    color = _RED if is_touched else _GREY
    marker = _marker('obstacles', 'world', kind, (x, y, OUTLINE_HEIGHT_M), color)
    marker.pose = Pose(
        position=Point(x=outline.x, y=outline.y, z=OUTLINE_HEIGHT_M / 2),
        orientation=Quaternion(z=math.sin(outline.yaw / 2), w=math.cos(outline.yaw / 2)),
    )
    return marker


def _text(
    space: str, frame_id: str, text: str, place: tuple[float, float, float], color: Color
) -> Marker:
    marker = _marker(space, frame_id, Marker.TEXT_VIEW_FACING, (0.0, 0.0, _LETTER_M), color)
    marker.pose.position = Point(**dict(zip('xyz', place, strict=True)))
    marker.text = text
    return marker


def _marker(
    space: str, frame_id: str, kind: int, size: tuple[float, float, float], color: Color
) -> Any:
    red, green, blue = color
    marker = Marker(ns=space, type=kind, action=Marker.ADD, frame_locked=True)
    marker.header.frame_id = frame_id
    marker.scale = Vector3(**dict(zip('xyz', size, strict=True)))
    marker.color = ColorRGBA(r=red, g=green, b=blue, a=1.0)
    return marker
