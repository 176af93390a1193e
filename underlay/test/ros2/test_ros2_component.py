# Copyright 2026 The Husky Playpen Lab authors
# SPDX-License-Identifier: Apache-2.0
"""`ros2 component`: what is registered, and what a container is asked for."""

from __future__ import annotations

from collections.abc import Callable
from pathlib import Path
from types import SimpleNamespace
from typing import Any

import pytest
from ros2cli import calls
from ros2component import api


def test_registered_components_are_listed(
    installed_package: Callable[..., Path], ros2: Callable[..., Any]
) -> None:
    index = installed_package('demo') / 'share/ament_index/resource_index/rclcpp_components'
    index.mkdir()
    (index / 'demo').write_text('demo::Talker;lib/libtalker.so\ndemo::Listener;lib/liblisten.so\n')
    assert ros2('component', 'types').lines == ['demo', '  demo::Talker', '  demo::Listener']
    assert ros2('component', 'types', 'demo').lines == ['demo::Talker', 'demo::Listener']
    assert ros2('component', 'types', 'rclpy').out == ''
    assert ros2('component', 'types', 'nothing').status == 1


@pytest.mark.parametrize(
    ('words', 'reason'),
    [
        (('load', '/c', 'demo', 'demo::Talker'), "Unable to find container node '/c'"),
        (('unload', '/c', '1'), "Unable to find container node '/c'"),
        (('standalone', 'demo', 'x'), "Package 'rclcpp_components' not found: containers are pro"),
    ],
)
def test_a_container_that_is_not_there_is_named(
    domain: int, ros2: Callable[..., Any], words: tuple[str, ...], reason: str
) -> None:
    answer = ros2('component', *words)
    assert answer.status == 1
    (said,) = [line for line in answer.err.splitlines() if not line.startswith('hint: ')]
    assert reason in said


def test_no_container_runs(domain: int, ros2: Callable[..., Any]) -> None:
    assert (ros2('component', 'list').status, ros2('component', 'list').out) == (0, '')
    missing = ros2('component', 'list', '/c')
    assert missing.status == 1
    assert "Unable to find container node '/c'" in missing.err


def test_a_container_is_known_by_its_services() -> None:
    services = {
        f'/c/_container/{name}': [f'composition_interfaces/srv/{kind}']
        for name, kind in (
            ('load_node', 'LoadNode'), ('unload_node', 'UnloadNode'), ('list_nodes', 'ListNodes'),
        )
    }  # fmt: skip
    assert api.is_container(services)
    del services['/c/_container/list_nodes']
    assert not api.is_container(services)


def test_a_component_is_requested_as_it_is_described(monkeypatch: pytest.MonkeyPatch) -> None:
    asked: list[Any] = []

    def answer(node: Any, service: Any, name: str, request: Any, **_: bool) -> Any:
        asked.extend((name, request))
        good = request.plugin_name == 'demo::Talker'
        return SimpleNamespace(
            success=good, error_message='no such plugin', unique_id=7, full_node_name='/t'
        )

    monkeypatch.setattr(calls, 'call', answer)

    def load(plugin: str) -> tuple[int, str]:
        return api.load_component_into_container(
            node=None,
            remote_container_node_name='/c',
            package_name='demo',
            plugin_name=plugin,
            parameters=['rate:=3'],
        )

    assert load('demo::Talker') == (7, '/t')
    name, request = asked
    assert name == '/c/_container/load_node'
    assert (request.package_name, request.plugin_name) == ('demo', 'demo::Talker')
    (parameter,) = request.parameters
    assert (parameter.name, parameter.value.integer_value) == ('rate', 3)
    with pytest.raises(RuntimeError, match='Failed to load component: No such plugin'):
        load('demo::Talkr')
