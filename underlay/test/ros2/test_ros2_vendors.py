# Copyright 2026 The Husky Playpen Lab authors
# SPDX-License-Identifier: Apache-2.0
"""Servers on another DDS than the commands; here they are on the same one, and told apart."""

from __future__ import annotations

from collections.abc import Iterator

import pytest
import rclpy
from rclpy.node import Node
from rclpy.signals import uninstall_signal_handlers
from ros2_diagnosis import nodes
from ros2cli import calls
from ros2cli.errors import CommandError
from ros2cli.node.direct import command_node
from std_srvs.srv import Trigger

WHY = '/mute: on Fast DDS, and this terminal on Cyclone DDS: .* start all with the same RMW_IMPL'


@pytest.fixture
def foreign_server(domain: int, monkeypatch: pytest.MonkeyPatch) -> Iterator[str]:
    """Offer a service that is never answered, and take it for one on another DDS."""
    monkeypatch.setattr(nodes, '_OWN_VENDOR', 'Cyclone DDS')
    context = rclpy.Context()
    rclpy.init(context=context, domain_id=domain)
    node = Node('mute', context=context)
    node.create_service(Trigger, '/ask', lambda _, response: response)
    yield '/ask'
    node.destroy_node()
    rclpy.shutdown(context=context)
    uninstall_signal_handlers()  # command_node leaves its own, as a process that ends may


def test_a_service_on_another_dds_is_not_waited_for(
    foreign_server: str, capsys: pytest.CaptureFixture[str], monkeypatch: pytest.MonkeyPatch
) -> None:
    with command_node() as node:
        with pytest.raises(CommandError, match=WHY):
            calls.call(node, Trigger, foreign_server, Trigger.Request())
        # Where upstream waits without end, one line says that it is in vain.
        future = node.node.create_client(Trigger, foreign_server).call_async(Trigger.Request())
        monkeypatch.setattr(node, 'spin_until', lambda done, _=None: done())
        node.spin_until_answered(future, foreign_server, lambda: True)
    assert capsys.readouterr().err.startswith('hint: /mute: on Fast DDS, ')
