# Copyright 2026 The Husky Playpen Lab authors
# SPDX-License-Identifier: Apache-2.0
"""The URDF against the MJCF that it is made of, read again by MuJoCo."""

from collections import Counter
from pathlib import Path
from xml.etree import ElementTree

from husky_course.frames import Array
from husky_sim.world import default_worlds, FIXED_FRAMES, urdf_of
import mujoco
import numpy as np
import pytest

HUSKY = default_worlds() / 'husky.xml'
MESHES = Path(__file__).resolve().parents[1] / 'meshes'
WHEELS = tuple(f'{end}_{side}_wheel' for end in ('front', 'rear') for side in ('left', 'right'))


@pytest.fixture(scope='module')
def robot() -> ElementTree.Element:
    return ElementTree.fromstring(urdf_of(HUSKY))


def read_by_mujoco(robot: ElementTree.Element) -> mujoco.MjModel:
    """Return what MuJoCo makes of a URDF; meshes, which it looks for by file, are left out."""
    for link in robot.iter('link'):
        for part in [*link.iter('visual'), *link.iter('collision')]:
            if part.find('geometry/mesh') is not None:
                link.remove(part)
    compiler = '<mujoco><compiler fusestatic="false" discardvisual="false"/></mujoco>'
    robot.append(ElementTree.fromstring(compiler))
    return mujoco.MjModel.from_xml_string(ElementTree.tostring(robot, encoding='unicode'))


def inertia(model: mujoco.MjModel, body: str) -> Array:
    number, turn = model.body(body).id, np.zeros(9)
    mujoco.mju_quat2Mat(turn, model.body_iquat[number])
    axes = turn.reshape(3, 3)
    return axes @ np.diag(model.body_inertia[number]) @ axes.T


def test_mujoco_reads_the_same_masses_and_joints() -> None:
    ours = mujoco.MjModel.from_xml_path(str(HUSKY))
    read = read_by_mujoco(ElementTree.fromstring(urdf_of(HUSKY)))
    for body in ('base_link', *(f'{wheel}_link' for wheel in WHEELS)):
        assert read.body(body).mass == pytest.approx(ours.body(body).mass, rel=1e-5)
        assert read.body(body).ipos == pytest.approx(ours.body(body).ipos, abs=1e-5)
        assert inertia(read, body) == pytest.approx(inertia(ours, body), abs=2e-5)
    for wheel in WHEELS:
        joint = read.joint(f'{wheel}_joint')
        assert joint.axis == pytest.approx([0.0, 1.0, 0.0])
        assert read.body(f'{wheel}_link').pos == pytest.approx(ours.body(f'{wheel}_link').pos)


def test_every_shape_stands_where_the_physics_has_it() -> None:
    ours = mujoco.MjModel.from_xml_path(str(HUSKY))
    read = read_by_mujoco(ElementTree.fromstring(urdf_of(HUSKY)))

    def corners(model: mujoco.MjModel, geom: int) -> Array:
        """Return the tips of a geom's three axes, from its middle, in its body."""
        turn, size = np.zeros(9), model.geom_size[geom]
        mujoco.mju_quat2Mat(turn, model.geom_quat[geom])
        long = model.geom_type[geom] != mujoco.mjtGeom.mjGEOM_BOX
        tips = np.diag([size[0], size[0], size[1]] if long else size)
        return model.geom_pos[geom] + tips @ turn.reshape(3, 3).T

    def shapes(model: mujoco.MjModel) -> dict[str, list[Array]]:
        kept: dict[str, list[Array]] = {}
        for geom in range(model.ngeom):
            if model.geom(geom).name.endswith('_tread'):
                continue  # of the physics alone: the same tyre once more
            if model.geom_dataid[geom] < 0 and model.body(model.geom_bodyid[geom]).id:
                name = model.body(model.geom_bodyid[geom]).name
                kept.setdefault(name, []).append(corners(model, geom))
        for places in kept.values():
            places.sort(key=lambda tips: tips.round(4).tolist())
        return kept

    given, found = shapes(ours), shapes(read)
    assert {name: len(each) for name, each in found.items()} == {
        name: len(each) for name, each in given.items()
    }
    for name, each in given.items():
        for here, there in zip(each, found[name], strict=True):
            assert there == pytest.approx(here, abs=1e-4), name


def test_what_is_seen_has_the_colors_of_the_physics(robot: ElementTree.Element) -> None:
    ours = mujoco.MjModel.from_xml_path(str(HUSKY))
    given = Counter(ours.material(each).name for each in ours.geom_matid if each >= 0)
    assert Counter(each.get('name') for each in robot.findall('.//visual/material')) == given
    for each in robot.findall('material'):
        rgba = [float(number) for number in each[0].get('rgba', '').split()]
        assert rgba == pytest.approx(ours.material(each.get('name')).rgba, abs=1e-5)


def test_links_and_joints_are_those_of_tf_and_joint_states(robot: ElementTree.Element) -> None:
    links = {link.get('name') for link in robot.findall('link')}
    assert links == {'base_link', *(f'{wheel}_link' for wheel in WHEELS), *FIXED_FRAMES}
    turning = {
        joint.get('name') for joint in robot.findall('joint') if joint.get('type') == 'continuous'
    }
    assert turning == {f'{wheel}_joint' for wheel in WHEELS}
    children = [child.get('link') for child in robot.iter('child')]
    assert sorted(map(str, children)) == sorted(map(str, links - {'base_link'}))


def test_fixed_frames_look_where_tf_says(robot: ElementTree.Element) -> None:
    for name, frame in FIXED_FRAMES.items():
        (origin,) = robot.findall(f"joint[@name='{name}_joint']/origin")
        roll, pitch, yaw = map(float, origin.get('rpy', '').split())
        quaternion = np.zeros(4)
        mujoco.mju_euler2Quat(quaternion, np.array([roll, pitch, yaw]), 'XYZ')
        same = abs(float(np.dot(quaternion, frame.orientation)))
        assert same == pytest.approx(1.0, abs=1e-6), name
        place = [float(number) for number in origin.get('xyz', '').split()]
        assert place == pytest.approx(frame.position_m, abs=1e-6)


def test_the_shell_is_the_mesh_of_the_physics(robot: ElementTree.Element) -> None:
    (mesh,) = robot.iter('mesh')
    package, file = mesh.get('filename', '').removeprefix('package://').split('/meshes/')
    assert package == 'husky_sim'
    lines = (MESHES / file).read_text().splitlines()
    corners = {tuple(map(float, line.split()[1:])) for line in lines if 'vertex' in line}
    tree = ElementTree.parse(HUSKY)
    (given,) = (each for each in tree.iter('mesh') if each.get('name') == 'husky_shell')
    numbers = list(map(float, given.get('vertex', '').split()))
    assert corners == set(zip(numbers[::3], numbers[1::3], numbers[2::3], strict=True))
    (origin,) = robot.findall('.//geometry/mesh/../../origin')
    moved = [float(number) for key in ('xyz', 'rpy') for number in origin.get(key, '').split()]
    assert moved == pytest.approx([0.0] * 6, abs=1e-5)


def test_a_shape_that_urdf_lacks_is_refused(tmp_path: Path) -> None:
    own = tmp_path / 'husky.xml'
    site = '<site name="imu_link"'
    own.write_text(HUSKY.read_text().replace(site, f'<geom type="ellipsoid" size="1 2 3"/>{site}'))
    with pytest.raises(ValueError, match='URDF has no such shape'):
        urdf_of(own)
