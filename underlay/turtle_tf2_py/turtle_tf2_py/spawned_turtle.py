# Copyright 2026 The Husky Playpen Lab authors
# SPDX-License-Identifier: Apache-2.0
"""A turtle of one's own."""

from __future__ import annotations

from typing import Any

from rclpy.node import Node
from rclpy.task import Future
from turtlesim.srv import Spawn

PLACE_M = {'x': 4.0, 'y': 2.0}


class SpawnedTurtle:
    """Asks for a turtle as soon as there is a turtlesim."""

    def __init__(self, node: Node, name: str) -> None:
        self._name = name
        self._logger = node.get_logger()
        self._client = node.create_client(Spawn, 'spawn')
        self._answer: Future[Any] | None = None
        self._is_there = False

    def is_there(self) -> bool:
        """Tell whether it has been spawned; until then log what it waits for. Call it often."""
        if self._is_there:
            return True
        if self._answer is None:
            if self._client.service_is_ready():
                request = Spawn.Request(name=self._name, **PLACE_M)
                self._answer = self._client.call_async(request)
            else:
                self._logger.info('Service is not ready')
        elif not self._answer.done():
            self._logger.info('Spawn is not finished')
        else:
            # turtlesim answers with an empty name where there is one of that name.
            spawned = self._answer.result().name
            said = (
                f'Successfully spawned {spawned}' if spawned else f'{self._name} was there before'
            )
            self._logger.info(said)
            self._is_there = True
        return self._is_there
