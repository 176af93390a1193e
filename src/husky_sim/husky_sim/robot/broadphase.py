# Copyright 2026 The Husky Playpen Lab authors
# SPDX-License-Identifier: Apache-2.0
"""
Obstacles far from every robot are left out of the search for contacts.

MuJoCo's broad phase bounds and sorts all bodies in every step, which is a third of what a step in
the playpen costs. Left out is only what no robot can reach before it looks around again, and
MuJoCo sorts the pairs that are left. So contacts and trajectory are the same, bit for bit. While
no robot can reach anything, nobody need look at the contacts after each step, too: `alone`.

Why nothing that is left out can be touched: it stays where it is, being fixed to the world or
asleep; while anything but the robots is awake, nothing is left out, nor in a world with soft
bodies, whose bounds are not known here. A robot that has gone AGAIN_M looks around before the
next control period. Within a period of 20 ms it goes less than SLACK_M: that would take 10 m/s, a
robot faster than MAX_SPEED_M_S leaves nothing out, and motors and gravity change its speed by
less than 1 m/s in that time. What it wakes within the period meets its own neighbours, and they
theirs; so what is loose is looked at with all around it, as far as SLACK_M, too.
"""

from itertools import combinations
import math

from husky_course.frames import Array
import mujoco
import numpy as np

from husky_sim.config import CONTROL_PERIOD_SEC
from husky_sim.world.world import World

AGAIN_M = 0.3
SLACK_M = 0.2
MAX_SPEED_M_S = 2.0

Places = list[list[float]]
Flags = np.ndarray[tuple[int, ...], np.dtype[np.bool_]]


class BroadPhase:
    """Chooses, before every control period, the bodies that can take part in contacts."""

    def __init__(self, world: World, data: mujoco.MjData) -> None:
        model = world.model
        self._model, self._data = model, data
        self._bases = [model.body(f'{robot.name}/base_link').id for robot in world.robots]
        self._places = [data.xpos[base] for base in self._bases]
        self._reach_m = [_reach_m(model, base) + AGAIN_M + SLACK_M for base in self._bases]
        solid = {
            int(body)
            for body in model.geom_bodyid[world.owners >= 0]
            if model.body_rootid[body] not in self._bases
        }
        bodies = [body for body in range(1, model.nbody) if self._stays(body)]
        self._bodies = np.array(bodies, dtype=np.int64)
        self._solid: Flags = np.isin(self._bodies, list(solid))
        self._loose: Flags = model.body_treeid[self._bodies] >= 0
        self._can_be_alone = solid <= set(bodies)
        self._bits = [
            (field, field[self._bodies].copy())
            for field in (model.body_contype, model.body_conaffinity)
        ]
        turns = np.empty((model.ngeom, 9))
        for turn, quaternion in zip(turns, model.geom_quat, strict=True):
            mujoco.mju_quat2Mat(turn, quaternion)
        # A barrier that stands askew fills little of a box along the axes of the world.
        self._own_boxes = self._boxes_around(model.geom_pos, turns)
        self._is_soft = model.nflex > 0
        self._boxes: tuple[Array, Array] | None = None  # in world, while all is at rest
        self.reset()

    def _stays(self, body: int) -> bool:
        """Tell whether a body is not a robot's, can touch, and is fixed or can sleep."""
        model = self._model
        return (
            int(model.body_rootid[body]) not in self._bases
            and bool(model.body_contype[body] | model.body_conaffinity[body])
            and (int(model.body_weldid[body]) == 0 or int(model.body_treeid[body]) >= 0)
        )

    def reset(self) -> None:
        """Leave nothing out; to be called when robots were put somewhere else."""
        self._before = self._looked = [[math.inf] * 3] * len(self._bases)
        self._include_all()

    def update(self) -> None:
        """
        Choose for the coming control period.

        Afterwards `alone` tells whether each robot can meet nothing but the ground.
        """
        places = [place.tolist() for place in self._places]
        gone_m = _farthest_m(places, self._before)
        self._before = places
        # Not `<`: what is not a number is no reason to leave something out.
        is_fast = not gone_m <= MAX_SPEED_M_S * CONTROL_PERIOD_SEC
        if is_fast or self._is_soft or self._data.ntree_awake != len(self._bases):
            if not self._all:
                self._include_all()
            return
        since_m = math.inf if self._all else _farthest_m(places, self._looked)
        if not since_m <= AGAIN_M:
            self._look(places)
            since_m = 0.0
        self.alone = since_m < self._free_m

    def _look(self, places: Places) -> None:
        """Leave out what no robot can reach; note how far each can go and meet nothing."""
        near, self._free_m = np.zeros(len(self._bodies), dtype=bool), -math.inf
        if self._can_be_alone and self._are_apart(places):
            self._free_m = math.inf
        for place, reach_m in zip(places, self._reach_m, strict=True):
            away_m = self._away_m(place)
            near |= ~(away_m > reach_m)
            solid_m = float(away_m[self._solid].min(initial=math.inf))
            self._free_m = min(solid_m - (reach_m - AGAIN_M), self._free_m)
        self._looked, self._all = places, False
        self._include(self._with_neighbours(near))

    def _away_m(self, place: list[float]) -> Array:
        """Return how far the box around each body is from a place."""
        data, bodies = self._data, self._bodies
        turns = data.xmat[bodies].reshape(-1, 3, 3)
        from_body = np.einsum('nij,ni->nj', turns, place - data.xpos[bodies])
        low, high = self._own_boxes
        away = np.maximum(np.maximum(low - from_body, from_body - high), 0.0)
        away_m: Array = np.sqrt(np.einsum('ij,ij->i', away, away))
        return away_m

    def _with_neighbours(self, near: Flags) -> Flags:
        """Add what loose bodies could push, and what that could push, and so on."""
        pushed = near & self._loose
        if not pushed.any():
            return near
        if self._boxes is None:
            self._boxes = self._boxes_around(self._data.geom_xpos, self._data.geom_xmat)
        low, high = self._boxes
        while pushed.any():
            apart = low[pushed, None] - SLACK_M > high
            apart |= high[pushed, None] + SLACK_M < low
            beside = ~apart.any(axis=2).all(axis=0)
            pushed = beside & ~near & self._loose
            near = near | beside
        return near

    def _boxes_around(self, places: Array, turns: Array) -> tuple[Array, Array]:
        """
        Return the lowest and highest corners of the boxes around bodies, (n, 3).

        :param places: of all geoms in a frame, (ngeom, 3).
        :param turns: their rotation matrices there, (ngeom, 9).
        """
        model, matrices = self._model, turns.reshape(-1, 3, 3)
        middle = places + np.einsum('nij,nj->ni', matrices, model.geom_aabb[:, :3])
        half = np.einsum('nij,nj->ni', np.abs(matrices), model.geom_aabb[:, 3:])
        half += _margins_m(model)[:, None]
        half[model.geom_rbound <= 0.0] = np.inf  # a plane has no bounds
        low = np.full((model.nbody, 3), np.inf)
        high = -low
        np.minimum.at(low, model.geom_bodyid, middle - half)
        np.maximum.at(high, model.geom_bodyid, middle + half)
        return low[self._bodies], high[self._bodies]

    def _are_apart(self, places: Places) -> bool:
        """Tell whether no robot can reach another."""
        return all(
            math.dist(one, other) > one_m + other_m
            for (one, one_m), (other, other_m) in combinations(
                zip(places, self._reach_m, strict=True), 2
            )
        )

    def _include(self, near: Flags) -> None:
        for field, bits in self._bits:
            field[self._bodies] = np.where(near, bits, 0)

    def _include_all(self) -> None:
        self._all, self.alone = True, False
        self._boxes = None
        for field, bits in self._bits:
            field[self._bodies] = bits


def _farthest_m(places: Places, before: Places) -> float:
    """Return the longest way from one list of places to another."""
    return max(map(math.dist, places, before))


def _margins_m(model: mujoco.MjModel) -> Array:
    """Return from how far away each geom is in contact, in metres."""
    margins: Array = np.maximum(model.geom_margin + model.geom_gap, model.opt.o_margin)
    return margins


def _reach_m(model: mujoco.MjModel, body: int) -> float:
    """Return how far a body and its children can reach from its origin, however joints turn."""
    geoms = np.flatnonzero(model.geom_bodyid == body)
    geoms = geoms[(model.geom_contype | model.geom_conaffinity)[geoms] != 0]
    own = np.linalg.norm(model.geom_pos[geoms], axis=1) + model.geom_rbound[geoms]
    reach_m = float((own + _margins_m(model)[geoms]).max(initial=0.0))
    for child in np.flatnonzero(model.body_parentid == body).tolist():
        away_m = float(np.linalg.norm(model.body_pos[child])) + _play_m(model, child)
        reach_m = max(reach_m, away_m + _reach_m(model, child))
    return reach_m


def _play_m(model: mujoco.MjModel, body: int) -> float:
    """Return how far the joints of a body can move its origin; a slide has no bounds."""
    joints = np.flatnonzero(model.jnt_bodyid == body)
    if (model.jnt_type[joints] == mujoco.mjtJoint.mjJNT_SLIDE).any():
        return math.inf
    return float(2.0 * np.linalg.norm(model.jnt_pos[joints], axis=1).sum())
