# Copyright 2026 The Husky Playpen Lab authors
# SPDX-License-Identifier: Apache-2.0
"""The topics of one robot's scanner, receiver, camera and battery; each only where it is on."""

from array import array
from typing import NamedTuple

from builtin_interfaces.msg import Time
import numpy as np
import numpy.typing as npt
from rclpy.node import Node
from rclpy.qos import qos_profile_sensor_data, QoSProfile
from sensor_msgs.msg import BatteryState, CameraInfo, Image, LaserScan, NavSatFix

from husky_sim.config import SensorConfig
from husky_sim.messages.messages import (
    BatteryMessage,
    FixMessage,
    ScanMessage,
    Stamp,
    time_message,
)
from husky_sim.messages.packed_message import Form
from husky_sim.ros import clearpath
from husky_sim.ros.packed_topic import PackedTopic
from husky_sim.sensors import camera, lidar
from husky_sim.sensors.sensors import Rate
from husky_sim.simulation import SimulatedRobot, Simulation


class Names(NamedTuple):
    """Topics and frames of the sensors."""

    scan: str
    scan_frame: str
    fix: str
    fix_frame: str
    image: str
    camera_info: str
    camera_frame: str


OF_LAB = Names(
    *('front/scan', lidar.FRAME, 'navsat/fix', 'base_link'),
    *('camera/image_raw', 'camera/camera_info', camera.FRAME),
)
OF_CLEARPATH = Names(
    *(clearpath.SCAN, clearpath.SCAN_FRAME, clearpath.FIX, clearpath.FIX_FRAME),
    *(clearpath.IMAGE, clearpath.CAMERA_INFO, clearpath.CAMERA_FRAME),
)


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
        *,
        interface: str,
    ) -> None:
        """
        Create the publishers.

        :raises SettingError: if pictures are requested where none can be drawn.
        """
        config: SensorConfig = simulation.config.sensors
        self._robot = robot
        self._simulation = simulation
        self._camera: camera.Camera | None = None
        self._pictures = Rate(config.camera_rate_hz)
        if config.camera_rate_hz > 0.0:
            self._camera = camera.Camera(robot.name, simulation.model, simulation.data)
        every = [OF_LAB, *([OF_CLEARPATH] if interface == clearpath.NAME else [])]
        self._scans = [
            PackedTopic(
                ScanMessage(names.scan_frame, rate_hz=config.lidar_rate_hz),
                node.create_publisher(LaserScan, f'{namespace}{names.scan}', qos),
                form,
            )
            for names in every
            if config.lidar_rate_hz > 0.0
        ]
        self._fixes = [
            PackedTopic(
                FixMessage(names.fix_frame),
                node.create_publisher(NavSatFix, f'{namespace}{names.fix}', qos),
                form,
            )
            for names in every
            if config.navsat_rate_hz > 0.0
        ]
        self._read_scans, self._read_fixes = self._scans, self._fixes
        self._images = [
            (names.camera_frame, node.create_publisher(Image, f'{namespace}{names.image}', qos))
            for names in every
            if self._camera is not None
        ]
        battery = BatteryMessage()
        profiles = {'battery_state': qos}
        if interface == clearpath.NAME:
            profiles[clearpath.BATTERY] = qos_profile_sensor_data
        self._batteries = [
            PackedTopic(
                battery, node.create_publisher(BatteryState, f'{namespace}{topic}', profile), form
            )
            for topic, profile in profiles.items()
            if robot.battery is not None
        ]
        self._infos = [
            (
                new_camera_info(names.camera_frame, self._camera.focal_length_px),
                node.create_publisher(CameraInfo, f'{namespace}{names.camera_info}', qos),
            )
            for names in every
            if self._camera is not None
        ]

    def count_subscriptions(self) -> None:
        """Note which scans and fixes are read; `publish` leaves out the others."""
        self._read_scans = [each for each in self._scans if each.is_read]
        self._read_fixes = [each for each in self._fixes if each.is_read]

    def publish(self, stamp: Stamp) -> None:
        """Publish the measurements of the control period that ended at stamp."""
        sensors = self._robot.sensors
        if sensors.scan is not None:
            for topic in self._read_scans:
                topic.pack(stamp, sensors.scan)
                topic.publish()
        if sensors.fix is not None:
            for topic in self._read_fixes:
                topic.pack(stamp, sensors.fix)
                topic.publish()
        if sensors.battery is not None:
            for topic in self._batteries:
                topic.pack(stamp, sensors.battery)
                topic.publish()
        if self._camera is not None and self._pictures.is_due(self._simulation.periods):
            self._publish_picture(self._camera, time_message(stamp))

    def _publish_picture(self, seen_by: camera.Camera, time: Time) -> None:
        for info, publisher in self._infos:
            if publisher.get_subscription_count():
                info.header.stamp = time
                publisher.publish(info)
        read = [each for each in self._images if each[1].get_subscription_count()]
        if read:  # drawing costs more than all the rest
            image = new_image(read[0][0], seen_by.picture(), time)
            for image.header.frame_id, publisher in read:
                publisher.publish(image)

    def close(self) -> None:
        """Release the camera; may be called twice."""
        if self._camera is not None:
            self._camera.close()
            self._camera = None


def new_camera_info(frame: str, focal_length_px: float) -> CameraInfo:
    """Make the description of a camera without distortion."""
    middle_x, middle_y = camera.WIDTH / 2.0, camera.HEIGHT / 2.0
    message = CameraInfo(width=camera.WIDTH, height=camera.HEIGHT, distortion_model='plumb_bob')
    message.header.frame_id = frame
    message.d = [0.0] * 5
    message.k = [focal_length_px, 0.0, middle_x, 0.0, focal_length_px, middle_y, 0.0, 0.0, 1.0]
    message.r = [1.0, 0.0, 0.0, 0.0, 1.0, 0.0, 0.0, 0.0, 1.0]
    message.p = [*message.k[:3], 0.0, *message.k[3:6], 0.0, *message.k[6:], 0.0]
    return message


def new_image(frame: str, pixels: npt.NDArray[np.uint8], stamp: Time) -> Image:
    """Make a picture."""
    message = Image(
        width=camera.WIDTH, height=camera.HEIGHT, encoding='rgb8', step=3 * camera.WIDTH
    )
    message.header.frame_id = frame
    message.header.stamp = stamp
    message.data = array('B', pixels.tobytes())
    return message
