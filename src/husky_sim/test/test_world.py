# Copyright 2026 The Husky Playpen Lab authors
# SPDX-License-Identifier: Apache-2.0
"""Worlds by students: which load, and how the others are refused."""

from collections.abc import Callable
import math
from pathlib import Path

from husky_course.robot import RobotStart
from husky_course.route import plan_route, survey_route
from husky_course.waypoints import parse_course
from husky_sim.errors import StartPoseError, WorldError
from husky_sim.simulation import Simulation
from husky_sim.world.world import load_world
import mujoco
import pytest

from husky_sim.config import SimulationConfig

FLOOR = '<geom name="floor" type="plane" size="5 5 1"/>'


@pytest.fixture
def write(tmp_path: Path) -> Callable[[str], str]:
    def to_file(text: str) -> str:
        path = tmp_path / 'world.xml'
        path.write_text(text, encoding='utf-8')
        return str(path)

    return to_file


def mjcf(body: str = FLOOR, *, before: str = '', after: str = '') -> str:
    return (
        f'<mujoco>\n  {before}\n  <worldbody>\n    {body}\n  </worldbody>\n  {after}\n</mujoco>\n'
    )


def test_a_plain_floor_is_a_world(write: Callable[[str], str]) -> None:
    world = load_world(write(mjcf()), [RobotStart()])
    assert world.names == ('husky',)
    assert world.obstacles == ()
    assert world.steps_per_period == 10


def test_obstacles_are_named_after_the_outermost_body(write: Callable[[str], str]) -> None:
    body = FLOOR + (
        '<body name="house" pos="3 0 0"><geom type="box" size="1 1 1"/>'
        '<body name="chimney" pos="0 0 1"><geom size="0.2"/></body></body>'
        '<geom name="stone" pos="-3 0 0" size="0.3"/><geom pos="0 3 0" size="0.3"/>'
    )
    world = load_world(write(mjcf(body)), [RobotStart()])
    assert [outline.name for outline in world.obstacles][:2] == ['stone', 'geom 2']
    assert world.obstacles[2].name == 'house'
    assert world.obstacles[2].size == pytest.approx((2.0, 2.0))


WALLS = (
    '<geom type="box" size="4 0.1 0.4" pos="1 3 0.4"/>'
    '<geom type="box" size="4 0.1 0.4" pos="1 -3 0.4"/>'
    '<geom type="box" size="0.1 3 0.4" pos="5 0 0.4"/>'
)
GATE_POSTS = (
    '<geom size="0.1 0.5" type="cylinder" pos="0 0.8 0.5"/>'
    '<geom size="0.1 0.5" type="cylinder" pos="0 -0.8 0.5"/>'
)
LINTEL = '<geom type="box" size="0.1 0.9 0.1" pos="0 0 1.1"/>'
SLANTED = '<geom name="fence" type="box" size="3 0.05 0.4" pos="1.5 2 0.4" euler="0 0 25"/>'
PLANE = '<geom name="wall" type="plane" size="{size}" pos="6 0 0" zaxis="{zaxis}"/>'
ROOF = '<geom name="roof" type="box" size="1 1 0.05" pos="0 0 1"/>'


@pytest.mark.parametrize(
    ('body', 'sizes', 'clearance_m'),
    [
        (f'<body name="room">{WALLS}</body>', [(8.0, 0.2), (8.0, 0.2), (0.2, 6.0)], 0.41),
        (f'<body name="gate" pos="2 0 0">{GATE_POSTS}{LINTEL}</body>', [(0.1,), (0.1,)], 0.36),
        (SLANTED, [(6.0, 0.1)], 0.61),
        (f'<body name="yard">{SLANTED}</body>', [(6.0, 0.1)], 0.61),
        (PLANE.format(size='4 3 1', zaxis='-1 0 0'), [(0.002, 6.0)], 1.5),
        (PLANE.format(size='0 0 1', zaxis='-1 -1 0'), [(100.0 * math.sqrt(2.0), 0.002)], 0.82),
        (ROOF, [], None),
        # What hangs may swing or fall down, and on a hill a robot is higher.
        (f'<body name="lamp"><freejoint/>{ROOF}</body>', [(2.0, 2.0)], 0.0),
        (ROOF + '<geom name="ramp" type="box" size="1 1 0.5" pos="9 0 0.1"/>', [(2.0, 2.0)], 0.0),
    ],
)
def test_an_outline_leaves_out_where_a_robot_can_be(
    write: Callable[[str], str],
    body: str,
    sizes: list[tuple[float, ...]],
    clearance_m: float | None,
) -> None:
    world = load_world(write(mjcf(FLOOR + body)), [RobotStart()])
    assert sorted(each.size for each in world.obstacles) == [
        pytest.approx(size) for size in sorted(sizes)
    ]
    route = plan_route(parse_course('waypoints: [[0, 0], [4, 0]]'))
    found = survey_route(route, world.obstacles)
    assert found.least_m == (clearance_m and pytest.approx(clearance_m, abs=0.01))
    assert len(found.near) == (clearance_m == 0.0)


def test_obstacles_have_the_same_names_without_what_is_only_seen(
    write: Callable[[str], str],
) -> None:
    body = FLOOR + (
        '<geom pos="0 0 9" size="0.3" contype="0" conaffinity="0"/>'
        '<geom pos="0 3 0" size="0.3"/><geom name="stone" pos="-3 0 0" size="0.3"/>'
        '<geom pos="3 0 0" size="0.3"/>'
    )
    path = write(mjcf(body))
    for visual in (True, False):
        names = load_world(path, [RobotStart()], visual=visual).names
        assert names == ('husky', 'geom 2', 'stone', 'geom 4')


def test_static_obstacles_keep_names_in_a_fused_world(
    write: Callable[[str], str],
) -> None:
    body = FLOOR + '<body name="house" pos="3 0 0"><geom type="box" size="1 1 1"/></body>'
    world = load_world(write(mjcf(body, before='<compiler fusestatic="true"/>')), [RobotStart()])
    assert [outline.name for outline in world.obstacles] == ['house']


def test_what_is_only_seen_is_no_obstacle(write: Callable[[str], str]) -> None:
    paint = '<geom name="paint" type="box" size="1 1 0.001" contype="0" conaffinity="0"/>'
    assert load_world(write(mjcf(FLOOR + paint)), [RobotStart()]).obstacles == ()


def test_a_world_keeps_its_own_gravity_and_actuators(write: Callable[[str], str]) -> None:
    before = '<option gravity="0 0 -1.62" timestep="0.001"/>'
    arm = (
        '<body name="gate" pos="3 0 1"><joint name="hinge" axis="0 0 1"/>'
        '<geom type="box" size="0.5 0.05 0.5"/></body>'
    )
    text = mjcf(FLOOR + arm, before=before)
    text = text.replace('</mujoco>', '<actuator><motor joint="hinge"/></actuator></mujoco>')
    world = load_world(write(text), [RobotStart()])
    assert world.model.opt.gravity[2] == -1.62
    assert world.model.nu == 5
    assert world.steps_per_period == 20


def test_a_robot_stands_on_a_height_field_and_on_a_platform(write: Callable[[str], str]) -> None:
    platform = '<geom name="floor_2" type="box" size="1 1 0.25" pos="3 0 0.25"/>'
    world = load_world(write(mjcf(FLOOR + platform)), [RobotStart(x=3.0)])
    data = mujoco.MjData(world.model)
    mujoco.mj_forward(world.model, data)
    height = data.body('husky/base_link').xpos[2]
    assert height == pytest.approx(0.5 + 0.13, abs=0.01)


BALL = '<body name="ball" pos="3 0 0.2"><freejoint/><geom size="0.2"/></body>'
GATE = (
    '<body name="gate" pos="3 0 1"><joint name="hinge" axis="0 0 1"/>'
    '<geom type="box" size="0.5 0.05 0.5"/></body>'
)
HILLS = '<asset><hfield name="h" nrow="9" ncol="9" size="5 5 0.1 0.1"/></asset>'
ODD = {
    'an unnamed plane': mjcf('<geom type="plane" size="5 5 1"/>'),
    'a floor that nobody sees': mjcf('<geom type="plane" size="5 5 1" rgba="0 0 0 0"/>'),
    'a floor with a capital': mjcf('<geom name="Floor" type="box" size="5 5 0.1"/>'),
    'a height field': mjcf('<geom type="hfield" hfield="h"/>', before=HILLS),
    'a roof over the start': mjcf(FLOOR + '<geom type="box" size="1 1 0.05" pos="0 0 1"/>'),
    'a file included': mjcf(FLOOR + '<include file="part.xml"/>'),
    'a keyframe': mjcf(FLOOR + BALL, after='<keyframe><key qpos="2 1 1 1 0 0 0"/></keyframe>'),
    'actuators': mjcf(FLOOR + GATE, after='<actuator><motor joint="hinge"/></actuator>'),
    'a state of activation': mjcf(
        FLOOR + GATE, after='<actuator><intvelocity joint="hinge" actrange="-1 1"/></actuator>'
    ),
    'sensors': mjcf(FLOOR + GATE, after='<sensor><jointpos joint="hinge"/></sensor>'),
    'an obstacle with the name of the robot': mjcf(
        FLOOR + '<body name="husky" pos="3 0 1"><geom size="0.2"/></body>'
    ),
    'materials and classes with our names': mjcf(
        FLOOR,
        before='<default><default class="husky"><geom contype="0"/></default></default>'
        '<asset><material name="husky_yellow" rgba="1 0 0 1"/></asset>',
    ),
    'defaults of its own': mjcf(
        FLOOR, before='<default><geom friction="0.01"/><joint damping="9"/></default>'
    ),
    'a solver of its own': mjcf(
        FLOOR, before='<option integrator="RK4" cone="pyramidal" timestep="0.0005"/>'
    ),
    'little memory': mjcf(FLOOR, before='<size memory="10K"/>'),
}


@pytest.mark.parametrize('what', ODD)
def test_an_odd_world_is_driven_in_like_any_other(
    write: Callable[[str], str], drive: Callable[..., None], tmp_path: Path, what: str
) -> None:
    (tmp_path / 'part.xml').write_text('<mujoco><geom name="x" size="0.1" pos="4 0 0"/></mujoco>')
    simulation = Simulation(SimulationConfig(world=write(ODD[what])))
    drive(simulation, 0.5, 0.0, seconds=0.5)
    assert simulation.robots[0].state.position[0] == pytest.approx(0.2, abs=0.03)
    assert simulation.robots[0].state.velocity[2] == pytest.approx(0.0, abs=0.01)
    assert simulation.physics_warnings == 0
    assert simulation.unreported_touches() == []


@pytest.mark.parametrize(
    ('text', 'reason'),
    [
        ('<mujoco><worldbody>', r'XML parse error.*Line number=1:'),
        ('', r'empty file'),
        ('<sdf version="1.4"/>', r"Unrecognized XML model type: 'sdf', line 1$"),
        (mjcf('<geom typ="box" size="1 1 1"/>'), r"unrecognized attribute: 'typ'.*line 4$"),
        (mjcf('<gem/>'), r"unrecognized element.*'gem', line 4$"),
        (mjcf('<geom type="box"/>'), r'size 0 must be positive in geom.*line 4$'),
        (mjcf('<geom type="mesh" mesh="none"/>'), r"mesh 'none' not found.*line 4$"),
        (
            mjcf(before='<asset><mesh name="m" file="no.obj"/></asset>'),
            r"opening file 'no.obj', line 2$",
        ),
        (mjcf('<include file="no.xml"/>'), r"opening file 'no.xml' .*line 4$"),
        (
            mjcf(after='<sensor><accelerometer site="no"/></sensor>'),
            r"unrecognized name 'no'.*line 6$",
        ),
        (mjcf('<geom size="0.1"/>'), r'nothing to drive on; add a plane'),
        (
            mjcf('<geom name="floor" contype="2" conaffinity="2" size="9"/>'),
            r'nothing to drive on',
        ),
        (mjcf(before='<option timestep="0.003"/>'), r'whole number of timesteps.*line 2$'),
        (mjcf(before='<option timestep="0.005"/>'), r'0.004 s or less, line 2$'),
        (mjcf(before='<option timestep="1e-9"/>'), r'timestep=1e-09: .*1e-05 s or more, line 2$'),
        (mjcf(before='<option timestep="0"/>'), r'timestep=0: .*use 0.004, line 2$'),
        (mjcf(before='<option timestep="nan"/>'), r'timestep=nan: .*use 0.004, line 2$'),
        (
            mjcf(before='<option><flag contact="disable"/></option>'),
            r'contact="disable": the robot needs it to drive; remove the flag, line 2$',
        ),
        (
            mjcf(before='<option><flag filterparent="disable"/></option>'),
            r'filterparent="disable"',
        ),
        (
            mjcf(before='<option><flag gravity="disable"/></option>'),
            r'gravity="disable": the robot needs it to drive; remove the flag, line 2$',
        ),
        *(
            (
                mjcf(before=f'<option gravity="{gravity}"/>'),
                rf'gravity="{gravity}": .*use finite numbers, the last below 0, line 2$',
            )
            for gravity in ('0 0 nan', 'nan 0 -9.8', '0 0 -inf', '0 0 9', '0 0 0', '3 0 0')
        ),
        (
            mjcf(FLOOR + '<body name="bin" pos="nan 0 1"><geom size="0.1"/></body>'),
            r"body 'bin': its pos is nan 0 1; use numbers up to 1e10, line 4$",
        ),
        (
            mjcf(FLOOR + '<body name="bin"><geom size="0.1" friction="nan 0 0"/></body>'),
            r"body 'bin': its friction is nan 0 0; use numbers up to 1e10, line 4$",
        ),
        (mjcf(FLOOR + '<geom size="0.1" pos="inf 0 1"/>'), r"body 'world': its pos is inf 0 1"),
        (mjcf(before='<option actuatorgroupdisable="0"/>'), r'the motors .* group 0; .*, line 2$'),
        (mjcf(before='<option iterations="0"/>'), r'iterations="0": without any .*, line 2$'),
        (mjcf(before='<compiler settotalmass="100"/>'), r'would weigh something else; .*line 2$'),
        (
            mjcf('<body name="husky/base_link"/>' + FLOOR),
            r"repeated name 'husky/base_link' in body, line 4$",
        ),
        (
            mjcf(before='<asset><material name="husky/husky_yellow"/></asset>'),
            r"repeated name 'husky/husky_yellow' in material, line 2$",
        ),
        (
            mjcf(FLOOR + '<geom name="flat ground 0" size="0.1" pos="3 0 0"/>'),
            r"repeated name 'flat ground 0' in geom, line 4$",
        ),
    ],
)
def test_a_broken_world_is_refused_with_file_and_reason(
    write: Callable[[str], str], text: str, reason: str
) -> None:
    path = write(text)
    for visual in (True, False):  # as with a camera, and without one
        with pytest.raises(WorldError, match=reason) as refused:
            load_world(path, [RobotStart()], visual=visual)
        assert path in str(refused.value)
        assert '\n' not in str(refused.value)


@pytest.mark.parametrize(
    ('part', 'reason'),
    [
        ('<geom typ="box"/>', r"attribute: 'typ' Element 'geom', line 2 of part\.xml$"),
        ('<geom mesh="x" type="mesh"/>', r"mesh 'x' not found .* id 1, line 2 of part\.xml$"),
        ('<geom type="box"/>', r"size 0 must be positive in geom Element name '', id 1$"),
        ('<include file="no.xml"/>', r"opening file '.*no\.xml' Element 'include'$"),
        (
            '<body name="crate"><geom size="0.3"/></body>',
            r'would start inside crate \(.*world\.xml, line 2 of part\.xml\); start',
        ),
    ],
)
def test_a_fault_in_an_included_file_has_its_file_and_line(
    write: Callable[[str], str], tmp_path: Path, part: str, reason: str
) -> None:
    (tmp_path / 'part.xml').write_text(f'<mujocoinclude>\n{part}\n</mujocoinclude>\n')
    path = write(mjcf(FLOOR + '<include file="part.xml"/>'))
    with pytest.raises((WorldError, StartPoseError), match=reason):
        load_world(path, [RobotStart()])


def attaching(file: str) -> str:
    return mjcf(
        FLOOR + '<frame pos="0 2 0"><attach model="m" body="crate" prefix="my_"/></frame>',
        before=f'<asset><model name="m" {file}/></asset>',
    )


def test_a_body_of_another_file_is_an_obstacle(
    write: Callable[[str], str], tmp_path: Path
) -> None:
    crate = '<body name="crate" pos="3 0 0.3"><geom type="box" size="0.3 0.3 0.3"/></body>'
    (tmp_path / 'model.xml').write_text(mjcf(crate))
    (outline,) = load_world(write(attaching('file="model.xml"')), [RobotStart()]).obstacles
    assert (outline.name, outline.x, outline.y) == ('my_crate', 3.0, 2.0)


@pytest.mark.parametrize(
    ('file', 'reason'),
    [
        ('', r'does not say why; look for .* a <model> without file='),
        ('file="world.xml"', r"the model 'world\.xml' is made of itself; name .*, line 2$"),
        ('file="part.xml"', r"the model 'world\.xml' is made of itself; name "),
        ('file="no.xml"', r"opening file '.*no\.xml' Element 'model', line 2$"),
    ],
)
def test_a_model_that_cannot_be_attached_is_refused(
    write: Callable[[str], str], tmp_path: Path, file: str, reason: str
) -> None:
    (tmp_path / 'part.xml').write_text(attaching('file="world.xml"'))
    with pytest.raises(WorldError, match=reason):
        load_world(write(attaching(file)), [RobotStart()])


def test_a_soft_body_is_an_obstacle_as_it_stands_at_the_start(write: Callable[[str], str]) -> None:
    cloth = (
        '<flexcomp name="{}" type="grid" dim="2" count="5 3 1" spacing="0.1 0.1 0.1" mass="1" '
        'radius="0.02" pos="{}"/>'
    )
    hung = cloth.format('near', '2 1 0.3') + cloth.format('high', '2 -1 2.0')
    (outline,) = load_world(write(mjcf(FLOOR + hung)), [RobotStart()]).obstacles
    assert (outline.name, outline.x, outline.y) == ('near', 2.0, 1.0)
    assert outline.size == pytest.approx((0.44, 0.24))


def test_names_in_another_encoding_are_refused(tmp_path: Path) -> None:
    path = tmp_path / 'world.xml'
    door = '<body name="Tür" pos="3 0 1"><geom size="0.1"/></body>'
    path.write_text(mjcf(FLOOR + door), encoding='latin-1')
    with pytest.raises(WorldError, match=r"the name 'T.r' is not UTF-8; save .*, line 4$"):
        load_world(str(path), [RobotStart()])


def test_thousands_of_obstacles_get_the_memory_they_ask_for(
    write: Callable[[str], str],
) -> None:
    crate = '<body name="{0}" pos="{0} 5 0.3"><geom type="box" size="0.3 0.3 0.3"/></body>'
    forest = mjcf(FLOOR + ''.join(crate.format(number) for number in range(3000)))
    with pytest.raises(WorldError, match=r'than 14 MB; give it more, as by <size memory="500M"/>'):
        load_world(write(forest), [RobotStart()])
    wide = forest.replace('<worldbody>', '<size memory="500M"/><worldbody>')
    assert len(load_world(write(wide), [RobotStart()]).obstacles) == 3000


def test_a_file_that_is_not_there_or_not_xml_is_refused(tmp_path: Path) -> None:
    with pytest.raises(WorldError, match='no such file'):
        load_world(str(tmp_path / 'none.xml'), [RobotStart()])
    (tmp_path / 'world.txt').write_text('<mujoco/>', encoding='utf-8')
    with pytest.raises(WorldError, match=r'not an \.xml file'):
        load_world(str(tmp_path / 'world.txt'), [RobotStart()])


def test_a_plane_that_nobody_can_drive_on_is_a_wall(write: Callable[[str], str]) -> None:
    path = write(mjcf(FLOOR + PLANE.format(size='0 0 1', zaxis='-1 0 0.1')))
    assert load_world(path, [RobotStart()]).names == ('husky', 'wall')
    write(mjcf(FLOOR + PLANE.format(size='9 9 1', zaxis='1 0 0.1')))  # the same, seen from within
    with pytest.raises(StartPoseError, match=r'start inside wall \(.*, line 4\)'):
        load_world(path, [RobotStart()])


@pytest.mark.parametrize(
    ('starts', 'reason'),
    [
        (
            [RobotStart(x=2.455)],
            r'inside jersey_barrier_15 \(.*playpen.xml, line \d+\); start it further away',
        ),
        ([RobotStart(x=-3.0, y=4.0)], 'would start inside fire_hydrant_0'),
        ([RobotStart(x=7.0, y=-2.5)], 'would start inside Construction Barrel'),
        ([RobotStart(x=100.0)], r'there is no ground under it \(.*playpen.xml\)'),
        ([RobotStart(), RobotStart(x=5.0)], 'every robot needs a name of its own'),
        (
            [RobotStart(name='a'), RobotStart(name='b', x=0.4)],
            r'a at .* would start inside b \([^,]*playpen.xml\); start',  # b has no line there
        ),
    ],
)
def test_a_start_pose_that_cannot_be_is_refused(
    worlds: Path, starts: list[RobotStart], reason: str
) -> None:
    with pytest.raises(StartPoseError, match=reason):
        load_world(str(worlds / 'playpen.xml'), starts)


@pytest.mark.parametrize('name', ['playpen.xml', 'empty.xml', 'husky.xml'])
def test_the_worlds_load_in_plain_mujoco_without_a_warning(worlds: Path, name: str) -> None:
    model = mujoco.MjModel.from_xml_path(str(worlds / name))
    data = mujoco.MjData(model)
    mujoco.mj_step(model, data, nstep=500)
    assert not any(data.warning.number)


def test_a_robot_stands_as_told_and_keeps_the_solver_of_its_file(
    write: Callable[[str], str], worlds: Path
) -> None:
    option = '<option integrator="RK4" cone="pyramidal" impratio="7" timestep="0.001"/>'
    start = RobotStart(x=1.0, y=-2.0, yaw=0.5, name='a')
    world = load_world(write(mjcf(before=option)), [RobotStart(), start], load_y_m=0.03)
    data = mujoco.MjData(world.model)
    mujoco.mj_forward(world.model, data)
    body = data.body('a/base_link')
    assert body.xpos[:2] == pytest.approx((1.0, -2.0))
    assert body.xmat == pytest.approx(
        [math.cos(0.5), -math.sin(0.5), 0.0, math.sin(0.5), math.cos(0.5), 0.0, 0.0, 0.0, 1.0]
    )
    assert world.model.body('a/base_link').ipos[1] == 0.03
    assert world.model.body('husky/base_link').ipos[1] == 0.03
    its_own = mujoco.MjModel.from_xml_path(str(worlds / 'husky.xml')).opt
    for name in ('integrator', 'cone', 'impratio'):
        assert getattr(world.model.opt, name) == getattr(its_own, name)
    assert world.model.opt.timestep == 0.001


def test_the_robot_is_that_beside_the_world_or_the_one_of_the_lab(
    write: Callable[[str], str], worlds: Path, tmp_path: Path
) -> None:
    path = write(mjcf())
    assert load_world(path, [RobotStart()]).husky == str(worlds / 'husky.xml')
    beside = tmp_path / 'husky.xml'
    beside.write_text(mjcf('<body name="robot"><geom size="0.1"/></body>'), encoding='utf-8')
    with pytest.raises(WorldError, match=r"husky.xml': no body named base_link; take the husky"):
        load_world(path, [RobotStart()])
    given = str(worlds / 'husky.xml')
    assert load_world(path, [RobotStart()], husky=given).husky == given


def test_the_husky_weighs_and_measures_what_the_original_does(worlds: Path) -> None:
    model = mujoco.MjModel.from_xml_path(str(worlds / 'husky.xml'))
    assert model.body_subtreemass[model.body('base_link').id] == pytest.approx(56.582)
    assert model.body('base_link').mass[0] == 46.034
    assert model.body('base_link').inertia.sum() == pytest.approx(0.6022 + 1.7386 + 2.0296)
    for wheel, x, y in (
        ('front_left', 0.256, 0.2854),
        ('front_right', 0.256, -0.2854),
        ('rear_left', -0.256, 0.2854),
        ('rear_right', -0.256, -0.2854),
    ):
        link = model.body(f'{wheel}_wheel_link')
        assert link.pos.tolist() == [x, y, 0.03282]
        assert link.mass[0] == 2.637
        assert sorted(link.inertia) == pytest.approx([0.02467, 0.02467, 0.04411])
    front = model.geom('front_bumper')
    assert 2.0 * (front.pos[0] + front.size[0]) == pytest.approx(0.9874)
    bottom, top = model.geom('chassis'), model.geom('top_plate')
    assert bottom.pos[2] - bottom.size[2] == pytest.approx(0.0)
    assert top.pos[2] + top.size[2] == pytest.approx(0.2514)
    assert 2.0 * top.size[:2] == pytest.approx([0.73, 0.59])
    wheel = model.geom('front_left_wheel')
    assert 2.0 * (0.2854 + wheel.size[1]) == pytest.approx(0.6851)
    assert math.isclose(wheel.size[0], 0.1651, abs_tol=0.003)
