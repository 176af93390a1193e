# Copyright 2026 The Husky Playpen Lab authors
# SPDX-License-Identifier: Apache-2.0
"""The topics of one robot's scanner, receiver and camera; each only where its rate is not 0."""

from array import array
from typing import Any

from builtin_interfaces.msg import Time
import numpy as np
from rclpy.node import Node
from rclpy.qos import QoSProfile
from sensor_msgs.msg import CameraInfo, Image, LaserScan, NavSatFix

from husky_sim.config import SensorConfig
from husky_sim.messages.messages import FixMessage, Stamp, time_message
from husky_sim.messages.packed_message import Form
from husky_sim.sensors import camera, lidar
from husky_sim.sensors.sensors import Rate
from husky_sim.simulation import SimulatedRobot, Simulation


class SensorTopics:
    """Publishes what is new after a control period."""

    def __init__(
        self,
        node: Node,
        simulation: Simulation,
        robot: SimulatedRobot,
        namespace: str,
        qos: QoSProfile,
        form: Form,
    ) -> None:
        """
        Create the publishers.

        :raises SettingError: if pictures are requested where none can be drawn.
        """
        config: SensorConfig = simulation.config.sensors
        self._robot = robot
        self._simulation = simulation
        self._form = form
        self._scans: Any = None
        self._fixes: Any = None
        self._camera: camera.Camera | None = None
        if config.lidar_rate_hz > 0.0:
            self._scans = node.create_publisher(LaserScan, f'{namespace}front/scan', qos)
            self._scan = new_scan(config.lidar_rate_hz)
        if config.navsat_rate_hz > 0.0:
            self._fixes = node.create_publisher(NavSatFix, f'{namespace}navsat/fix', qos)
            self._fix = FixMessage()
        if config.camera_rate_hz > 0.0:
            self._camera = camera.Camera(robot.name, simulation.model, simulation.data)
            self._pictures = Rate(config.camera_rate_hz)
            self._images = node.create_publisher(Image, f'{namespace}camera/image_raw', qos)
            self._infos = node.create_publisher(CameraInfo, f'{namespace}camera/camera_info', qos)
            self._info = new_camera_info(self._camera.focal_length_px)

    def publish(self, stamp: Stamp) -> None:
        """Publish the measurements of the control period that ended at stamp."""
        sensors = self._robot.sensors
        if sensors.scan is not None and self._scans.get_subscription_count():
            self._scan.header.stamp = time_message(stamp)
            self._scan.ranges = array('f', sensors.scan.tobytes())
            self._scans.publish(self._scan)
        if sensors.fix is not None and self._fixes.get_subscription_count():
            self._fix.pack(stamp, sensors.fix)
            self._fixes.publish(self._form(self._fix))
        if self._camera is None or not self._pictures.is_due(self._simulation.periods):
            return
        if self._infos.get_subscription_count():
            self._info.header.stamp = time_message(stamp)
            self._infos.publish(self._info)
        if self._images.get_subscription_count():  # drawing costs more than all the rest
            self._images.publish(new_image(self._camera.picture(), time_message(stamp)))

    def close(self) -> None:
        """Release the camera; may be called twice."""
        if self._camera is not None:
            self._camera.close()
            self._camera = None


def new_scan(rate_hz: float) -> LaserScan:
    """Make a scan with everything but its ranges."""
    message = LaserScan(
        angle_min=-lidar.HALF_ANGLE_RAD,
        angle_max=lidar.HALF_ANGLE_RAD,
        angle_increment=lidar.ANGLE_INCREMENT_RAD,
        scan_time=1.0 / rate_hz,
        range_min=lidar.RANGE_MIN_M,
        range_max=lidar.RANGE_MAX_M,
    )
    message.header.frame_id = lidar.FRAME
    return message


def new_camera_info(focal_length_px: float) -> CameraInfo:
    """Make the description of a camera without distortion."""
    middle_x, middle_y = camera.WIDTH / 2.0, camera.HEIGHT / 2.0
    message = CameraInfo(width=camera.WIDTH, height=camera.HEIGHT, distortion_model='plumb_bob')
    message.header.frame_id = camera.FRAME
    message.d = [0.0] * 5
    message.k = [focal_length_px, 0.0, middle_x, 0.0, focal_length_px, middle_y, 0.0, 0.0, 1.0]
    message.r = [1.0, 0.0, 0.0, 0.0, 1.0, 0.0, 0.0, 0.0, 1.0]
    message.p = [*message.k[:3], 0.0, *message.k[3:6], 0.0, *message.k[6:], 0.0]
    return message


def new_image(pixels: np.ndarray, stamp: Time) -> Image:
    """Make a picture."""
    message = Image(
        width=camera.WIDTH, height=camera.HEIGHT, encoding='rgb8', step=3 * camera.WIDTH
    )
    message.header.frame_id = camera.FRAME
    message.header.stamp = stamp
    message.data = array('B', pixels.tobytes())
    return message
