# Copyright 2026 The Husky Playpen Lab authors
# SPDX-License-Identifier: Apache-2.0
"""
A world file with Huskies in it: loaded, checked, and looked up by name.

What a file must hold to be a world: something to drive on under every robot's start. A geom is
ground if it is static and a height field or a plane that one can drive on, or if its name or its
body's begins with one of GROUND_NAMES. Every other geom that touches belongs to an obstacle,
named after the outermost body around it (or after itself where it lies in the world body). A soft
body is an obstacle by its own name, or ground.
"""

from collections.abc import Iterator, Sequence
from contextlib import contextmanager
from dataclasses import dataclass
from functools import cached_property
import hashlib
import math
from pathlib import Path
import warnings

from husky_course.frames import Indices, to_world
from husky_course.outline import Outline
from husky_course.robot import RobotStart
import mujoco
import numpy as np

from husky_sim.errors import StartPoseError, WorldError
from husky_sim.world.flat_ground import (
    add_contacts,
    add_planes,
    find_flat_ground,
    FlatGround,
    is_flat_ground,
    UPWARDS,
)
from husky_sim.world.silhouette import highest_m, lowest_m, outline_of_flex, outlines_of
from husky_sim.world.world_file import (
    check_models,
    check_names,
    check_numbers,
    check_settings,
    line_of,
    refused,
    steps_per_period,
)

GROUND_NAMES = ('ground', 'floor', 'asphalt', 'ramp')
HUSKY_FILE = 'husky.xml'

# Places, from base_link, under which there must be ground: the middle and the four wheels.
_FEET = ((0.0, 0.0), (0.256, 0.2854), (0.256, -0.2854), (-0.256, 0.2854), (-0.256, -0.2854))
_ABOVE_M = 1000.0
_HEADROOM_M = 0.6  # what a robot needs, also with its front up a slope of 20 degrees
_NOTHING, _GROUND, _FIRST_OWNER = -2, -1, 0


@dataclass(frozen=True, kw_only=True)
class World:
    """A compiled model, and the robot or obstacle that each geom or soft body belongs to."""

    path: str
    husky: str  # the robot's file
    spec: mujoco.MjSpec
    model: mujoco.MjModel
    robots: tuple[RobotStart, ...]
    flat_ground: tuple[FlatGround, ...]
    uneven_ground: tuple[int, ...]  # geoms that are ground and have no flat face
    names: tuple[str, ...]  # of owners: first the robots, then the obstacles
    owners: Indices  # of every geom: its place in names, or negative
    flex_owners: Indices  # the same of every soft body
    steps_per_period: int

    @cached_property
    def obstacles(self) -> tuple[Outline, ...]:
        """Return the outlines of what stands in it; measured when somebody asks for them."""
        data = _standing(self.path, self.model)
        return _outlines(self, data)

    def touching(self, data: mujoco.MjData) -> Indices:
        """Return the two owners of each contact, shape (n, 2), or negative numbers."""
        return _touching(data, self.owners, self.flex_owners)

    @property
    def digest(self) -> str:
        """Return a hash of what MuJoCo has made of all files that the world consists of."""
        content = np.empty(mujoco.mj_sizeModel(self.model), np.uint8)
        mujoco.mj_saveModel(self.model, None, content)
        return hashlib.sha256(content.tobytes()).hexdigest()

    def part(self, geom: int) -> str:
        """Return the name of a robot's part, without the robot's name before it."""
        name: str = self.model.geom(geom).name
        return name.rpartition('/')[2]


def load_world(
    path: str,
    robots: Sequence[RobotStart],
    *,
    husky: str = '',
    visual: bool = True,
    load_y_m: float = 0.0,
) -> World:
    """
    Load a world file and put the robots into it.

    :param husky: the robot's file; by default husky.xml beside the world, else the installed one.
    :param visual: keep what is only seen; without it steps are faster, and the motion the same.
    :param load_y_m: how far the centre of mass of a robot's body is to the left of the middle.
    :raises WorldError: if the file cannot be a world.
    :raises StartPoseError: if a robot cannot start where it should.
    """
    # By default MuJoCo writes its warnings to a file in the current folder. MjData counts them,
    # too.
    mujoco.set_mju_user_warning(lambda _: None)
    if len({robot.name for robot in robots}) != len(robots):
        raise StartPoseError(
            f'robots={[robot.name for robot in robots]}: every robot needs a name of its own'
        )
    empty = _compiled(path, _parsed(path))
    check_names(path, empty)
    check_numbers(path, empty)
    steps = steps_per_period(path, empty.opt.timestep)
    data = _standing(path, empty)
    empty.geom_matid[:], empty.geom_rgba[:] = -1, 1.0  # rays go through what nobody sees
    ground = {geom for geom in range(empty.ngeom) if _is_ground(empty, data, geom)}
    heights = [_height_under(path, empty, data, ground, robot) for robot in robots]
    faces = find_flat_ground(empty, data, ground)
    spec = _parsed(path)
    check_settings(path, spec)
    husky = husky or _husky_beside(path)
    memory = spec.memory
    with _mujoco_refusals(path):  # as of a name that the world has, too
        add_planes(spec, faces)
        for robot, height in zip(robots, heights, strict=True):
            _attach(spec, husky, robot, height, load_y_m)
            add_contacts(spec, husky, robot.name, faces)
    spec.compiler.discardvisual = not visual
    model = _compiled(path, spec)
    if memory > model.narena:
        spec.memory = memory
        model = _compiled(path, spec)
    in_file, data = data, _standing(path, model)
    # In a model without what is only seen, geoms have other numbers.
    numbers = [geom for geom in range(empty.ngeom) if _is_fixed_obstacle(empty, in_file, geom)]
    names, owners = _owners(model, data, robots, numbers)
    flex_owners = _flex_owners(model, names)
    _check_start(path, robots, names, _touching(data, owners, flex_owners))
    return World(
        path=path,
        husky=husky,
        spec=spec,
        model=model,
        robots=tuple(robots),
        flat_ground=faces,
        uneven_ground=tuple(
            geom
            for geom in np.flatnonzero(owners == _GROUND).tolist()
            if not is_flat_ground(model, data, geom)
        ),
        names=tuple(names),
        owners=owners,
        flex_owners=flex_owners,
        steps_per_period=steps,
    )


def _parsed(path: str) -> mujoco.MjSpec:
    if not Path(path).is_file():
        raise WorldError(f'world={path!r}: no such file; give the path of an MJCF file (.xml)')
    if Path(path).suffix.lower() != '.xml':
        raise WorldError(f'world={path!r}: not an .xml file; give an MJCF file')
    check_models(path)
    with _mujoco_refusals(path):
        try:
            spec = mujoco.MjSpec.from_file(path)
        except RuntimeError as error:  # as of a model without a file
            raise ValueError(
                'MuJoCo cannot read it and does not say why; look for an element that lacks '
                'something, as a <model> without file=...'
            ) from error
    spec.compiler.fusestatic = False  # fused bodies lose their names
    return spec


def _compiled(path: str, spec: mujoco.MjSpec) -> mujoco.MjModel:
    with _mujoco_refusals(path), warnings.catch_warnings():
        # One is about a body that cannot sleep because a robot stands in it: refused later.
        warnings.simplefilter('ignore')
        return spec.compile()


@contextmanager
def _mujoco_refusals(path: str) -> Iterator[None]:
    try:
        yield
    except (ValueError, mujoco.FatalError) as error:
        raise refused(path, error) from error


def _standing(path: str, model: mujoco.MjModel) -> mujoco.MjData:
    """Return the state in which everything stands as the file has it."""
    data = mujoco.MjData(model)
    try:
        mujoco.mj_forward(model, data)
    except mujoco.FatalError as error:
        # MuJoCo guesses how much memory a world needs, too little for thousands of obstacles.
        raise refused(
            path,
            f'MuJoCo needs more memory for it than {model.narena / 2**20:.0f} MB; give it more, '
            'as by <size memory="500M"/>',
        ) from error
    return data


def _husky_beside(path: str) -> str:
    """Find the robot's file beside the world, or else beside the worlds that came with us."""
    beside = Path(path).resolve().parent / HUSKY_FILE
    if beside.is_file():
        return str(beside)
    return str(default_worlds() / HUSKY_FILE)


def default_worlds() -> Path:
    """Return the folder of the worlds that came with the package: installed, or in its source."""
    in_source = Path(__file__).resolve().parents[4] / 'worlds'
    if in_source.is_dir():
        return in_source
    from ament_index_python.packages import get_package_share_directory

    return Path(get_package_share_directory('husky_sim')) / 'worlds'


def _attach(
    spec: mujoco.MjSpec, husky: str, robot: RobotStart, height: float, load_y_m: float
) -> None:
    child = _parsed(husky)
    base = child.body('base_link')
    if base is None:
        raise WorldError(
            f'{husky!r}: no body named base_link; take the husky.xml that came with us'
        )
    base.ipos[1] = load_y_m
    # The wheels need the solver of their own file. The timestep, gravity and sleep stay the
    # world's.
    spec.option.integrator = child.option.integrator
    spec.option.cone = child.option.cone
    spec.option.impratio = child.option.impratio
    frame = spec.worldbody.add_frame(
        pos=[robot.x, robot.y, height],
        quat=[math.cos(robot.yaw / 2.0), 0.0, 0.0, math.sin(robot.yaw / 2.0)],
    )
    child.option.timestep = spec.option.timestep
    spec.memory = -1  # automatic: a size that a world sets may not suffice with robots
    frame.attach_body(base, f'{robot.name}/', '')


def _height_under(
    path: str, model: mujoco.MjModel, data: mujoco.MjData, ground: set[int], robot: RobotStart
) -> float:
    """Return the height of the highest ground under a robot's wheels."""
    if not ground:
        raise refused(
            path,
            'nothing to drive on; add a plane, or a geom whose name begins with one of '
            f'{", ".join(GROUND_NAMES)}',
        )
    heights = []
    for forward, left in _FEET:
        x, y = to_world(robot.pose, forward, left)
        height = _ground_at(model, data, ground, x, y)
        if height is None:
            raise StartPoseError(
                f'{robot.name} at x={robot.x:g}, y={robot.y:g}: there is no ground under it '
                f'({path}); start it on the ground'
            )
        heights.append(height)
    return max(heights)


def _ground_at(
    model: mujoco.MjModel, data: mujoco.MjData, ground: set[int], x: float, y: float
) -> float | None:
    """Return the height of the ground, by a ray from above through everything else."""
    planes = [geom for geom in ground if _is_plane(model, geom) and _is_flat(data, geom)]
    down = np.array([0.0, 0.0, -1.0])
    hit = np.zeros(1, dtype=np.int32)
    z = _ABOVE_M
    for _ in range(2 * model.ngeom):  # into and out of each
        distance = mujoco.mj_ray(model, data, np.array([x, y, z]), down, None, 1, -1, hit)
        if distance < 0.0:
            return None
        z -= distance
        if int(hit[0]) in ground:
            # A ray meets a plane where it is drawn alone, wheels meet it beyond, too.
            return max([z, *(_height_of(data, plane, x, y) for plane in planes)])
        z -= 1e-6
    return None


def _height_of(data: mujoco.MjData, plane: int, x: float, y: float) -> float:
    normal, middle = data.geom_xmat[plane][2::3], data.geom_xpos[plane]
    return float(middle[2] - (normal[:2] @ (np.array([x, y]) - middle[:2])) / normal[2])


def _can_touch(model: mujoco.MjModel, geom: int) -> bool:
    """Return whether a geom collides with a robot's, whose contype and conaffinity are 1."""
    return bool((model.geom_contype[geom] | model.geom_conaffinity[geom]) & 1)


def _is_plane(model: mujoco.MjModel, geom: int) -> bool:
    return int(model.geom_type[geom]) == mujoco.mjtGeom.mjGEOM_PLANE


def _is_flat(data: mujoco.MjData, geom: int) -> bool:
    return bool(data.geom_xmat[geom][8] >= UPWARDS)


def _is_ground(model: mujoco.MjModel, data: mujoco.MjData, geom: int) -> bool:
    if not _can_touch(model, geom):
        return False
    body = int(model.geom_bodyid[geom])
    if model.body_weldid[body] != 0:
        return False
    if int(model.geom_type[geom]) == mujoco.mjtGeom.mjGEOM_HFIELD:
        return True
    if _is_plane(model, geom) and _is_flat(data, geom):  # else it is a wall
        return True
    names = [model.geom(geom).name]
    while body:
        names.append(model.body(body).name)
        body = int(model.body_parentid[body])
    return any(name.lower().startswith(GROUND_NAMES) for name in names)


def _is_fixed_obstacle(model: mujoco.MjModel, data: mujoco.MjData, geom: int) -> bool:
    """Return whether a geom of a world without robots is an obstacle without a body."""
    fixed = int(model.geom_bodyid[geom]) == 0
    return fixed and _can_touch(model, geom) and not _is_ground(model, data, geom)


def _owners(
    model: mujoco.MjModel,
    data: mujoco.MjData,
    robots: Sequence[RobotStart],
    numbers: Sequence[int],
) -> tuple[list[str], Indices]:
    """
    Give every geom to a robot, an obstacle, the ground or nothing.

    :param numbers: of the obstacles without a body, by which those without a name are called.
    """
    left = iter(numbers)
    names = [robot.name for robot in robots]
    bases = {model.body(f'{robot.name}/base_link').id: i for i, robot in enumerate(robots)}
    owners = np.full(model.ngeom, _NOTHING, dtype=np.int64)
    obstacles: dict[tuple[str, int], int] = {}
    for geom in range(model.ngeom):
        if not _can_touch(model, geom):
            continue
        root = int(model.body_rootid[model.geom_bodyid[geom]])
        if root in bases:
            owners[geom] = bases[root]
            continue
        if _is_ground(model, data, geom):
            owners[geom] = _GROUND
            continue
        key = ('body', root) if root else ('geom', next(left))
        if key not in obstacles:
            obstacles[key] = len(names)
            named = model.body(root) if root else model.geom(geom)
            names.append(named.name or f'{key[0]} {key[1]}')
        owners[geom] = obstacles[key]
    return names, owners


def _flex_owners(model: mujoco.MjModel, names: list[str]) -> Indices:
    """Give every soft body to an obstacle of its own, which is added to names, or the ground."""
    owners = np.full(model.nflex, _GROUND, dtype=np.int64)
    for flex in range(model.nflex):
        name = mujoco.mj_id2name(model, mujoco.mjtObj.mjOBJ_FLEX, flex) or f'flex {flex}'
        if not name.lower().startswith(GROUND_NAMES):
            owners[flex] = len(names)
            names.append(name)
    return owners


def _touching(data: mujoco.MjData, owners: Indices, flex_owners: Indices) -> Indices:
    found = owners[data.contact.geom]  # of a soft body that is -1
    if not flex_owners.size:
        return found
    flexes = data.contact.flex
    return np.where(flexes < 0, found, flex_owners[flexes])


def _check_start(
    path: str, robots: Sequence[RobotStart], names: Sequence[str], touching: Indices
) -> None:
    for pair in touching.tolist():
        ours, theirs = sorted(pair)
        if ours >= _FIRST_OWNER and ours < len(robots) and theirs != ours:
            robot = robots[ours]
            where = line_of(path, names[theirs]) if theirs >= len(robots) else ''
            raise StartPoseError(
                f'{robot.name} at x={robot.x:g}, y={robot.y:g}, yaw={robot.yaw:g} would start '
                f'inside {names[theirs]} ({path}{where}); start it further '
                'away'
            )


def _outlines(world: World, data: mujoco.MjData) -> tuple[Outline, ...]:
    """Measure what a robot can drive against: not what hangs above, as a roof or a bridge."""
    model = world.model
    ground = np.flatnonzero(world.owners == _GROUND).tolist()
    above_m = max(highest_m(model, data, geom) for geom in ground) + _HEADROOM_M
    outlines: list[Outline] = []
    for owner in range(len(world.robots), len(world.names)):
        for flex in np.flatnonzero(world.flex_owners == owner).tolist():
            outline = outline_of_flex(world.names[owner], model, data, flex, below_m=above_m)
            outlines += [outline] if outline else []
        all_geoms = np.flatnonzero(world.owners == owner).tolist()
        geoms = [
            geom
            for geom in all_geoms
            if model.body_weldid[model.geom_bodyid[geom]] or lowest_m(model, data, geom) < above_m
        ]
        if geoms:
            body = int(model.body_rootid[model.geom_bodyid[geoms[0]]])
            outlines += outlines_of(world.names[owner], model, data, geoms, body=body)
    return tuple(outlines)
