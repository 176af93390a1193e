# Copyright 2026 The Husky Playpen Lab authors
# SPDX-License-Identifier: Apache-2.0
"""
The shapes of a world as one body, at which MuJoCo casts rays.

It asks each ray about every body of a model, and about every geom of those: here there is one
body, with the geoms that were chosen alone.
"""

import copy

from husky_course.frames import Array, Indices
import mujoco
import numpy as np
import numpy.typing as npt

from husky_sim.sensors.poses import follow
from husky_sim.world.world import World

# What makes a mesh what it is; the rest is for collisions and pictures.
_MESH = ('content_type', 'file', 'inertia', 'refpos', 'refquat', 'scale', 'userface', 'uservert')
_MESHES = ('mesh_vert', 'mesh_face', 'mesh_vertadr', 'mesh_faceadr')


class RayScene:
    """Casts rays from one point at some geoms of a world. Not for two threads at once."""

    def __init__(self, world: World, moved: mujoco.MjData) -> None:
        """
        Prepare.

        :param world: with what is only seen.
        :param moved: where everything is, of a model with or without what is only seen.
        """
        self.model, self.data = world.model, mujoco.MjData(world.model)
        self._moved = moved
        # Of all bodies, each of which is asked: slower, and the same bit for bit.
        scene = _one_body(world) or copy.copy(world.model)
        self._chosen = mujoco.MjData(scene)
        scene.body_geomadr[0], scene.body_geomnum[:], scene.body_bvhadr[:] = 0, 0, -1
        scene.geom_matid[:], scene.geom_rgba[:] = -1, 1.0
        self._scene, self._count = scene, scene.body_geomnum
        self._places = self._chosen.geom_xpos, self._chosen.geom_xmat
        self._shapes = [
            (getattr(self.model, name), getattr(scene, name))
            for name in ('geom_type', 'geom_size', 'geom_dataid', 'geom_plugin')
        ]

    @property
    def is_one_body(self) -> bool:
        """Whether it could be made so; otherwise it has every body of the world."""
        return int(self._scene.nbody) == 1

    def follow(self) -> None:
        """Put every geom of the world, in `data`, where it is now."""
        follow(self._moved, self.model, self.data)

    def choose(self, geoms: Indices) -> None:
        """Have rays meet these geoms of the world, where they were put last."""
        count = self._count[0] = len(geoms)
        for given, chosen in self._shapes:
            given.take(geoms, 0, chosen[:count], 'clip')
        xpos, xmat = self._places
        self.data.geom_xpos.take(geoms, 0, xpos[:count], 'clip')
        self.data.geom_xmat.take(geoms, 0, xmat[:count], 'clip')

    def cast(
        self, origin: Array, vectors: Array, hits: npt.NDArray[np.int32], ranges_m: Array
    ) -> None:
        """
        Fill in how far each ray goes, and a negative hit for those that meet nothing.

        :param vectors: unit vectors, a row each.
        """
        mujoco.mj_multiRay(
            *(self._scene, self._chosen, origin, vectors.ravel(), None, True, -1),
            *(hits, ranges_m, None, len(hits), mujoco.mjMAXVAL),
        )


def _one_body(world: World) -> mujoco.MjModel | None:
    """Make a model of one body with the meshes of a world; None where it cannot have them."""
    model = world.model
    if model.nhfield or model.nplugin:
        return None
    spec = mujoco.MjSpec()
    spec.modelfiledir, spec.meshdir = world.spec.modelfiledir, world.spec.meshdir
    for number in range(model.nmesh):
        mesh, original = spec.add_mesh(), world.spec.mesh(model.mesh(number).name)
        for name in ('name', *_MESH):
            setattr(mesh, name, getattr(original, name))
    for _ in range(model.ngeom):
        spec.worldbody.add_geom(type=mujoco.mjtGeom.mjGEOM_SPHERE, size=[1.0, 0.0, 0.0])
    try:
        scene = spec.compile()
    except (ValueError, mujoco.FatalError):
        return None
    return scene if _have_same_meshes(scene, model) else None


def _have_same_meshes(one: mujoco.MjModel, other: mujoco.MjModel) -> bool:
    """Tell whether rays meet the meshes of both alike, bit for bit."""
    return all(map(np.array_equal, _meshes(one), _meshes(other)))


def _meshes(model: mujoco.MjModel) -> list[Array]:
    boxes = model.bvh_aabb[len(model.bvh_aabb) - sum(model.mesh_bvhnum) :]
    return [boxes, *(getattr(model, name) for name in _MESHES)]
