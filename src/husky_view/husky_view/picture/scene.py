# Copyright 2026 The Husky Playpen Lab authors
# SPDX-License-Identifier: Apache-2.0
"""The playpen and its robots on the page."""

from dataclasses import replace
import math

from husky_course.frames import Array, Pose
from husky_course.outline import Outline
from husky_sim.recording import loose_body_ids
from husky_sim.world import World
from mjviser import ViserMujocoScene
from mjviser.conversions import get_body_name
import mujoco
import numpy as np
import viser

from husky_view.picture.meshes import alike_meshes_as_one, matte_meshes
from husky_view.picture.page import FIXED

GROUND = (176, 174, 168)
GROUND_LINES = (160, 158, 152)

SKY = (235, 242, 255)
SKY_INTENSITY = 2.6
# Name, position, intensity. With one light alone, sides in its shadow would look flat.
SUNS = (('sun', (-6.0, -9.0, 14.0), 2.4), ('second_sun', (9.0, 4.0, 6.0), 0.7))

ABOVE_GROUND_M = 0.02
"""Height of lines: at the height of the ground they would flicker."""

_HULLS = '/hull'  # mjviser's name of convex hulls, which are hidden at first
_BASE_HEIGHT_M = 0.12836  # of base_link above the ground: husky.xml


class PlaypenScene:
    """A world on the page."""

    def __init__(self, server: viser.ViserServer, world: World) -> None:
        self.world = world
        _color_textured(world.model)
        self._data = mujoco.MjData(world.model)
        mujoco.mj_kinematics(world.model, self._data)
        with matte_meshes(), alike_meshes_as_one():
            self._scene = ViserMujocoScene(server, world.model, num_envs=1)
        server.scene.remove_by_name(_HULLS)  # nobody can have them shown
        for handle in self._scene._fixed_geom_handles.values():
            handle.receive_shadow = False  # or it is drawn a second time, with none on it
        self._scene.camera_tracking_enabled = False
        _light(server)
        _color_planes(server, world.model)
        self._lasers = [world.model.site(f'{robot.name}/front_laser').id for robot in world.robots]
        self._bases = [world.model.body(f'{robot.name}/base_link').id for robot in world.robots]
        self.ground_m = float(self._data.xpos[self._bases[0]][2]) - _BASE_HEIGHT_M
        self._loose = loose_body_ids(world)
        self._before = {name: self._place_of(body) for name, body in self._loose.items()}
        self._scene.update_from_mjdata(self._data)

    def show(self, qpos: Array) -> None:
        """Draw the world at these joint positions."""
        self._data.qpos[:] = qpos
        mujoco.mj_kinematics(self.world.model, self._data)
        self._scene.update_from_mjdata(self._data)

    def position(self, robot: int) -> Array:
        """Return the position of a robot's base_link in the world."""
        position: Array = self._data.xpos[self._bases[robot]].copy()
        return position

    def outlines(self) -> tuple[Outline, ...]:
        """Return the outlines of the obstacles where they are now; some can be pushed."""
        return tuple(map(self._moved, self.world.obstacles))

    def _moved(self, outline: Outline) -> Outline:
        if outline.name not in self._loose:
            return outline
        x, y, yaw = self._place_of(self._loose[outline.name])
        before_x, before_y, before_yaw = self._before[outline.name]
        turned = yaw - before_yaw
        dx, dy = outline.x - before_x, outline.y - before_y
        return replace(
            outline,
            x=x + dx * math.cos(turned) - dy * math.sin(turned),
            y=y + dx * math.sin(turned) + dy * math.cos(turned),
            yaw=outline.yaw + turned,
        )

    def _place_of(self, body: int) -> Pose:
        rotation = self._data.xmat[body]
        yaw = math.atan2(float(rotation[3]), float(rotation[0]))
        return float(self._data.xpos[body][0]), float(self._data.xpos[body][1]), yaw

    def beam_ends(self, robot: int, ranges: Array, angles: Array) -> Array:
        """Return the ends of beams (n, 3) in the world; angles in radians to the left."""
        laser = self._lasers[robot]
        rotation = self._data.site_xmat[laser].reshape(3, 3)
        beams = np.column_stack([ranges * np.cos(angles), ranges * np.sin(angles), 0.0 * angles])
        ends: Array = beams @ rotation.T + self._data.site_xpos[laser]
        return ends


def _light(server: viser.ViserServer) -> None:
    """
    Light the scene without shadows and reflections.

    Without a graphics processor, mjviser's environment map and viser's shadows take seconds a
    frame; plain lights give 20 frames a second. The sky is the page's: it costs nothing there.
    """
    scene = server.scene
    scene.configure_environment_map(None)
    scene.configure_default_lights(enabled=False)
    scene.add_light_hemisphere(
        '/light/sky', sky_color=SKY, ground_color=GROUND, intensity=SKY_INTENSITY
    )
    for name, position, intensity in SUNS:
        scene.add_light_directional(
            f'/light/{name}', position=position, intensity=intensity, cast_shadow=False
        )


def _color_planes(server: viser.ViserServer, model: mujoco.MjModel) -> None:
    """
    Give planes the colour of ground: mjviser draws them white with a grid.

    It also draws those that no picture of MuJoCo shows, such as what treads stand on.
    """
    for geom in range(model.ngeom):
        if model.geom_type[geom] != mujoco.mjtGeom.mjGEOM_PLANE:
            continue
        body = get_body_name(model, int(model.geom_bodyid[geom]))
        name = model.geom(geom).name or None  # as mjviser calls what has none
        grid = server.scene.get_handle_by_name(f'{FIXED}{body}/{name}')
        if isinstance(grid, viser.GridHandle):
            grid.visible = bool(model.geom_rgba[geom, 3])
            grid.plane_color = GROUND
            grid.plane_opacity = 1.0
            grid.cell_color = grid.section_color = GROUND_LINES


def _color_textured(model: mujoco.MjModel) -> None:
    """Give a material with a texture its mean colour: mjviser draws no textures on boxes."""
    role = int(mujoco.mjtTextureRole.mjTEXROLE_RGB)
    for material in range(model.nmat):
        texture = int(model.mat_texid[material, role])
        if texture < 0 or int(model.tex_nchannel[texture]) != 3:
            continue
        first = int(model.tex_adr[texture])
        size = int(model.tex_width[texture]) * int(model.tex_height[texture]) * 3
        pixels = model.tex_data[first : first + size].reshape(-1, 3)
        model.mat_rgba[material, :3] *= pixels.mean(axis=0) / 255.0
