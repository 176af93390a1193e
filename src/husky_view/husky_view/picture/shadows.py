# Copyright 2026 The Husky Playpen Lab authors
# SPDX-License-Identifier: Apache-2.0
"""
Soft dark spots on the ground, or everything would seem to float: the scene has no shadows.

They are meshes that get clearer ring by ring; those of one size are one mesh, drawn where each of
them is. As pictures they would be loaded one by one, before anything can be seen.
"""

from collections.abc import Sequence
import math
from typing import Any

from husky_course.frames import Array
from husky_course.outline import Outline
import numpy as np
import trimesh
import viser

from husky_view.picture.page import SHADOWS

REACH_M, OPACITY = 0.25, 0.75
"""How far a shadow is seen around what casts it, and how dark it is below."""

_RINGS, _CORNER_POINTS = 6, 6
# Light changes nothing on it (KHR_materials_unlit); its colours have their opacity.
_CLEAR = {
    'pbrMetallicRoughness': {},
    'alphaMode': 'BLEND',
    'extensions': {'KHR_materials_unlit': {}},
}

Place = tuple[float, float, float]
"""x and y in metres, yaw in radians."""


class ContactShadows:
    """
    Shadows under things of one size.

    :param size: of their outlines, as that of an Outline.
    """

    def __init__(
        self,
        server: viser.ViserServer,
        name: str,
        size: Sequence[float],
        places: Sequence[Place],
        height_m: float,
    ) -> None:
        self._height_m = height_m
        positions, turns = self._poses(places)
        self._spots = server.scene.add_batched_glb(
            name,
            soft_spot(size).export(file_type='glb', tree_postprocessor=_make_clear),
            batched_positions=positions,
            batched_wxyzs=turns,
            lod='off',
            cast_shadow=False,
            receive_shadow=False,
        )

    def move(self, places: Sequence[Place]) -> None:
        """Put them under what they belong to, in the same order."""
        self._spots.batched_positions, self._spots.batched_wxyzs = self._poses(places)

    def _poses(self, places: Sequence[Place]) -> tuple[Array, Array]:
        x, y, yaw = np.array(places, dtype=float).T
        none = np.zeros_like(yaw)
        positions = np.column_stack([x, y, np.full_like(x, self._height_m)])
        return positions, np.column_stack([np.cos(yaw / 2.0), none, none, np.sin(yaw / 2.0)])


class ObstacleShadows:
    """A shadow under each obstacle, also where one is pushed to."""

    def __init__(
        self, server: viser.ViserServer, outlines: Sequence[Outline], height_m: float
    ) -> None:
        self._shown = outlines
        self._shadows = [
            (
                size,
                ContactShadows(
                    server, f'{SHADOWS}{place}', size, _under(outlines, size), height_m
                ),
            )
            for place, size in enumerate(dict.fromkeys(map(_size, outlines)))
        ]

    def show(self, outlines: Sequence[Outline]) -> None:
        """Put them under the same obstacles, in the same order, where these are now."""
        moved = {_size(new) for new, old in zip(outlines, self._shown, strict=True) if new != old}
        for size, shadows in self._shadows:
            if size in moved:
                shadows.move(_under(outlines, size))
        self._shown = outlines


def _size(outline: Outline) -> tuple[float, ...]:
    return tuple(round(length_m, 2) for length_m in outline.size)


def _under(outlines: Sequence[Outline], size: tuple[float, ...]) -> list[Place]:
    return [(each.x, each.y, each.yaw) for each in outlines if _size(each) == size]


def soft_spot(size: Sequence[float]) -> trimesh.Trimesh:
    """Return a flat black mesh, dark under the outline and clear REACH_M away from it."""
    angles = (
        np.linspace(0.0, math.tau, 4 * _CORNER_POINTS, endpoint=False)
        + math.pi / 4 / _CORNER_POINTS
    )
    outwards = np.column_stack([np.cos(angles), np.sin(angles)])
    border = size[0] * outwards if len(size) == 1 else np.sign(outwards) * np.array(size) / 2.0
    count = len(outwards)
    away = np.linspace(0.0, 1.0, _RINGS)
    rings = border + REACH_M * away[:, None, None] * outwards
    vertices = np.zeros((1 + _RINGS * count, 3))  # the first one is the middle
    vertices[1:, :2] = rings.reshape(-1, 2)
    colors = np.zeros((len(vertices), 4), dtype=np.uint8)
    colors[:, 3] = 255.0 * OPACITY
    colors[1:, 3] = np.repeat(255.0 * OPACITY * (1.0 - away) ** 2, count)
    here = np.arange(count)
    there = (here + 1) % count
    faces = [np.column_stack([np.zeros(count), 1 + here, 1 + there])]
    for ring in range(1, 1 + (_RINGS - 1) * count, count):
        inner, outer = ring, ring + count
        faces.append(np.column_stack([inner + here, outer + here, outer + there]))
        faces.append(np.column_stack([inner + here, outer + there, inner + there]))
    mesh = trimesh.Trimesh(vertices, np.concatenate(faces).astype(int), process=False)
    mesh.visual = trimesh.visual.ColorVisuals(mesh, vertex_colors=colors)
    return mesh


def _make_clear(tree: dict[str, Any]) -> None:
    tree['materials'] = [_CLEAR]
    tree['extensionsUsed'] = ['KHR_materials_unlit']
    for mesh in tree['meshes']:
        for primitive in mesh['primitives']:
            primitive['material'] = 0
