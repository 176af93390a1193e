# Copyright 2026 The Husky Playpen Lab authors
# SPDX-License-Identifier: Apache-2.0
"""The parts of the view that need neither a browser nor ROS."""

from collections.abc import Callable
from dataclasses import replace
import json
import math
import os
from pathlib import Path
import socket

from husky_course.outline import Outline
from husky_course.record import read_record, Record, RecordRefused
from husky_course.robot import RobotStart
from husky_course.route import plan_route, survey_route
from husky_course.waypoints import parse_course
from husky_runtime.web_address import (
    AddressError,
    free_port,
    new_token,
    reserve_port,
    TOKEN_VARIABLE,
)
from husky_sim.recording import loose_bodies, MOVED, RunRecorder
from husky_sim.simulation import Simulation
from husky_sim.world import default_worlds, load_world
from husky_view.editor import course
from husky_view.editor.course import EditableCourse
from husky_view.live.checks import RealTimeFactor
from husky_view.live.teleop import HOLD_TIMEOUT_SEC, STOPS, Teleop
from husky_view.picture.geometry import distance_to_line, on_ground, to_odom, to_world
from husky_view.picture.history import History, MOST_POINTS
from husky_view.picture.meshes import matte_meshes
from husky_view.picture.page import Direction, in_decimals
from husky_view.picture.picture import first_of_run
from husky_view.picture.scene import GROUND, PlaypenScene
from husky_view.picture.shadows import ObstacleShadows, REACH_M, soft_spot
from husky_view.replay.panel import Playback
from husky_view.replay.run import load_run, RunScenes
from mjviser import scene as mjviser_scene
import numpy as np
import pytest
from trimesh.visual import ColorVisuals
import viser

from husky_sim.config import SimulationConfig

START = RobotStart(x=1.0, y=2.0, yaw=math.pi / 2)


def test_the_frame_odom_has_the_pose_of_the_robots_start() -> None:
    points = np.array([[0.0, 0.0], [2.0, 0.0], [0.0, 3.0]])
    world = to_world(START, points)
    np.testing.assert_allclose(world, [[1.0, 2.0], [1.0, 4.0], [-2.0, 2.0]], atol=1e-12)
    np.testing.assert_allclose(to_odom(START, world), points, atol=1e-12)


def test_the_distance_to_a_line_is_positive_on_its_left() -> None:
    line = np.array([[0.0, 0.0], [4.0, 0.0], [4.0, 4.0]])
    assert distance_to_line(np.array([2.0, 0.5]), line) == pytest.approx(0.5)
    assert distance_to_line(np.array([2.0, -0.5]), line) == pytest.approx(-0.5)
    assert distance_to_line(np.array([4.2, 2.0]), line) == pytest.approx(-0.2)
    with pytest.raises(ValueError, match='needs at least 2'):
        distance_to_line(np.zeros(2), line[:1])


def test_a_painted_obstacle_is_not_written_as_metal() -> None:
    world = Simulation(SimulationConfig(world=str(default_worlds() / 'playpen.xml'))).world
    model, barrier = world.model, world.model.body('jersey_barrier_15')
    geoms = list(range(int(barrier.geomadr[0]), int(barrier.geomadr[0] + barrier.geomnum[0])))
    with matte_meshes():
        mesh = mjviser_scene.merge_geoms(model, geoms)
    written = mesh.export(file_type='glb')
    length = int.from_bytes(written[12:16], 'little')
    tree = json.loads(written[20 : 20 + length])
    place = tree['meshes'][0]['primitives'][0]['material']
    assert tree['materials'][place]['pbrMetallicRoughness']['metallicFactor'] == 0.0
    # 0.72 as it is on a screen reflects 0.48 of the light (sRGB, IEC 61966-2-1).
    assert mesh.visual.vertex_colors[0, 0] == pytest.approx(0.477 * 255.0, abs=1.0)


def test_alike_obstacles_are_one_mesh_and_the_ground_another() -> None:
    world = Simulation(SimulationConfig(world=str(default_worlds() / 'playpen.xml'))).world
    server = viser.ViserServer('127.0.0.1', free_port('127.0.0.1', 18200), verbose=False)
    try:
        PlaypenScene(server, world)
        barriers = server.scene.get_handle_by_name('/bodies/jersey_barrier/group0')
        assert isinstance(barriers, viser.BatchedGlbHandle)
        places = barriers.batched_positions[:, :2].astype(float).round(3)
        bodies = [world.model.body(each) for each in range(world.model.nbody)]
        named = [body for body in bodies if body.name.startswith('jersey_barrier')]
        stand = [body.pos[:2].round(3).tolist() for body in named]
        assert sorted(places.tolist()) == sorted(stand)
        ground = server.scene.get_handle_by_name('/fixed_bodies/world/group0')
        assert isinstance(ground, viser.GlbHandle)
        assert ground.receive_shadow is False, 'it would be drawn a second time'
    finally:
        server.stop()


def test_what_has_no_name_is_drawn_as_what_has_one(tmp_path: Path) -> None:
    file = tmp_path / 'world.xml'
    file.write_text(
        '<mujoco><worldbody><geom type="plane" size="9 9 1"/>'
        '<body pos="2 0 0.3"><freejoint/><geom size="0.3"/></body></worldbody></mujoco>'
    )
    world = load_world(str(file), [RobotStart()])
    server = viser.ViserServer('127.0.0.1', free_port('127.0.0.1', 18200), verbose=False)
    try:
        scene = PlaypenScene(server, world)
        qpos = world.model.qpos0.copy()
        qpos[0:2] = 3.0, 1.0
        scene.show(qpos)
        (ball,) = scene.outlines()
        assert (ball.name, ball.x, ball.y) == ('body 1', 3.0, 1.0)
        nodes = server.scene._handle_from_node_name.values()
        (ground,) = [node for node in nodes if isinstance(node, viser.GridHandle) and node.visible]
        assert ground.plane_color == GROUND
    finally:
        server.stop()


def test_a_shadow_stands_under_its_obstacle_and_goes_with_it() -> None:
    cone = Outline(name='cone', x=1.0, y=2.0, yaw=0.0, size=(0.3,))
    other_cone = replace(cone, x=-1.0, size=(0.301,))
    wall = Outline(name='wall', x=4.0, y=0.0, yaw=0.5, size=(4.0, 0.8))
    server = viser.ViserServer('127.0.0.1', free_port('127.0.0.1', 18200), verbose=False)
    try:
        shadows = ObstacleShadows(server, (cone, wall, other_cone), 0.01)
        shadows.show((replace(cone, x=1.5, yaw=math.pi), wall, other_cone))
        names = '/shadows/0', '/shadows/1'
        under_cones, under_wall = map(server.scene.get_handle_by_name, names)
        assert isinstance(under_cones, viser.BatchedGlbHandle)
        assert isinstance(under_wall, viser.BatchedGlbHandle)
        places = [[1.5, 2.0, 0.01], [-1.0, 2.0, 0.01]]
        np.testing.assert_allclose(under_cones.batched_positions, places, atol=1e-6)
        np.testing.assert_allclose(under_cones.batched_wxyzs[:, 3], [1.0, 0.0], atol=1e-6)
        np.testing.assert_allclose(under_wall.batched_positions, [[4.0, 0.0, 0.01]], atol=1e-6)
    finally:
        server.stop()


@pytest.mark.parametrize(('size', 'dark_m2'), [((0.5,), 0.785), ((1.0, 1.0), 1.0)])
def test_a_shadow_is_as_large_as_what_casts_it(size: tuple[float, ...], dark_m2: float) -> None:
    spot = soft_spot(size)
    assert isinstance(spot.visual, ColorVisuals)
    shade = spot.visual.vertex_colors[:, 3]
    farthest = np.abs(spot.vertices).max(axis=0)
    np.testing.assert_allclose(farthest, [0.5 + REACH_M, 0.5 + REACH_M, 0.0], atol=0.01)
    at_border = np.abs(spot.vertices[:, 0]) > 0.49 + REACH_M
    assert shade[at_border].tolist() == [0] * at_border.sum(), 'it ends at its border'
    is_dark = (shade == shade.max())[spot.faces].all(axis=1)
    assert spot.area_faces[is_dark].sum() == pytest.approx(dark_m2, rel=0.02)
    assert (spot.face_normals[spot.area_faces > 0.0, 2] > 0.99).all(), 'it is seen from above'
    soft = ((shade > 0) & (shade < shade.max()))[spot.faces].any(axis=1)
    assert spot.area_faces[soft].sum() > 0.2 * spot.area, 'it is soft'


def test_a_ray_meets_the_ground_only_below_itself() -> None:
    place = on_ground((1.0, 2.0, 3.0), (0.5, 0.0, -1.0), 1.0)
    assert place is not None
    np.testing.assert_allclose(place, [2.0, 2.0])
    assert on_ground((1.0, 2.0, 3.0), (0.0, 0.0, 1.0), 1.0) is None
    assert on_ground((1.0, 2.0, 0.5), (0.0, 0.0, -1.0), 1.0) is None


def test_held_buttons_add_up_and_their_release_stops_the_robot() -> None:
    teleop = Teleop(speed_m_s=0.4, yaw_rate_rad_s=0.9)
    assert teleop.command(now_sec=0.0) is None
    teleop.hold(1, Direction.FORWARD, now_sec=0.0)
    teleop.hold(1, Direction.LEFT, now_sec=0.0)
    assert teleop.command(now_sec=0.1) == (0.4, 0.9)
    teleop.release(1, Direction.LEFT)
    assert teleop.command(now_sec=0.1) == (0.4, 0.0)
    teleop.release(1, Direction.FORWARD)
    assert [teleop.command(now_sec=0.2) for _ in range(STOPS + 1)] == [(0.0, 0.0)] * STOPS + [None]


def test_a_silent_or_closed_tab_releases_only_its_own_buttons() -> None:
    teleop = Teleop(speed_m_s=0.4)
    teleop.hold(1, Direction.FORWARD, now_sec=0.0)
    assert teleop.command(now_sec=HOLD_TIMEOUT_SEC) == (0.4, 0.0)
    assert teleop.command(now_sec=HOLD_TIMEOUT_SEC + 0.01) == (0.0, 0.0)
    teleop.hold(1, Direction.FORWARD, now_sec=1.0)
    teleop.hold(2, Direction.FORWARD, now_sec=1.0)
    teleop.release_tab(1)
    assert teleop.command(now_sec=1.1) == (0.4, 0.0)
    teleop.release_tab(2)
    assert teleop.command(now_sec=1.1) == (0.0, 0.0)


def test_the_factor_is_of_the_last_second_and_of_one_run() -> None:
    factor = RealTimeFactor()
    assert factor.value is None
    for step in range(40):
        factor.add(wall_sec=step * 0.1, time_sec=step * (0.2 if step > 20 else 0.1))
    assert factor.value == pytest.approx(2.0)
    factor.add(wall_sec=4.0, time_sec=0.0)
    assert factor.value is None


def test_a_playback_stops_at_its_end_and_begins_again() -> None:
    playback = Playback(10.0)
    assert playback.step(1.0), 'the first frame draws everything'
    playback.factor = 4.0
    playback.step(2.0)
    assert playback.time_sec == 8.0
    playback.step(2.0)
    assert (playback.time_sec, playback.playing) == (10.0, False)
    playback.play()
    assert (playback.time_sec, playback.playing) == (0.0, True)
    playback.jump(99.0)
    assert playback.time_sec == 10.0
    assert playback.step(1.0)


@pytest.mark.parametrize(
    ('time_sec', 'first'),
    [
        ([5.0, 5.1, 5.2], None),
        ([0.0, 0.1], 0),
        ([5.0, 5.1, 0.0, 0.1], 2),
        ([5.0, 0.0, 0.2, 0.1], 3),
    ],
)
def test_a_run_begins_where_time_goes_back(time_sec: list[float], first: int | None) -> None:
    assert first_of_run(np.array(time_sec), after_sec=4.9) == first


def test_no_figure_is_minus_zero() -> None:
    assert [in_decimals(value, 2) for value in (-0.004, -0.0, -0.006)] == ['0.00', '0.00', '-0.01']
    assert in_decimals(-0.0004, 3, sign='+') == '+0.000'


def test_a_taken_port_is_skipped_and_a_foreign_host_refused() -> None:
    with socket.socket() as taken:
        taken.bind(('127.0.0.1', 0))
        taken.listen()
        port = taken.getsockname()[1]
        assert port < free_port('127.0.0.1', port) < port + 100
    with pytest.raises(AddressError, match=r"host '192\.0\.2\.1'"):
        free_port('192.0.2.1', 8080)
    with pytest.raises(AddressError, match="host 'no such host'"):
        free_port('no such host', 8080)
    for port in (-1, 65536):
        with pytest.raises(AddressError, match=f'port {port}: a port is from 1 to 65535'):
            free_port('127.0.0.1', port)


def test_a_reserved_port_is_for_whom_it_is_reserved(monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.delenv(TOKEN_VARIABLE, raising=False)
    port, reservation = reserve_port('127.0.0.1', 18300)
    other, other_reservation = reserve_port('127.0.0.1', port)
    assert port < other < free_port('127.0.0.1', port)
    monkeypatch.setenv(TOKEN_VARIABLE, 'kept-token')
    assert free_port('127.0.0.1', port) == port
    monkeypatch.delenv(TOKEN_VARIABLE)
    reservation.close()
    other_reservation.close()
    assert free_port('127.0.0.1', port) == port


def test_a_token_of_the_environment_is_kept_or_refused(monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.delenv(TOKEN_VARIABLE, raising=False)
    assert new_token() != new_token()
    monkeypatch.setenv(TOKEN_VARIABLE, 'kept-token')
    assert new_token() == 'kept-token'
    monkeypatch.setenv(TOKEN_VARIABLE, 'a/b')
    with pytest.raises(AddressError, match="HUSKY_VIEW_TOKEN='a/b': letters, digits"):
        new_token()


def record(path: Path) -> Record:
    """Drive for two seconds and write the record."""
    world = str(default_worlds() / 'playpen.xml')
    simulation = Simulation(SimulationConfig(world=world, robots=(RobotStart(yaw=0.5),)))
    with RunRecorder(simulation, path) as recorder:
        for _ in range(100):
            simulation.robots[0].controller.command(0.5, 0.3, time_sec=simulation.time_sec)
            simulation.advance()
            recorder.append()
    return read_record(path)


def test_a_history_of_an_hour_has_few_points_over_all_of_it() -> None:
    history = History()
    for begin in range(3600):
        time_sec = begin + np.linspace(0.0, 0.98, 50, dtype=np.float64)
        history.add(time_sec, time_sec / 3600.0, lambda _: math.nan)
    times = history.points[:, 0]
    assert MOST_POINTS / 2 <= len(times) <= MOST_POINTS
    assert times[0] == 0.0
    assert times[-1] > 3570.0
    assert np.ptp(np.diff(times)) < 0.1, 'evenly spaced'
    np.testing.assert_allclose(history.points[:, 1], times / 3600.0)


def test_a_replay_shows_the_robot_where_the_record_has_it(tmp_path: Path) -> None:
    written = record(tmp_path / 'run.record')
    run = load_run(str(tmp_path))
    assert run.duration_sec == 2.0
    assert run.row_at(0.999) == 49
    world = Simulation(SimulationConfig(world=run.world, robots=run.robots)).world
    scenes = RunScenes(run, world)
    scene = scenes.scene(10, 60, paused=True)
    assert scene.time_sec[-1] == pytest.approx(1.2)
    base = int(world.model.joint('husky/base_joint').qposadr[0])
    x, y, yaw = written.rows[60, 0, 1:4]
    assert scene.qpos[base : base + 2].tolist() == [x, y]
    assert 2.0 * math.atan2(scene.qpos[base + 6], scene.qpos[base + 3]) == pytest.approx(yaw)


def test_a_replay_moves_what_was_pushed_and_a_jump_resets_it(tmp_path: Path) -> None:
    start = RobotStart(x=-2.35, y=-2.6, yaw=-math.pi / 2)
    world = str(default_worlds() / 'playpen.xml')
    simulation = Simulation(SimulationConfig(world=world, robots=(start,)))
    dumpster = loose_bodies(simulation.world)['Dumpster_0']
    recorder = RunRecorder(simulation, tmp_path / 'run.record')
    stood = simulation.data.qpos[dumpster].copy()
    for _ in range(150):
        simulation.robots[0].controller.command(0.5, 0.0, time_sec=simulation.time_sec)
        simulation.advance()
        recorder.append()
    went = simulation.data.qpos[dumpster].copy()
    assert math.dist(went[:2], stood[:2]) > 0.2, 'the dumpster was not pushed'
    recorder.close()
    run = load_run(str(tmp_path))
    assert list(run.pushed) == ['Dumpster_0'], 'what nothing touched takes room'
    scenes = RunScenes(run, simulation.world)
    np.testing.assert_allclose(
        scenes.scene(0, 150, paused=False).qpos[dumpster], went, atol=2.0 * MOVED
    )
    assert scenes.scene(0, 5, paused=False).qpos[dumpster].tolist() == stood.tolist()
    gone = replace(run, pushed={'Gone': run.pushed['Dumpster_0']})
    with pytest.raises(RecordRefused, match=r"'Gone' was pushed, but .* has no such loose body"):
        RunScenes(gone, simulation.world)


def test_a_replay_begins_with_the_first_command(tmp_path: Path) -> None:
    simulation = Simulation(SimulationConfig(world=str(default_worlds() / 'empty.xml')))
    with RunRecorder(simulation, tmp_path / 'run.record') as recorder:
        for period in range(100):
            if period >= 40:
                simulation.robots[0].controller.command(0.5, 0.0, time_sec=simulation.time_sec)
            simulation.advance()
            recorder.append()
    run = load_run(str(tmp_path))
    assert run.time_sec[0] == 0.0
    assert run.duration_sec == pytest.approx(1.2)


def test_a_missing_record_is_refused_with_what_to_give() -> None:
    with pytest.raises(RecordRefused, match='give the record of a run'):
        load_run('/nowhere')


def test_undo_reverts_one_change_and_a_drag_as_a_whole() -> None:
    edited = EditableCourse()
    edited.add(0.0, 0.0)
    edited.add(1.0, 0.0)
    before = edited.course
    edited.begin_move(1)
    for x in (1.2, 1.4, 1.6):
        edited.move(1, x, 0.0)
    assert edited.course.waypoints[1].x_m == 1.6
    edited.undo()
    assert edited.course == before
    edited.undo()
    assert len(edited.course.waypoints) == 1
    assert edited.nearest(0.2, 0.1) == 0
    assert edited.nearest(0.5, 0.0) is None


def test_a_saved_course_is_what_the_driver_reads(tmp_path: Path) -> None:
    from husky_course.waypoints import load_course

    edited = EditableCourse()
    for x, y in ((0.0, 0.0), (1.234, -0.004), (2.5, 1.0)):
        edited.add(x, y)
    edited.set_speed(0.7)
    edited.set_loop(True)
    file = course.save(edited.course, tmp_path, 'mine')
    read = load_course(file)
    assert [(p.x_m, p.y_m) for p in read.waypoints] == [(0.0, 0.0), (1.23, 0.0), (2.5, 1.0)]
    assert (read.speed_m_s, read.loop) == (0.7, True)
    assert course.load(file) == edited.course


def test_opening_a_file_keeps_what_the_editor_does_not_edit(tmp_path: Path) -> None:
    file = tmp_path / 'rich.yaml'
    file.write_text(
        'corners: sharp\ntolerance: 0.4\nwaypoints:\n  - [0, 0]\n'
        '  - {x: 2, y: 0, speed: 0.3, yaw: 1.5, dwell: 2}\n  - {x: 0, y: 0.5, reverse: true}\n'
    )
    edited = EditableCourse()
    edited.load(course.load(file))
    assert course.load(course.save(edited.course, tmp_path, 'again')) == edited.course
    assert '{x: 2.00, y: 0.00, speed: 0.3, yaw: 1.5, dwell: 2}' in course.text_of(edited.course)


def test_the_path_of_a_file_begins_where_the_robot_does(tmp_path: Path) -> None:
    file = tmp_path / 'away.yaml'
    file.write_text('waypoints: [[3, 4], [5, 4]]')
    line, waypoints = course.path_of(file)
    assert line[[0, -1]].tolist() == [[0.0, 0.0], [5.0, 4.0]]
    assert waypoints.tolist() == [[3.0, 4.0], [5.0, 4.0]]
    assert np.hypot(*np.diff(line, axis=0).T).sum() == pytest.approx(7.0, abs=0.01)


@pytest.mark.timeout(30)
@pytest.mark.parametrize('read', [course.load, course.path_of])
def test_what_the_driver_cannot_read_is_refused(
    tmp_path: Path, read: Callable[[Path], object]
) -> None:
    file = tmp_path / 'given.yaml'
    file.write_bytes('waypoints: [[0, 0], [1, 0]]'.encode('utf-16'))
    with pytest.raises(course.CourseRefused, match='save the file as UTF-8'):
        read(file)
    file.unlink()
    os.mkfifo(file)
    with pytest.raises(course.CourseRefused, match='not a file'):
        read(file)


def test_what_cannot_be_saved_leaves_nothing_behind(tmp_path: Path) -> None:
    edited = EditableCourse()
    edited.add(1.0, 2.0)
    edited.add(2.0, 2.0)
    (tmp_path / 'mine.yaml').mkdir()
    with pytest.raises(course.CourseRefused, match=r'mine\.yaml: Is a directory'):
        course.save(edited.course, tmp_path, 'mine')
    assert [path.name for path in tmp_path.iterdir()] == ['mine.yaml']


@pytest.mark.parametrize('name', ['', '../evil', 'a/b', '.hidden', 'x' * 70, 'ä'])
def test_a_name_outside_of_the_folder_is_not_saved(tmp_path: Path, name: str) -> None:
    edited = EditableCourse()
    edited.add(0.0, 0.0)
    edited.add(1.0, 0.0)
    with pytest.raises(course.CourseRefused, match='letters, digits'):
        course.save(edited.course, tmp_path, name)
    assert list(tmp_path.iterdir()) == []


def test_the_preview_has_no_clearance_inside_the_barrier() -> None:
    simulation = Simulation(SimulationConfig(world=str(default_worlds() / 'playpen.xml')))
    edited = EditableCourse()
    edited.add(0.0, 0.0)
    edited.add(5.0, 0.0)
    seen = course.preview(edited.course, RobotStart(), simulation.world.obstacles)
    assert seen.clearance_m[0] > 0.5
    assert seen.clearance_m.min() == 0.0
    assert seen.nearest == 'jersey_barrier_15'
    assert json.dumps(seen.line[-1].tolist()) == '[5.0, 0.0]'


def test_the_preview_has_the_way_to_the_first_waypoint_and_turns() -> None:
    simulation = Simulation(SimulationConfig(world=str(default_worlds() / 'playpen.xml')))
    behind = parse_course('waypoints: [[4.5, 1.5], [6.0, 2.0]]')
    seen = course.preview(behind, RobotStart(), simulation.world.obstacles)
    assert seen.line[0].tolist() == [0.0, 0.0]
    assert (seen.clearance_m.min(), seen.nearest) == (0.0, 'jersey_barrier_15')
    for text in ('[[0, 0], [0, -1]]', '[[0, 0], {x: -1.0, y: 0, reverse: true, yaw: 2.0}]'):
        turning = parse_course(f'waypoints: {text}')
        seen = course.preview(turning, RobotStart(), simulation.world.obstacles)
        survey = survey_route(plan_route(turning), simulation.world.obstacles)
        assert seen.clearance_m.min() == survey.least_m
        assert (np.abs(np.diff(seen.line, axis=0)).max(axis=1) > 0.0).all()
