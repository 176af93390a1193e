# Copyright 2026 The Husky Playpen Lab authors
# SPDX-License-Identifier: Apache-2.0
"""Each sensor against the physics it measures."""

from collections.abc import Callable, Iterator
import math
from pathlib import Path
import sys
from types import ModuleType

from builtin_interfaces.msg import Time
from husky_course.frames import Array
from husky_course.robot import RobotStart
from husky_sim.errors import SettingError
from husky_sim.ros.sensor_topics import new_camera_info, new_image
from husky_sim.sensors import lidar, navsat
from husky_sim.sensors.camera import Camera
from husky_sim.sensors.imu import disturbed, new_noise
from husky_sim.sensors.sensors import Rate
from husky_sim.simulation import Simulation
from husky_sim.world import FIXED_FRAMES
import mujoco
import numpy as np
import pytest

from husky_sim.config import SensorConfig, SimulationConfig

OnAsphalt = Callable[..., Simulation]
Drive = Callable[..., None]
WORLDS = Path(__file__).resolve().parents[3] / 'worlds'


def simulate(world: str = 'empty.xml', *, yaw: float = 0.0, **sensors: object) -> Simulation:
    return Simulation(
        SimulationConfig(
            world=str(WORLDS / world),
            robots=(RobotStart(yaw=yaw),),
            sensors=SensorConfig(**sensors),  # type: ignore[arg-type]
        )
    )


@pytest.mark.parametrize('rate_hz', [50.0, 40.0, 10.0, 1.0, 30.0])
def test_a_sensor_measures_as_often_as_its_rate_says(rate_hz: float) -> None:
    rate = Rate(rate_hz)
    due = [periods for periods in range(1, 501) if rate.is_due(periods)]
    assert len(due) == pytest.approx(rate_hz * 10.0, abs=1)
    gaps = np.diff(due) * 0.02
    assert gaps.max() - gaps.min() <= 0.0201


def test_a_rate_of_zero_is_off() -> None:
    assert not any(Rate(0.0).is_due(periods) for periods in range(1, 501))


def test_the_imu_at_rest_feels_gravity_and_nothing_else(drive: Drive) -> None:
    simulation = simulate()
    drive(simulation, 0.0, 0.0, seconds=1.0)
    imu = simulation.robots[0].imu
    assert imu.acceleration == pytest.approx((0.0, 0.0, 9.8), abs=1e-3)
    assert imu.angular_velocity == pytest.approx((0.0, 0.0, 0.0), abs=1e-4)


def test_the_imu_at_rest_feels_all_of_a_gravity_that_is_not_down(
    tmp_path: Path, drive: Drive
) -> None:
    path = tmp_path / 'slope.xml'
    text = (WORLDS / 'empty.xml').read_text(encoding='utf-8')
    assert 'gravity="0 0 -9.8"' in text
    path.write_text(text.replace('gravity="0 0 -9.8"', 'gravity="1 3 -9"'), encoding='utf-8')
    simulation = simulate(str(path), yaw=math.pi / 2.0)
    drive(simulation, 0.0, 0.0, seconds=2.0)
    imu = simulation.robots[0].imu
    assert imu.acceleration == pytest.approx((-3.0, 1.0, 9.0), abs=0.1)
    # Its orientation tells the slope, so that a driver can tell gravity from a push.
    w, x, y, z = imu.orientation
    up = (2.0 * (x * z - w * y), 2.0 * (y * z + w * x), 1.0 - 2.0 * (x * x + y * y))
    assert math.hypot(*imu.acceleration) * np.array(up) == pytest.approx(
        imu.acceleration, abs=0.01
    )
    state = simulation.robots[0].state._replace(orientation=imu.orientation)
    assert state.yaw == pytest.approx(imu.yaw)


def test_the_imu_measures_acceleration_in_line_and_in_circles(drive: Drive) -> None:
    simulation = simulate()
    drive(simulation, 1.0, 0.0, seconds=0.2)
    assert simulation.robots[0].imu.acceleration[0] == pytest.approx(3.0, rel=0.15)
    drive(simulation, 1.0, 0.5, seconds=3.0)
    robot = simulation.robots[0]
    rate = robot.state.angular_velocity[2]
    assert robot.imu.acceleration[1] == pytest.approx(robot.state.velocity[0] * rate, rel=0.1)
    assert robot.imu.angular_velocity[2] == rate


def test_the_imu_gives_the_true_orientation(drive: Drive) -> None:
    simulation = simulate(yaw=1.0)
    drive(simulation, 0.0, 1.0, seconds=1.0)
    robot = simulation.robots[0]
    assert robot.imu.orientation == robot.state.orientation
    assert robot.imu.yaw == robot.state.yaw


def test_noise_has_the_deviation_of_the_original(drive: Drive) -> None:
    simulation = simulate(noise=True, seed=3, yaw=2.0)
    values = []
    for _ in range(1000):
        drive(simulation, 0.0, 0.0, seconds=0.02)
        imu = simulation.robots[0].imu
        w, x, y, z = imu.orientation
        yaw = math.atan2(2.0 * (w * z + x * y), 1.0 - 2.0 * (y * y + z * z))
        assert yaw == pytest.approx(imu.yaw, abs=1e-9), 'the orientation has another error'
        assert math.hypot(w, x, y, z) == pytest.approx(1.0)
        values.append((*imu.angular_velocity, *imu.acceleration, imu.yaw))
    assert np.std(values, axis=0) == pytest.approx([0.005] * 7, rel=0.1)
    assert np.mean(values, axis=0) == pytest.approx([0, 0, 0, 0, 0, 9.8, 2.0], abs=0.02)
    inclined = imu._replace(orientation=(0.8, 0.48, 0.36, 0.0))
    _, x, y, _ = disturbed(inclined, new_noise([3, 0]), 0.02).orientation
    assert x * x + y * y == pytest.approx(0.36), 'the error is one of the heading alone'


def test_the_noise_depends_on_the_seed_alone(drive: Drive) -> None:
    def rates(seed: int) -> list[float]:
        simulation = simulate(noise=True, seed=seed)
        found = []
        for _ in range(20):
            drive(simulation, 0.3, 0.1, seconds=0.02)
            found.append(simulation.robots[0].imu.angular_velocity[2])
        simulation.reset()
        for value in found:
            drive(simulation, 0.3, 0.1, seconds=0.02)
            assert simulation.robots[0].imu.angular_velocity[2] == value, 'after a reset'
        return found

    assert rates(1) == rates(1)
    assert rates(1) != rates(2)


BOX = '<body name="box" pos="3 0 0.5"><geom type="box" size="0.5 20 1"/></body>'


def test_the_scanner_measures_walls_in_every_direction(
    make_world: Callable[..., str], drive: Drive
) -> None:
    simulation = Simulation(
        SimulationConfig(world=make_world(BOX), sensors=SensorConfig(lidar_rate_hz=10.0))
    )
    drive(simulation, 0.0, 0.0, seconds=0.1)
    scan = simulation.robots[0].sensors.scan
    assert scan is not None
    angles = -lidar.HALF_ANGLE_RAD + lidar.ANGLE_INCREMENT_RAD * np.arange(lidar.BEAMS)
    distance = 2.5 - lidar.PLACE[0]
    ahead = np.abs(angles) < 1.3
    assert FIXED_FRAMES['front_laser'].position_m == lidar.PLACE, 'as tf has it'
    assert scan[ahead] == pytest.approx(distance / np.cos(angles[ahead]), abs=0.005)
    assert np.isinf(scan[np.abs(angles) > 1.6]).all()
    assert angles[-1] == pytest.approx(2.35619)


def test_the_scanner_turns_with_the_robot_and_does_not_see_it(drive: Drive) -> None:
    simulation = simulate('playpen.xml', yaw=math.pi / 4.0, lidar_rate_hz=50.0)
    drive(simulation, 0.0, 0.0, seconds=0.02)
    scan = simulation.robots[0].sensors.scan
    assert scan is not None
    # Across the barrier's face, 1.576 m from the origin to its upright.
    assert scan[lidar.BEAMS // 2] == pytest.approx(1.576 - lidar.PLACE[0], abs=0.05)
    assert scan.min() > 1.0


THINGS = """
    <geom type="sphere" size="0.3" pos="2.5 0 0.6"/>
    <geom type="capsule" size="0.1 0.6" pos="2 2 0.2" euler="70 20 0"/>
    <geom type="ellipsoid" size="0.5 0.2 0.3" pos="-1 2 0.1" euler="0 40 0"/>
    <geom type="cylinder" size="0.2 0.4" pos="1 -2 0.9"/>
    <geom type="box" size="0.2 0.2 0.1" pos="2 -1 1.5"/>
    <geom type="mesh" mesh="tent" pos="0 -2 0.3"/>
    <geom type="hfield" hfield="hill" pos="6 0 0"/>
    <geom name="ramp_plane" type="plane" size="30 30 1" pos="0 0 -0.2" euler="0 -3 0"/>
    <body name="crate" pos="2.2 1 0.2"><freejoint/><geom type="box" size="0.2 0.2 0.2"/></body>
  </worldbody>
  <asset>
    <mesh name="tent" vertex="0 0 0  1 0 0  0 1 0  0 0 0.4"/>
    <hfield name="hill" nrow="3" ncol="3" size="2 2 1 0.1" elevation="0 0 0 0 1 0 0 0 0"/>
  </asset>
  <worldbody>
"""


@pytest.mark.parametrize('turn', [(1.0, 0.0, 0.0), (0.98, 0.1, 0.1), (0.9, -0.3, 0.2)])
def test_a_scan_is_the_same_as_with_every_geom(
    make_world: Callable[..., str], turn: tuple[float, float, float]
) -> None:
    simulation = Simulation(
        SimulationConfig(world=make_world(THINGS), sensors=SensorConfig(lidar_rate_hz=10.0))
    )
    model, data = simulation.model, simulation.data
    mujoco.mj_forward(model, data)
    scanner = lidar.Lidar('husky', simulation.ray_scene(), None)
    groups = model.geom_group.copy()
    state = simulation.robots[0].state._replace(orientation=(*turn, 0.1))
    seen = scanner.scan(state, 0.1)
    place, matrix = np.array(state.position), np.zeros(9)
    mujoco.mju_quat2Mat(matrix, np.array(state.orientation))
    axes = matrix.reshape(3, 3)
    place += axes @ np.array(lidar.PLACE)
    angles = -lidar.HALF_ANGLE_RAD + lidar.ANGLE_INCREMENT_RAD * np.arange(lidar.BEAMS)
    base, hit = model.body('husky/base_link').id, np.zeros(1, dtype=np.int32)
    for angle, measured in zip(angles, seen, strict=True):
        beam = axes @ np.array([math.cos(angle), math.sin(angle), 0.0])
        range_m = mujoco.mj_ray(model, data, place, beam, None, True, base, hit)
        if not 0.0 <= range_m <= lidar.RANGE_MAX_M:
            range_m = math.inf
        elif range_m < lidar.RANGE_MIN_M:
            range_m = -math.inf
        assert measured == pytest.approx(range_m, rel=1e-6)
    assert (np.isfinite(seen)).sum() > 50
    assert (model.geom_group == groups).all()


def cast_at_every_geom(simulation: Simulation) -> Array:
    """Return what a scan of the first robot says, by one call of MuJoCo on the world itself."""
    model, state = simulation.model, simulation.robots[0].state
    matrix = np.zeros(9)
    mujoco.mju_quat2Mat(matrix, np.array(state.orientation))
    turn = matrix.reshape(3, 3)
    origin = np.array(state.position) + turn @ np.array(lidar.PLACE)
    angles = -lidar.HALF_ANGLE_RAD + lidar.ANGLE_INCREMENT_RAD * np.arange(lidar.BEAMS)
    beams = np.stack([np.cos(angles), np.sin(angles), np.zeros(lidar.BEAMS)], axis=1) @ turn.T
    base, hits = model.body('husky/base_link').id, np.zeros(lidar.BEAMS, dtype=np.int32)
    ranges = np.zeros(lidar.BEAMS)
    mujoco.mj_multiRay(
        *(model, simulation.data, origin, beams.ravel(), None, True, base, hits, ranges, None),
        *(lidar.BEAMS, lidar.RANGE_MAX_M),
    )
    ranges[ranges < lidar.RANGE_MIN_M] = -math.inf
    ranges[(hits < 0) | (ranges > lidar.RANGE_MAX_M)] = math.inf
    return ranges.astype(np.float32)


def put_everything_ahead(simulation: Simulation, yaw: float) -> Iterator[str]:
    """Put the first robot's surroundings 2 m before it, one after the other."""
    model, data = simulation.model, simulation.data
    own = model.joint('husky/base_joint').id
    for joint in np.flatnonzero(model.jnt_type == mujoco.mjtJoint.mjJNT_FREE):
        if joint != own:
            data.joint(joint).qpos[:2] = 2.0 * math.cos(yaw), 2.0 * math.sin(yaw)
            mujoco.mj_kinematics(model, data)
            yield f'body {model.body(model.jnt_bodyid[joint]).name}'


@pytest.mark.parametrize('yaw', [0.0, 1.0, 2.5, -2.0])
def test_a_scan_is_bit_for_bit_that_of_the_whole_playpen(worlds: Path, yaw: float) -> None:
    robots = (RobotStart(yaw=yaw), RobotStart(name='other', x=-3.0, y=1.5))
    simulation = Simulation(SimulationConfig(world=str(worlds / 'playpen.xml'), robots=robots))
    scanner = lidar.Lidar('husky', simulation.ray_scene(), None)
    state, expected = simulation.robots[0].state, cast_at_every_geom(simulation)
    assert scanner.scan(state, 0.1).tobytes() == expected.tobytes()
    assert np.isfinite(expected).sum() > lidar.BEAMS / 2
    seen = set()
    for what in put_everything_ahead(simulation, yaw):
        moved = cast_at_every_geom(simulation)
        assert scanner.scan(state, 0.1).tobytes() == moved.tobytes(), what
        seen.add(moved.tobytes())
    assert len(seen) > 3
    simulation.reset()
    mujoco.mj_kinematics(simulation.model, simulation.data)
    assert scanner.scan(state, 0.1).tobytes() == cast_at_every_geom(simulation).tobytes()


SEEN = """
    <geom type="box" size="1 0.1 1" pos="0 3 0.5" contype="0" conaffinity="0"/>
    <body name="crate" pos="2 0 0.55">
      <freejoint name="crate"/><geom type="box" size="0.3 0.3 0.5"/>
    </body>
    <body mocap="true" pos="-2 9 0.5"><geom type="box" size="0.3 0.3 0.5"/></body>
"""


@pytest.mark.parametrize('visual', [True, False])
def test_a_scan_sees_all_there_is_where_it_is_at_that_time(
    make_world: Callable[..., str], visual: bool
) -> None:
    config = SimulationConfig(
        world=make_world(SEEN),
        robots=(RobotStart(yaw=math.pi / 2.0),),
        sensors=SensorConfig(lidar_rate_hz=50.0),
    )
    simulation = Simulation(config, visual=visual)
    simulation.data.joint('crate').qvel[:3] = 1.0, 0.0, 2.0
    for _ in range(5):
        simulation.data.mocap_pos[0, 1] -= 1.0
        simulation.advance()
    (robot,) = simulation.robots
    scan = robot.sensors.scan
    assert scan is not None
    ahead = scan[lidar.BEAMS // 2]
    assert ahead == pytest.approx(2.9 - lidar.PLACE[0], abs=0.01), 'what is only seen was not'
    now = Simulation(config)
    now.data.qpos[:], now.data.mocap_pos[:] = simulation.data.qpos, simulation.data.mocap_pos
    mujoco.mj_kinematics(now.model, now.data)
    now.robots[0].state = robot.state
    elsewhere = scan != cast_at_every_geom(now)
    assert not elsewhere.any(), f'{elsewhere.sum()} beams met something elsewhere'


TENT = """
    <geom type="mesh" mesh="tent" pos="2 0 0.3" euler="0 0 30"/>
    <geom type="mesh" mesh="block" pos="0 -2 0.3"/>
  </worldbody>
  <compiler meshdir="meshes"/>
  <asset>
    <mesh name="tent" file="tent.obj" scale="1 2 1" refpos="0.1 0 0"/>
    <mesh name="block" vertex="0 0 0  1 0 0  0 1 0  0 0 0.4"/>
  </asset>
  <worldbody>
"""


@pytest.mark.parametrize('hill', [False, True])
def test_a_scan_of_meshes_is_bit_for_bit_that_of_the_whole_world(
    make_world: Callable[..., str], tmp_path: Path, hill: bool
) -> None:
    (tmp_path / 'meshes').mkdir()
    (tmp_path / 'meshes' / 'tent.obj').write_text(
        'v 0 0 0\nv 1 0 0\nv 0 1 0\nv 0 0 0.4\nf 1 3 2\nf 1 2 4\nf 2 3 4\nf 1 4 3\n'
    )
    more = '<asset><hfield name="hill" nrow="2" ncol="2" size="2 2 1 0.1"/></asset>'
    world = make_world(TENT.replace('<worldbody>', f'{more if hill else ""}<worldbody>'))
    simulation = Simulation(SimulationConfig(world=world))
    simulation.advance()
    scene = simulation.ray_scene()
    assert scene.is_one_body is not hill
    scanner = lidar.Lidar('husky', scene, None)
    seen = scanner.scan(simulation.robots[0].state, 0.1)
    assert seen.tobytes() == cast_at_every_geom(simulation).tobytes()
    assert (seen < 3.0).sum() > 50


HIDDEN = """
    <geom type="box" size="0.1 2 1" pos="3 0 0.5" rgba="1 1 1 {colour}" {material}/>
    <geom type="box" size="0.1 2 1" pos="4 0 0.5"/>
  </worldbody>
  <asset><material name="glass" rgba="1 1 1 0"/></asset>
  <worldbody>
"""


@pytest.mark.parametrize(
    ('colour', 'material', 'seen'), [(1, '', 3.0), (0, '', 4.0), (1, 'material="glass"', 4.0)]
)
def test_what_is_invisible_is_not_scanned(
    make_world: Callable[..., str], colour: int, material: str, seen: float
) -> None:
    world = make_world(HIDDEN.format(colour=colour, material=material))
    simulation = Simulation(SimulationConfig(world=world))
    simulation.advance()
    scanner = lidar.Lidar('husky', simulation.ray_scene(), None)
    ahead = scanner.scan(simulation.robots[0].state, 0.1)[lidar.BEAMS // 2]
    assert ahead == pytest.approx(seen - 0.1 - lidar.PLACE[0], abs=0.01)


def test_scans_come_at_their_rate_and_not_by_default(drive: Drive) -> None:
    simulation = simulate(lidar_rate_hz=10.0)
    count = 0
    for _ in range(100):
        drive(simulation, 0.0, 0.0, seconds=0.02)
        count += simulation.robots[0].sensors.scan is not None
    assert count == 20
    silent = simulate()
    drive(silent, 0.0, 0.0, seconds=0.2)
    assert silent.robots[0].sensors.scan is None


def test_the_fix_moves_north_and_east_as_the_robot_does() -> None:
    receiver = navsat.NavSat(None)
    start = receiver.locate((0.0, 0.0, 0.0), 0.025)
    assert start == (49.9, 8.9, 0.0)
    moved = receiver.locate((100.0, 100.0, 2.0), 0.025)
    # A degree of latitude is 111.2 km there, one of longitude 71.8 km.
    assert (moved.latitude_deg - 49.9) * 111238.0 == pytest.approx(100.0, rel=1e-3)
    assert (moved.longitude_deg - 8.9) * 71842.0 == pytest.approx(100.0, rel=1e-3)
    assert moved.altitude_m == 2.0


def test_the_fix_follows_the_true_position(drive: Drive) -> None:
    simulation = simulate()
    drive(simulation, 1.0, 0.0, seconds=2.0)
    robot = simulation.robots[0]
    assert robot.sensors.fix is not None
    east_m = math.radians(robot.sensors.fix.longitude_deg - 8.9) * 6378137.0
    assert east_m * math.cos(math.radians(49.9)) == pytest.approx(
        robot.state.position[0], rel=0.005
    )


POSTS = """
    <geom name="left_post" type="box" size="0.1 0.1 0.5" pos="4 1 0.5" rgba="1 0 0 1"/>
    <geom name="right_post" type="box" size="0.1 0.1 0.5" pos="4 -1.5 0.5" rgba="0 0 1 1"/>
    <light directional="true" pos="0 0 5" dir="1 0 -1"/>
"""


def test_the_camera_shows_objects_in_place_or_is_refused(
    make_world: Callable[..., str],
) -> None:
    simulation = Simulation(SimulationConfig(world=make_world(POSTS)))
    try:
        camera = Camera('husky', simulation.model, simulation.data)
    except SettingError as error:
        assert '\n' not in str(error)
        assert 'set camera_rate_hz to 0' in str(error)
        return
    pixels = camera.picture()
    message = new_image('camera', pixels, Time(sec=7))
    assert (message.header.frame_id, message.header.stamp.sec) == ('camera', 7)
    assert (message.encoding, message.step, len(message.data)) == ('rgb8', 1920, 480 * 1920)
    picture = np.array(message.data).reshape(480, 640, 3).astype(int)
    info = new_camera_info('camera', camera.focal_length_px)
    camera.close()
    camera.close()
    assert pixels.shape == (info.height, info.width, 3) == (480, 640, 3)
    assert info.header.frame_id == 'camera'
    # The camera looks along x from x = 0.45. K maps a place to its column (sensor_msgs).
    for name, colour in (('left_post', 0), ('right_post', 2)):
        x, y, _ = simulation.model.geom(name).pos
        column = info.k[0] * -y / (x - 0.1 - 0.45) + info.k[2]
        others = np.delete(picture, colour, axis=2).max(axis=2)
        _, columns = np.nonzero(picture[:, :, colour] > 2 * others + 20)
        assert columns.mean() == pytest.approx(column, abs=6.0), name


class Missing(ModuleType):
    """A module that cannot be imported from."""

    def __getattr__(self, _: str) -> None:
        raise ImportError(f'no {self.__name__}:\nlibEGL.so is missing')


def test_a_world_that_asks_for_smaller_pictures_has_whole_ones(tmp_path: Path) -> None:
    world = tmp_path / 'small.xml'
    world.write_text(
        '<mujoco><visual><global offwidth="160" offheight="120"/></visual><worldbody>'
        '<geom name="ground" type="plane" size="9 9 1" rgba="0 1 0 1"/><light pos="0 0 5"/>'
        '</worldbody></mujoco>'
    )
    simulation = Simulation(SimulationConfig(world=str(world)))
    try:
        camera = Camera('husky', simulation.model, simulation.data)
    except SettingError as error:
        assert 'set camera_rate_hz to 0' in str(error)
        return
    pixels = camera.picture()
    camera.close()
    assert pixels[300:, :, 1].min() > 0, 'black ground'


def test_without_egl_and_osmesa_the_camera_is_refused(monkeypatch: pytest.MonkeyPatch) -> None:
    for name in ('mujoco.egl', 'mujoco.osmesa'):
        monkeypatch.setitem(sys.modules, name, Missing(name))
    simulation = simulate()
    with pytest.raises(SettingError, match='set camera_rate_hz to 0') as refused:
        Camera('husky', simulation.model, simulation.data)
    assert '\n' not in str(refused.value)
    for name in ('mujoco.egl', 'mujoco.osmesa'):
        assert f'{name}: no {name}: libEGL.so is missing' in str(refused.value)
