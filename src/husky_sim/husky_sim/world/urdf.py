# Copyright 2026 The Husky Playpen Lab authors
# SPDX-License-Identifier: Apache-2.0
"""
The Husky as a URDF, made of what MuJoCo simulates, for programs that show robots.

Links and joints have the names of /tf and /joint_states. What URDF has no shape for: a capsule
becomes the cylinder between its ends, and a mesh is that of the same name in this package.
"""

from collections.abc import Iterator, Mapping, Sequence
import math
from pathlib import Path
from xml.etree import ElementTree

import mujoco
import numpy as np
from numpy.typing import NDArray

from husky_sim.world.fixed_frames import FIXED_FRAMES, Frame

_BASE = 'base_link'
_SEEN = range(3)  # the groups of geoms that MuJoCo's viewer shows
_MESHES = 'package://husky_sim/meshes'
_INERTIA = ('ixx', 'ixy', 'ixz', 'iyy', 'iyz', 'izz')

_Vector = NDArray[np.float64]


def urdf_of(husky: Path, fixed: Mapping[str, Frame] = FIXED_FRAMES) -> str:
    """
    Return the URDF of a robot's file, in metres, kilograms and radians.

    :param fixed: the frames that never move in base_link; each is a link.
    :raises ValueError: when MuJoCo cannot read the file.
    """
    model = mujoco.MjModel.from_xml_path(str(husky))
    robot = ElementTree.Element('robot', name='husky')
    for material in range(model.nmat):
        named = ElementTree.SubElement(robot, 'material', name=model.material(material).name)
        ElementTree.SubElement(named, 'color', rgba=_numbers(model.mat_rgba[material]))
    base = model.body(_BASE).id
    _link(robot, model, base)
    for body in range(model.nbody):
        if model.body_parentid[body] == base:
            _link(robot, model, body)
            _wheel_joint(robot, model, body)
    for name, frame in fixed.items():
        ElementTree.SubElement(robot, 'link', name=name)
        _joint(robot, 'fixed', f'{name}_joint', name, frame)
    ElementTree.indent(robot)
    return ElementTree.tostring(robot, encoding='unicode') + '\n'


def _link(robot: ElementTree.Element, model: mujoco.MjModel, body: int) -> None:
    link = ElementTree.SubElement(robot, 'link', name=model.body(body).name)
    inertial = ElementTree.SubElement(link, 'inertial')
    _origin(inertial, model.body_ipos[body], model.body_iquat[body])
    ElementTree.SubElement(inertial, 'mass', value=f'{model.body_mass[body]:.6g}')
    moments = dict(zip(('ixx', 'iyy', 'izz'), model.body_inertia[body], strict=True))
    ElementTree.SubElement(
        inertial,
        'inertia',
        {name: f'{moments.get(name, 0.0):.6g}' for name in _INERTIA},
    )
    for geom in _geoms(model, body):
        if model.geom_group[geom] in _SEEN:
            visual = ElementTree.SubElement(link, 'visual')
            _shape(visual, model, geom)
            if (material := model.geom_matid[geom]) >= 0:
                ElementTree.SubElement(visual, 'material', name=model.material(material).name)
        if model.geom_contype[geom] or model.geom_conaffinity[geom]:
            _shape(ElementTree.SubElement(link, 'collision'), model, geom)


def _geoms(model: mujoco.MjModel, body: int) -> Iterator[int]:
    first = model.body_geomadr[body]
    yield from range(first, first + model.body_geomnum[body])


def _shape(shown: ElementTree.Element, model: mujoco.MjModel, geom: int) -> None:
    """Add the place and the shape of a geom."""
    place, turn, size = model.geom_pos[geom], model.geom_quat[geom], model.geom_size[geom]
    mesh = model.geom_dataid[geom]
    if mesh >= 0:  # MuJoCo moves meshes into their own axes of inertia
        back, away = np.zeros(4), np.zeros(3)
        mujoco.mju_negPose(away, back, model.mesh_pos[mesh], model.mesh_quat[mesh])
        of, by = np.zeros(3), np.zeros(4)
        mujoco.mju_mulPose(of, by, place, turn, away, back)
        place, turn = of, by
    _origin(shown, place, turn)
    geometry = ElementTree.SubElement(shown, 'geometry')
    kind = mujoco.mjtGeom(int(model.geom_type[geom]))
    if mesh >= 0:
        name = model.mesh(mesh).name
        ElementTree.SubElement(geometry, 'mesh', filename=f'{_MESHES}/{name}.stl')
    elif kind == mujoco.mjtGeom.mjGEOM_SPHERE:
        ElementTree.SubElement(geometry, 'sphere', radius=f'{size[0]:.6g}')
    elif kind == mujoco.mjtGeom.mjGEOM_BOX:
        ElementTree.SubElement(geometry, 'box', size=_numbers(2.0 * size))
    elif kind in (mujoco.mjtGeom.mjGEOM_CYLINDER, mujoco.mjtGeom.mjGEOM_CAPSULE):
        ElementTree.SubElement(
            geometry, 'cylinder', radius=f'{size[0]:.6g}', length=f'{2.0 * size[1]:.6g}'
        )
    else:
        raise ValueError(f'{model.geom(geom).name or "a geom"}: URDF has no such shape')


def _wheel_joint(robot: ElementTree.Element, model: mujoco.MjModel, body: int) -> None:
    joint = model.body_jntadr[body]
    frame = Frame(tuple(model.body_pos[body]), tuple(model.body_quat[body]))
    made = _joint(robot, 'continuous', model.joint(joint).name, model.body(body).name, frame)
    ElementTree.SubElement(made, 'axis', xyz=_numbers(model.jnt_axis[joint]))


def _joint(
    robot: ElementTree.Element, kind: str, name: str, child: str, frame: Frame
) -> ElementTree.Element:
    joint = ElementTree.SubElement(robot, 'joint', name=name, type=kind)
    ElementTree.SubElement(joint, 'parent', link=_BASE)
    ElementTree.SubElement(joint, 'child', link=child)
    _origin(joint, frame.position_m, frame.orientation)
    return joint


def _origin(of: ElementTree.Element, place: Sequence[float], turn: Sequence[float]) -> None:
    angles = _roll_pitch_yaw(*map(float, turn))
    ElementTree.SubElement(of, 'origin', xyz=_numbers(place), rpy=_numbers(angles))


def _roll_pitch_yaw(w: float, x: float, y: float, z: float) -> tuple[float, float, float]:
    """Return the turns about the fixed axes x, y and z, in radians (REP-103)."""
    sine = max(-1.0, min(1.0, 2.0 * (w * y - z * x)))
    if abs(sine) > 1.0 - 1e-9:  # looking straight up or down: all of the turn is roll
        return 2.0 * math.atan2(x, w), math.copysign(math.pi / 2.0, sine), 0.0
    roll = math.atan2(2.0 * (w * x + y * z), 1.0 - 2.0 * (x * x + y * y))
    return roll, math.asin(sine), math.atan2(2.0 * (w * z + x * y), 1.0 - 2.0 * (y * y + z * z))


def _numbers(values: Sequence[float]) -> str:
    return ' '.join(f'{float(value):.6g}' for value in values)
