# Copyright 2026 The Husky Playpen Lab authors
# SPDX-License-Identifier: Apache-2.0
"""Plan outlines, and the distance of the robot's rectangle to them."""

import math

from husky_course.frames import Array
from husky_course.outline import clearances, least_clearance, Outline
from husky_course.robot import ROBOT_LENGTH_M, ROBOT_WIDTH_M
from husky_sim.world.silhouette import outline_of, outlines_of
from hypothesis import given
from hypothesis import strategies as st
import mujoco
import numpy as np
import pytest

HALF_LENGTH, HALF_WIDTH = ROBOT_LENGTH_M / 2.0, ROBOT_WIDTH_M / 2.0


def measured(geoms: str, *, at: str = 'pos="1 2 0"') -> Outline:
    xml = f'<mujoco><worldbody><body {at}>{geoms}</body></worldbody></mujoco>'
    model = mujoco.MjModel.from_xml_string(xml)
    data = mujoco.MjData(model)
    mujoco.mj_forward(model, data)
    return outline_of('it', model, data, range(model.ngeom), body=1)


@pytest.mark.parametrize(
    ('geoms', 'size'),
    [
        ('<geom type="sphere" size="0.4"/>', (0.4,)),
        ('<geom type="cylinder" size="0.3 1"/>', (0.3,)),
        ('<geom type="ellipsoid" size="0.3 0.3 2"/>', (0.3,)),
        ('<geom type="capsule" size="0.2 0.5"/>', (0.2,)),
        ('<geom type="capsule" size="0.2 0.5" euler="90 0 0"/>', (0.4, 1.4)),
        ('<geom type="cylinder" size="0.2 0.5" euler="0 90 0"/>', (1.0, 0.4)),
        ('<geom type="box" size="1 0.5 2"/>', (2.0, 1.0)),
        ('<geom type="box" size="0.5 0.5 1"/>', (1.0, 1.0)),
        ('<geom type="box" size="1 1 1"/><geom size="0.1" pos="2 0 0"/>', (3.1, 2.0)),
    ],
)
def test_the_outline_of_a_shape(geoms: str, size: tuple[float, ...]) -> None:
    assert measured(geoms).size == pytest.approx(size)


@pytest.mark.parametrize(('parts', 'outlines'), [(5000, 5000), (5001, 1)])
def test_an_obstacle_has_no_more_outlines_than_a_record_holds(parts: int, outlines: int) -> None:
    geoms = ''.join(f'<geom size="0.1" pos="{k} 0 0"/>' for k in range(parts))
    model = mujoco.MjModel.from_xml_string(f'<mujoco><worldbody>{geoms}</worldbody></mujoco>')
    data = mujoco.MjData(model)
    mujoco.mj_forward(model, data)
    found = outlines_of('it', model, data, range(model.ngeom), body=0)
    assert len(found) == outlines


def test_the_outline_turns_with_the_body() -> None:
    outline = measured('<geom type="box" size="1 0.5 2"/>', at='pos="1 2 0" euler="0 0 30"')
    assert outline.size == pytest.approx((2.0, 1.0))
    assert outline.yaw == pytest.approx(math.pi / 6.0)
    assert (outline.x, outline.y) == pytest.approx((1.0, 2.0))


def test_an_outline_is_about_the_middle_of_what_stands_there() -> None:
    box = '<geom type="box" size="1 0.5 2" pos="3 1 0"/>'
    outline = measured(box, at='pos="1 2 0" euler="0 0 90"')
    assert outline.size == pytest.approx((2.0, 1.0))
    assert (outline.x, outline.y) == pytest.approx((0.0, 5.0))


def test_a_lying_body_is_seen_as_it_lies() -> None:
    outline = measured('<geom type="box" size="1 0.5 2"/>', at='euler="0 90 0"')
    assert sorted(outline.size) == pytest.approx([1.0, 4.0])


def near(x: float, y: float, yaw: float, outline: Outline) -> float:
    return float(clearances(np.array([[x, y, yaw]]), [outline])[0])


WALL = Outline(name='wall', x=3.0, y=0.0, yaw=0.0, size=(1.0, 20.0))
POST = Outline(name='post', x=3.0, y=0.0, yaw=0.0, size=(0.5,))


def test_distances_to_a_wall_and_a_post_ahead() -> None:
    assert near(0.0, 0.0, 0.0, WALL) == pytest.approx(2.5 - HALF_LENGTH)
    assert near(0.0, 0.0, math.pi / 2.0, WALL) == pytest.approx(2.5 - HALF_WIDTH)
    assert near(0.0, 0.0, 0.0, POST) == pytest.approx(2.5 - HALF_LENGTH)


def test_clearance_is_zero_where_outlines_overlap() -> None:
    bar = Outline(name='bar', x=0.0, y=0.0, yaw=0.0, size=(0.1, 5.0))
    assert near(0.0, 0.0, 0.0, bar) == 0.0
    assert near(2.8, 0.0, 0.0, POST) == 0.0


def test_the_nearest_outline_counts_at_every_pose() -> None:
    poses = np.array([[0.0, 0.0, 0.0], [1.0, 0.0, 0.0]])
    far = Outline(name='far', x=-50.0, y=0.0, yaw=0.0, size=(1.0,))
    assert clearances(poses, [far, WALL]) == pytest.approx([2.5 - HALF_LENGTH, 1.5 - HALF_LENGTH])


@given(
    x=st.floats(-5.0, 5.0),
    y=st.floats(-5.0, 5.0),
    yaw=st.floats(-4.0, 4.0),
    turned=st.floats(-4.0, 4.0),
)
def test_it_is_the_distance_of_the_nearest_points(
    x: float, y: float, yaw: float, turned: float
) -> None:
    outline = Outline(name='it', x=0.5, y=-0.3, yaw=turned, size=(1.5, 0.6))
    edge = np.linspace(-1.0, 1.0, 41)
    rim = np.concatenate(
        [np.stack([edge, np.full(41, side)], axis=1) for side in (-1.0, 1.0)]
        + [np.stack([np.full(41, side), edge], axis=1) for side in (-1.0, 1.0)]
    )

    def placed(half: tuple[float, float], px: float, py: float, angle: float) -> Array:
        cos, sin = math.cos(angle), math.sin(angle)
        return rim * half @ np.array([[cos, sin], [-sin, cos]]) + (px, py)

    ours = placed((HALF_LENGTH, HALF_WIDTH), x, y, yaw)
    theirs = placed((0.75, 0.3), 0.5, -0.3, turned)
    sampled = np.linalg.norm(ours[:, None] - theirs[None], axis=2).min()
    assert near(x, y, yaw, outline) <= sampled + 1e-9
    if near(x, y, yaw, outline) > 0.0:
        assert near(x, y, yaw, outline) >= sampled - 0.05


@given(st.integers(0, 2**32 - 1))
def test_the_least_clearance_is_the_least_of_all(seed: int) -> None:
    random = np.random.default_rng(seed)
    outlines = [
        Outline(name='o', x=x, y=y, yaw=yaw, size=(0.4,) if round_ else (1.5, 0.3))
        for x, y, yaw, round_ in zip(*random.uniform(-9, 9, (3, 5)), (1, 0, 1, 0, 1), strict=True)
    ]
    poses = random.uniform(-9, 9, (200, 3))
    assert least_clearance(poses, outlines) == clearances(poses, outlines).min()
