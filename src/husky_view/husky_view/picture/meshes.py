# Copyright 2026 The Husky Playpen Lab authors
# SPDX-License-Identifier: Apache-2.0
"""
Meshes of mjviser that reflect light as paint and concrete do, and are few.

mjviser 0.0.14 gives coloured meshes no material. A glTF mesh without one is metal
(`metallicFactor` 1, glTF 2.0, section 3.9.2), and metal with nothing to mirror is black on every
side away from the suns. Its colours, too, are written as they are on a screen.

Of bodies that are alike it makes one mesh where they can move, and one each where they cannot: a
page takes longer to make those than to draw them.
"""

from collections.abc import Iterator
from contextlib import contextmanager
from typing import Any

from mjviser import scene as mjviser_scene
import mujoco
import numpy as np
import numpy.typing as npt
import trimesh

_PAINT = {'pbrMetallicRoughness': {'metallicFactor': 0.0, 'roughnessFactor': 0.9}}


class _MatteMesh(trimesh.Trimesh):
    """A mesh that is written with a material."""

    def export(self, *args: Any, **options: Any) -> Any:
        """Write the mesh; see trimesh."""
        return super().export(*args, tree_postprocessor=_paint, **options)


def _paint(tree: dict[str, Any]) -> None:
    if 'materials' in tree:
        return  # it has a texture, with a material of mjviser's own
    tree['materials'] = [_PAINT]
    for mesh in tree['meshes']:
        for primitive in mesh['primitives']:
            primitive['material'] = 0


def _linear(colors: npt.NDArray[np.uint8]) -> npt.NDArray[np.uint8]:
    """Return colours as the light that they reflect (IEC 61966-2-1), as glTF has them."""
    seen = colors / 255.0
    light = np.where(seen <= 0.04045, seen / 12.92, ((seen + 0.055) / 1.055) ** 2.4)
    light[:, 3] = seen[:, 3]
    return np.rint(light * 255.0).astype(np.uint8)


@contextmanager
def matte_meshes() -> Iterator[None]:
    """Have mjviser make its meshes matte meanwhile; for one thread at a time."""
    merge = mjviser_scene.merge_geoms

    def merge_matte(model: mujoco.MjModel, geoms: list[int]) -> trimesh.Trimesh:
        merged = merge(model, geoms)
        visual = merged.visual
        if isinstance(visual, trimesh.visual.ColorVisuals):
            visual.vertex_colors = _linear(visual.vertex_colors)
        return _MatteMesh(
            vertices=merged.vertices, faces=merged.faces, visual=visual, process=False
        )

    mjviser_scene.merge_geoms = merge_matte
    try:
        yield
    finally:
        mjviser_scene.merge_geoms = merge


@contextmanager
def alike_meshes_as_one() -> Iterator[None]:
    """Have mjviser draw bodies at once that are alike, also where they stand still."""
    is_fixed = mjviser_scene.is_fixed_body

    def has_ground(model: mujoco.MjModel, body: int) -> bool:
        first = int(model.body_geomadr[body])
        kinds = model.geom_type[first : first + int(model.body_geomnum[body])]
        return body == 0 or int(mujoco.mjtGeom.mjGEOM_PLANE) in kinds

    mjviser_scene.is_fixed_body = lambda model, body: (
        is_fixed(model, body) and has_ground(model, body)
    )
    try:
        yield
    finally:
        mjviser_scene.is_fixed_body = is_fixed
