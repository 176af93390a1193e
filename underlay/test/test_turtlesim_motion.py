# Copyright 2026 The Husky Playpen Lab authors
# SPDX-License-Identifier: Apache-2.0
"""How turtles move and draw, without ROS, beside other ways to work the same out."""

from __future__ import annotations

import base64
import cmath
import math

from hypothesis import given, settings
from hypothesis import strategies as st
import numpy as np
import numpy.typing as npt
import pytest
from turtlesim.msg import Pose
from turtlesim_programs.canvas import Canvas, NOTHING, to_pixels
from turtlesim_programs.draw_square import Square
from turtlesim_programs.frame import MIDDLE, TurtleError, TurtleFrame
from turtlesim_programs.motion import Line, Pen, PERIOD_SEC, PIXELS, SIDE_M, Teleport, Turtle
from turtlesim_programs.page import encode_changes

RED = Pen((255, 0, 0), 3)
WHITE = (255, 255, 255)
places = st.floats(0.0, SIDE_M)
points = st.tuples(places, places)


def moved(turtle: Turtle, steps: int, start: int = 0) -> Turtle:
    for number in range(start, start + steps):
        turtle.step(number * PERIOD_SEC)
    return turtle


def arc(velocity: complex, turn: float, theta: float, steps: int) -> complex:
    """Return how far a turtle comes: the sum of a geometric series of its steps."""
    step = cmath.exp(1j * turn * PERIOD_SEC)
    turned = cmath.exp(1j * theta) * step
    count = (1 - step**steps) / (1 - step) if turn else steps
    return velocity * PERIOD_SEC * turned * count


@given(
    st.complex_numbers(max_magnitude=2.0),
    st.floats(-3.0, 3.0).filter(lambda turn: turn == 0 or abs(turn) > 1e-3),
    st.floats(-3.0, 3.0),
)
def test_a_way_is_the_sum_of_a_series(velocity: complex, turn: float, theta: float) -> None:
    turtle = Turtle(MIDDLE, MIDDLE, theta)
    turtle.command((velocity.real, velocity.imag), turn, 0.0)
    moved(turtle, 60)
    there = complex(MIDDLE, MIDDLE) + arc(velocity, turn, theta, 60)
    assert complex(turtle.x, turtle.y) == pytest.approx(there, abs=1e-9)
    assert math.cos(turtle.theta) == pytest.approx(math.cos(theta + 60 * turn * PERIOD_SEC))
    assert -math.pi <= turtle.theta < math.pi


def test_a_command_counts_for_a_second() -> None:
    turtle = Turtle(0.0, MIDDLE, 0.0)
    turtle.command((1.0, 0.0), 0.0, 0.0)
    moved(turtle, 100)
    steps = math.floor(1.0 / PERIOD_SEC) + 1  # the first one is at the time of the command
    assert turtle.x == pytest.approx(steps * PERIOD_SEC)
    assert turtle.speed == 0.0


@pytest.mark.parametrize(
    ('theta', 'held'),
    [(0.0, 'x'), (math.pi, 'x'), (math.pi / 2, 'y'), (-math.pi / 2, 'y')],
)
def test_a_wall_holds_a_turtle_and_says_so(theta: float, held: str) -> None:
    turtle = Turtle(MIDDLE, MIDDLE, theta)
    turtle.command((20.0, 0.0), 0.0, 0.0)
    steps = [turtle.step(number * PERIOD_SEC) for number in range(60)]
    assert getattr(turtle, held) in (0.0, SIDE_M)
    assert steps[-1].outside is not None
    assert steps[0].outside is None
    assert not steps[-1].moved


@pytest.mark.parametrize(
    ('start', 'theta', 'turn'),
    [(0.0, 1.57, 1.0), (0.0, -1.57, -1.0), (3.0, -3.0, 1.0), (-3.0, 3.0, -1.0), (0.0, 8.0, 1.0)],
)
def test_a_rotation_goes_the_short_way_and_ends_in_reach(
    start: float, theta: float, turn: float
) -> None:
    turtle = Turtle(MIDDLE, MIDDLE, start)
    rotation = turtle.rotate_to(theta)
    turtle.step(0.0)
    assert turtle.angular == turn
    remaining = abs(rotation.remaining)
    # Until fewer than 0.02 rad are left, in steps of 0.016 rad; the last step finds that it is so.
    steps = math.ceil((remaining - 0.02) / PERIOD_SEC) + 1
    for number in range(1, steps):
        assert not rotation.reached, number
        turtle.step(number * PERIOD_SEC)
    assert rotation.reached
    assert abs(rotation.remaining) < 0.02
    assert turtle.angular == 0.0
    assert rotation.delta == pytest.approx(-turn * (steps - 1) * PERIOD_SEC, abs=1e-6)


def test_teleports_are_done_in_order_and_drawn() -> None:
    turtle = Turtle(MIDDLE, MIDDLE, 0.0, pen=RED)
    turtle.teleport(Teleport(math.pi / 2, place=(1.0, 2.0)))
    turtle.teleport(Teleport(-math.pi / 2, ahead=3.0, relative=True))
    step = turtle.step(0.0)
    assert (turtle.x, turtle.y, turtle.theta) == pytest.approx((4.0, 2.0, 0.0))
    assert [line.end for line in step.jumps] == [(1.0, 2.0), (4.0, pytest.approx(2.0))]
    assert step.way is None
    assert step.moved


def test_a_turtle_that_is_put_outside_comes_back_by_a_step() -> None:
    turtle = Turtle(50.0, -3.0, 0.0)
    assert turtle.step(0.0).outside == (50.0, -3.0)
    assert (turtle.x, turtle.y) == (SIDE_M, 0.0)


@pytest.mark.parametrize('width', [1, 3, 255])
@pytest.mark.parametrize('value', [1e30, -1e30])
def test_the_fastest_command_neither_fails_nor_leaves_the_picture(
    value: float, width: int
) -> None:
    frame = TurtleFrame()
    turtle = frame.turtles[frame.spawn('', MIDDLE, MIDDLE, 0.0)]
    turtle.pen = Pen(width=width)
    turtle.command((value, value), value, 0.0)
    turtle.teleport(Teleport(1e38, ahead=3e38, relative=True))
    for number in range(3):
        frame.step(number * PERIOD_SEC)
    assert {turtle.x, turtle.y} <= {0.0, SIDE_M}
    assert -math.pi <= turtle.theta <= math.pi


def inside(start: complex, end: complex, width: int) -> npt.NDArray[np.bool_]:
    """Return which pixels a wide line covers, each turned into the line's own direction."""
    covered = np.zeros((PIXELS, PIXELS), bool)
    way = (end - start) / abs(end - start)
    for row in range(PIXELS):
        for column in range(PIXELS):
            place = (complex(column, row) - start) / way
            covered[row, column] = (
                -width / 2 <= place.real <= abs(end - start) + width / 2
                and abs(place.imag) <= width / 2
            )
    return covered


@pytest.mark.parametrize('width', [2, 3, 20])
def test_a_wide_line_covers_its_rectangle(width: int) -> None:
    line = Line((1.03, 2.0), (8.0, 10.9), Pen((1, 2, 3), width))
    canvas = Canvas()
    canvas.draw(line)
    covered = inside(complex(*to_pixels(line.start)), complex(*to_pixels(line.end)), width)
    assert ((canvas.pixels != NOTHING) == covered).all()
    assert set(np.unique(canvas.pixels)) == {NOTHING, 0xFF010203}


@pytest.mark.parametrize('width', [1, 2, 3, 4, 7])
@pytest.mark.parametrize('middle', [MIDDLE, MIDDLE + 0.3 / 45, 5.0])
def test_a_straight_line_is_as_wide_as_its_pen(width: int, middle: float) -> None:
    for start, end in (((2.0, middle), (9.0, middle)), ((middle, 2.0), (middle, 9.0))):
        canvas = Canvas()
        canvas.draw(Line(start, end, Pen(width=width)))
        drawn = canvas.pixels != NOTHING
        assert {int(count) for count in (*drawn.sum(0), *drawn.sum(1)) if 0 < count < 50} == {
            width
        }


@given(points, points, st.integers(1, 12))
def test_ends_of_a_line_have_its_colour(
    start: tuple[float, float], end: tuple[float, float], width: int
) -> None:
    canvas = Canvas()
    canvas.draw(Line(start, end, Pen((9, 8, 7), width)))
    assert canvas.colour_at(start) == canvas.colour_at(end) == (9, 8, 7)


@given(points, points, st.integers(1, 12))
def test_a_line_drawn_back_is_the_same(
    start: tuple[float, float], end: tuple[float, float], width: int
) -> None:
    there, back = Canvas(), Canvas()
    there.draw(Line(start, end, Pen(width=width)))
    back.draw(Line(end, start, Pen(width=width)))
    assert (there.pixels == back.pixels).all()


@given(points, st.floats(-3.0, 3.0), st.floats(-4.0, 4.0))
@settings(max_examples=30)
def test_a_turtle_that_goes_back_sees_what_it_drew(
    start: tuple[float, float], theta: float, turn: float
) -> None:
    frame = TurtleFrame()
    name = frame.spawn('', *start, theta)
    turtle = frame.turtles[name]
    turtle.pen = Pen((10, 20, 30), 1)
    turtle.command((1.0, 0.0), turn, 0.0)
    places = []
    for number in range(40):
        frame.step(number * PERIOD_SEC)
        places.append((turtle.x, turtle.y))
    turtle.pen = None
    for place in places if len(set(places)) > 1 else ():
        turtle.stop()
        turtle.teleport(Teleport(0.0, place=place))
        assert frame.step(1.0)[name].colour == (10, 20, 30)


def test_nothing_drawn_is_white_and_clearing_makes_it_so() -> None:
    frame = TurtleFrame()
    turtle = frame.turtles[frame.spawn('', MIDDLE, MIDDLE, 0.0)]
    assert frame.step(0.0)['turtle1'].colour == WHITE
    turtle.command((1.0, 0.0), 0.0, 0.0)
    frame.step(0.0)
    assert frame.step(0.0)['turtle1'].colour == Pen().colour
    turtle.stop()
    frame.canvas.clear()
    assert frame.step(0.0)['turtle1'].colour == WHITE


def test_names_are_the_next_free_ones() -> None:
    frame = TurtleFrame()
    frame.spawn('turtle2', 1.0, 1.0, 0.0)
    assert [frame.spawn('', 1.0, 1.0, 0.0) for _ in range(3)] == ['turtle1', 'turtle3', 'turtle4']
    frame.kill('turtle3')
    assert frame.spawn('', 1.0, 1.0, 0.0) == 'turtle5'
    with pytest.raises(TurtleError, match=r'^A turtle named \[turtle2\] already exists$'):
        frame.spawn('turtle2', 1.0, 1.0, 0.0)
    with pytest.raises(TurtleError, match=r'Tried to kill turtle \[none\], which does not exist'):
        frame.kill('none')
    frame.reset()
    assert frame.spawn('', 1.0, 1.0, 0.0) == 'turtle1'


def test_a_page_is_sent_all_that_has_changed() -> None:
    canvas = Canvas()
    blank = canvas.pixels.copy()
    assert encode_changes(blank, canvas.pixels) == ''
    canvas.draw(Line((1.0, 1.0), (7.0, 9.0), RED))
    words = np.frombuffer(base64.b64decode(encode_changes(blank, canvas.pixels)), '<u4')
    places, values = np.split(words, 2)
    blank.ravel()[places] = values
    assert (blank == canvas.pixels).all()
    assert set(values) == {0xFFFF0000}


def test_draw_square_comes_back_to_where_it_began() -> None:
    turtle = Turtle(MIDDLE, MIDDLE, 0.0)
    said: list[str] = []
    square = Square(said.append)
    for number in range(2000):
        pose = Pose(x=turtle.x, y=turtle.y, theta=turtle.theta)
        pose.linear_velocity, pose.angular_velocity = turtle.speed, turtle.angular
        if command := square.command(pose):
            turtle.command((command.forward_m_s, 0.0), command.turn_rad_s, number * PERIOD_SEC)
        turtle.step(number * PERIOD_SEC)
        if said.count('Reached goal') == 8:
            break
    assert (turtle.x, turtle.y) == pytest.approx((MIDDLE, MIDDLE), abs=0.2)
    assert turtle.theta == pytest.approx(0.0, abs=0.05)
    goals = [line for line in said if line.startswith('New goal')]
    assert goals[0] == 'New goal [7.544445 5.544445, 0.000000]'
    assert len(goals) == 9
