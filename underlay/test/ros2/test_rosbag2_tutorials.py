# Copyright 2026 The Husky Playpen Lab authors
# SPDX-License-Identifier: Apache-2.0
"""The tutorials on bags in Python: typed in, run, and played with `ros2 bag`."""

from __future__ import annotations

from collections.abc import Callable
from itertools import islice
from pathlib import Path
import re
import signal
import sys
from threading import Thread
from typing import Any

from playpen_testing.processes import find_line
from playpen_testing.spinning import SpunNodes
from playpen_testing.waiting import wait_until
import pytest
from rclpy.node import Node
from rclpy.serialization import deserialize_message
import rosbag2_py
from rosidl_runtime_py.utilities import get_message
from std_msgs.msg import String

RECORDER = """
import rclpy
from rclpy.node import Node
from rclpy.serialization import serialize_message
import rosbag2_py
from std_msgs.msg import String

class SimpleBagRecorder(Node):
    def __init__(self):
        super().__init__('simple_bag_recorder')
        self.writer = rosbag2_py.SequentialWriter()
        storage_options = rosbag2_py._storage.StorageOptions(uri='my_bag', storage_id='mcap')
        converter_options = rosbag2_py._storage.ConverterOptions('', '')
        self.writer.open(storage_options, converter_options)
        topic_info = rosbag2_py._storage.TopicMetadata(
            id=0, name='chatter', type='std_msgs/msg/String', serialization_format='cdr')
        self.writer.create_topic(topic_info)
        self.subscription = self.create_subscription(
            String, 'chatter', self.topic_callback, 10)

    def topic_callback(self, msg):
        stamp = self.get_clock().now().nanoseconds
        self.writer.write('chatter', serialize_message(msg), stamp)
        print('wrote', msg.data, flush=True)

rclpy.init()
rclpy.spin(SimpleBagRecorder())
rclpy.shutdown()
"""
GENERATOR = """
from example_interfaces.msg import Int32
from rclpy.clock import Clock
from rclpy.duration import Duration
from rclpy.serialization import serialize_message
import rosbag2_py

def main(args=None):
    writer = rosbag2_py.SequentialWriter()
    writer.open(
        rosbag2_py.StorageOptions(uri='big_synthetic_bag', storage_id='mcap'),
        rosbag2_py.ConverterOptions('', ''))
    writer.create_topic(rosbag2_py.TopicMetadata(
        id=0, name='synthetic', type='example_interfaces/msg/Int32', serialization_format='cdr'))
    stamp = Clock().now()
    for number in range(100):
        writer.write('synthetic', serialize_message(Int32(data=number)), stamp.nanoseconds)
        stamp += Duration(seconds=1)

main()
"""
PLAYER = """
import rclpy
from rclpy.node import Node
import rosbag2_py
from std_msgs.msg import String

class SimpleBagReader(Node):
    def __init__(self):
        super().__init__('simple_bag_reader')
        self.reader = rosbag2_py.SequentialReader()
        self.reader.open(
            rosbag2_py.StorageOptions(uri='my_bag', storage_id='mcap'),
            rosbag2_py.ConverterOptions(
                input_serialization_format='cdr', output_serialization_format='cdr'))
        self.publisher = self.create_publisher(String, 'chatter', 10)
        self.timer = self.create_timer(0.01, self.timer_callback)

    def timer_callback(self):
        while self.publisher.get_subscription_count() and self.reader.has_next():
            topic, data, stamp = self.reader.read_next()
            if topic == 'chatter':
                self.publisher.publish(data)
                return

rclpy.init()
rclpy.spin(SimpleBagReader())
"""


def read(path: Path) -> list[tuple[str, Any, int]]:
    reader = rosbag2_py.SequentialReader()
    reader.open_uri(str(path))
    kinds = {each.name: get_message(each.type) for each in reader.get_all_topics_and_types()}
    found = []
    while reader.has_next():
        topic, data, stamp = reader.read_next()
        found.append((topic, deserialize_message(data, kinds[topic]), stamp))
    return found


def lines_of(process: Any, number: int) -> list[str]:
    heard: list[str] = []
    hearing = Thread(target=lambda: heard.extend(islice(process.stdout, number)), daemon=True)
    hearing.start()
    hearing.join(20.0)
    return heard


@pytest.mark.parametrize('number', [signal.SIGINT, signal.SIGTERM])
def test_a_node_records_what_ros2_bag_and_a_node_play(
    processes: Any, ros2_here: Callable[..., Any], tmp_path: Path, number: int
) -> None:
    talker = processes.node('talker', 'talker')
    recorder = processes.start(sys.executable, '-c', RECORDER)
    wrote = [find_line(recorder.stdout, '^wrote (hello .*)')[1] for _ in range(5)]
    recorder.send_signal(number)
    rest, _ = recorder.communicate(timeout=10)
    wrote += [line.removeprefix('wrote ') for line in rest.splitlines() if line[:6] == 'wrote ']
    talker.terminate()
    talker.wait()

    texts = [message.data for _, message, _ in read(tmp_path / 'my_bag')]
    assert texts == wrote
    info = ros2_here('bag', 'info', 'my_bag').out
    assert f'Topic: chatter | Type: std_msgs/msg/String | Count: {len(texts)} | ' in info

    listener = processes.node('listener', 'listener')
    if number == signal.SIGINT:
        played = ros2_here('bag', 'play', 'my_bag', '--topics', '/chatter')
        assert (played.status, played.err.count('\n')) == (0, 1)
    else:
        processes.start(sys.executable, '-c', PLAYER)
    assert lines_of(listener, len(texts)) == [f'heard {text}\n' for text in texts]


def test_a_program_makes_a_bag_without_a_node(
    processes: Any, ros2_here: Callable[..., Any], tmp_path: Path
) -> None:
    generator = processes.start(sys.executable, '-c', GENERATOR)
    assert generator.communicate(timeout=20)[0] == ''
    info = ros2_here('bag', 'info', 'big_synthetic_bag').out
    assert re.search(r'Duration: +99\.000000000s\n', info)
    messages = read(tmp_path / 'big_synthetic_bag')
    assert [message.data for _, message, _ in messages] == list(range(100))
    assert messages[99][2] - messages[0][2] == 99 * 10**9


def test_what_ros2_bag_records_is_read(processes: Any, domain: int, tmp_path: Path) -> None:
    with SpunNodes(domain) as nodes:
        node = nodes.start(Node, 'talker')
        publisher, hello = node.create_publisher(String, 'chatter', 10), f'hello {"x" * 100_000}'
        node.create_timer(0.05, lambda: publisher.publish(String(data=hello)))
        recorder = processes.ros2('bag', 'record', '-o', str(tmp_path / 'run'), '/chatter')
        file = tmp_path / 'run' / 'run_0.mcap'
        wait_until(  # it is written by the megabyte
            lambda: file.exists() and file.stat().st_size > 600_000,
            timeout_sec=30.0,
            what='six messages on the disk',
        )
        recorder.send_signal(signal.SIGINT)
        recorder.communicate(timeout=10)
    messages = read(tmp_path / 'run')
    assert len(messages) > 5
    assert {topic for topic, _, _ in messages} == {'/chatter'}
    assert all(message.data.startswith('hello ') for _, message, _ in messages)
    bag = rosbag2_py.Info().read_metadata(str(tmp_path / 'run'), 'mcap')
    (topic,) = bag.topics_with_message_count
    assert topic.message_count == len(read(tmp_path / 'run' / 'run_0.mcap')) == len(messages)
    assert topic.topic_metadata.type_description_hash.startswith('RIHS01_')
