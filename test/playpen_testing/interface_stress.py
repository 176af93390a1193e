# Copyright 2026 The Husky Playpen Lab authors
# SPDX-License-Identifier: Apache-2.0
"""
Topic, service and action at once, of types that have no wheel, from many threads.

    python interface_stress.py SECONDS

Three threads publish, four execute callbacks, one calls a service, one an action. What arrives is
compared with what was sent. Prints how many came as JSON; exit status 1 where one was wrong. A
process that hangs prints where its threads are, and ends.

The client of the action has an executor and a thread of its own: rclpy notes what was asked only
after it was sent, and ignores an answer that another thread takes before
(https://github.com/ros2/rclpy/issues/1123, still in 7.1.6 of Jazzy).
"""

from __future__ import annotations

from collections import Counter
from concurrent.futures import Future, ThreadPoolExecutor, wait
import faulthandler
import json
import sys
from threading import Event
import time
from typing import Any

from action_tutorials_interfaces.action import Fibonacci
from example_interfaces.srv import AddTwoInts
from geometry_msgs.msg import TransformStamped
import rclpy
from rclpy.action import ActionClient, ActionServer
from rclpy.callback_groups import ReentrantCallbackGroup
from rclpy.executors import MultiThreadedExecutor, SingleThreadedExecutor
from tf2_msgs.msg import TFMessage

PATIENCE_SEC = 60.0
PUBLISHERS, EXECUTORS = 3, 4
ALL = ('heard', 'called', 'acted', 'feedback')
"""What is counted of the answers; each is there in the end."""


def transforms(number: int) -> TFMessage:
    """Return a message whose every part follows from a number."""
    message = TFMessage()
    for i in range(number % 4):
        transform = TransformStamped(child_frame_id=f'{number} {i} ä' * (number % 50))
        transform.header.frame_id = str(number)
        transform.transform.translation.x = float(number)
        message.transforms.append(transform)
    return message


def fibonacci(order: int) -> list[int]:
    numbers = [0, 1]
    for _ in range(order):
        numbers.append(numbers[-1] + numbers[-2])
    return numbers


class Stress:
    def __init__(self) -> None:
        self.counts: Counter[str] = Counter()
        self._end = Event()
        self._node = rclpy.create_node('stress')
        group: Any = {'callback_group': ReentrantCallbackGroup()}
        node = self._node
        self._publishers = [
            node.create_publisher(TFMessage, f't{i}', 10) for i in range(PUBLISHERS)
        ]
        for i in range(PUBLISHERS):
            node.create_subscription(TFMessage, f't{i}', self._on_transforms, 10, **group)
        node.create_service(AddTwoInts, '~/add', self._on_add, **group)
        self._adder = node.create_client(AddTwoInts, '~/add', **group)
        self._server = ActionServer(node, Fibonacci, '~/fibonacci', self._on_goal, **group)
        self._executor = MultiThreadedExecutor(EXECUTORS)
        self._executor.add_node(node)
        acting_node = rclpy.create_node('actor')
        self._actor = ActionClient(acting_node, Fibonacci, 'stress/fibonacci')
        self._acting = SingleThreadedExecutor()
        self._acting.add_node(acting_node)

    def run(self, seconds: float) -> None:
        """Do everything at once for a time, and longer where something was never done by then."""
        with ThreadPoolExecutor(PUBLISHERS + 3) as threads:
            threads.submit(self._executor.spin)
            jobs = [threads.submit(self._publish, publisher) for publisher in self._publishers]
            jobs += [threads.submit(self._call), threads.submit(self._act_on_one_thread)]
            time.sleep(seconds)
            deadline = time.monotonic() + PATIENCE_SEC
            while not self._has_enough(jobs) and time.monotonic() < deadline:
                time.sleep(0.1)
            self._end.set()
            wait(jobs)
            self._executor.shutdown()
        for job in jobs:
            job.result()  # raises what its thread raised

    def _has_enough(self, jobs: list[Future[None]]) -> bool:
        return all(map(self.counts.get, ALL)) or any(job.done() for job in jobs)

    def _publish(self, publisher: Any) -> None:
        number = 0
        while not self._end.is_set():
            publisher.publish(transforms(number))
            number += 1
            self.counts['published'] += 1
            time.sleep(0)  # let the others have the interpreter

    def _on_transforms(self, message: TFMessage) -> None:
        self.counts['heard'] += 1
        if message.transforms:
            number = int(message.transforms[0].header.frame_id)
            self._check(message == transforms(number), message)

    def _on_add(self, request: Any, response: Any) -> Any:
        response.sum = request.a + request.b
        return response

    def _call(self) -> None:
        self._adder.wait_for_service()
        while not self._end.is_set():
            number = self.counts['called']
            answer = self._result(self._adder.call_async(AddTwoInts.Request(a=number, b=-7)))
            self._check(answer.sum == number - 7, answer)
            self.counts['called'] += 1

    def _on_goal(self, goal_handle: Any) -> Any:
        numbers = fibonacci(goal_handle.request.order)
        for i in range(2, len(numbers)):
            goal_handle.publish_feedback(Fibonacci.Feedback(partial_sequence=numbers[:i]))
        goal_handle.succeed()
        return Fibonacci.Result(sequence=numbers)

    def _act_on_one_thread(self) -> None:
        self._actor.wait_for_server()
        acts = self._acting.create_task(self._act)
        self._acting.spin_until_future_complete(acts)
        acts.result()

    async def _act(self) -> None:
        while not self._end.is_set():
            order = self.counts['acted'] % 20
            goal = await self._actor.send_goal_async(
                Fibonacci.Goal(order=order), self._on_feedback
            )
            done = await goal.get_result_async()
            self._check(list(done.result.sequence) == fibonacci(order), done)
            self.counts['acted'] += 1

    def _on_feedback(self, message: Any) -> None:
        numbers = list(message.feedback.partial_sequence)
        self._check(numbers == fibonacci(len(numbers) - 2), message)
        self.counts['feedback'] += 1

    def _result(self, future: Any) -> Any:
        done = Event()
        future.add_done_callback(lambda _: done.set())
        if not done.wait(PATIENCE_SEC):
            raise TimeoutError(f'no answer within {PATIENCE_SEC} s')
        return future.result()

    def _check(self, is_right: bool, what: Any) -> None:
        if not is_right:
            self.counts['wrong'] += 1
            print(f'wrong: {what}', file=sys.stderr)


def main() -> int:
    seconds = float(sys.argv[1])
    faulthandler.dump_traceback_later(seconds + PATIENCE_SEC, exit=True)
    rclpy.init()
    stress = Stress()
    stress.run(seconds)
    rclpy.shutdown()
    print(json.dumps(stress.counts))
    return int(stress.counts['wrong'] > 0)


if __name__ == '__main__':
    sys.exit(main())
