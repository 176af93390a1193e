# Copyright 2026 The Husky Playpen Lab authors
# SPDX-License-Identifier: Apache-2.0
"""What misses its partner in a graph by its name, and what only seems to."""

from __future__ import annotations

import pytest
from ros2_diagnosis import nodes, partners
from ros2_doctor_checks import checks
from ros2cli import discovery
from ros2doctor import api
from ros2topic import topics
from rtps_graph.graph import Endpoint, Graph, Node, Qos, Role

_USUAL = Qos(True, False, None, None, False, None)


def _graph(**nodes_by_name: list[tuple[Role, str, str]]) -> Graph:
    made = [
        Node(
            name,
            '/',
            [
                Endpoint(f'{name}{at}'.encode(), role, topic, kind, '', _USUAL)
                for at, (role, topic, kind) in enumerate(uses)
            ],
        )
        for name, uses in nodes_by_name.items()
    ]
    return Graph(made, [endpoint for node in made for endpoint in node.endpoints])


def test_partners_that_nobody_misses_are_not_told_of() -> None:
    twist, text, scan = (
        'geometry_msgs/msg/Twist',
        'std_msgs/msg/String',
        'sensor_msgs/msg/LaserScan',
    )
    assert not [
        *partners.check_topics(
            _graph(
                husky_sim=[
                    (Role.SUBSCRIPTION, '/a/cmd_vel', twist),
                    (Role.SUBSCRIPTION, '/b/cmd_vel', twist),
                    (Role.PUBLISHER, '/a/cmd_vel_out', twist),
                    (Role.SUBSCRIPTION, '/note', text),
                ],
                driver=[(Role.PUBLISHER, '/a/cmd_vel', twist), (Role.PUBLISHER, '/x', text)],
                husky_view=[(Role.SUBSCRIPTION, '/front/scan', scan)],
            )
        )
    ]


def test_nothing_is_said_of_services_that_are_there_and_of_what_is_hidden() -> None:
    get, add = 'rcl_interfaces/srv/GetParameters', 'example_interfaces/srv/AddTwoInts'
    graph = _graph(
        talker=[(Role.SERVER, '/talker/get_parameters', get), (Role.SERVER, '/add', add)],
        asks=[
            (Role.CLIENT, '/talker/get_parameters', get),
            (Role.CLIENT, '/add', add),
            (Role.CLIENT, '/count/_action/cancel_goal', 'action_msgs/srv/CancelGoal'),
            (Role.SUBSCRIPTION, '/count/_action/status', 'action_msgs/msg/GoalStatusArray'),
        ],
    )
    assert not [*partners.check_services(graph), *partners.check_topics(graph)]


def test_a_robot_that_reads_something_else_is_no_less_meant() -> None:
    odometry = 'nav_msgs/msg/Odometry'
    told = [(Role.PUBLISHER, '/odometry/filtered', odometry), (Role.PUBLISHER, '/raw', odometry)]
    reads = [(Role.SUBSCRIPTION, '/cmd_vel', 'geometry_msgs/msg/Twist')]
    hears = [(Role.SUBSCRIPTION, '/raw', odometry)]
    waits = [(Role.SUBSCRIPTION, '/odom', odometry)]
    (found,) = partners.check_topics(_graph(husky=[*told, *reads], view=hears, driver=waits))
    assert found.serious
    assert str(found).startswith(
        '/odom: /driver subscribes to this, but /husky publishes /odometry/filtered, of one type'
    )


def test_what_a_robot_passes_on_is_meant_for_no_other() -> None:
    twist = 'geometry_msgs/msg/Twist'
    robots = _graph(
        husky_sim=[(Role.SUBSCRIPTION, '/cmd_vel', twist), (Role.PUBLISHER, '/told', twist)],
        turtlesim=[(Role.SUBSCRIPTION, '/turtle1/cmd_vel', twist)],
    )
    assert list(partners.check_topics(robots)) == []


def test_what_several_robots_wait_for_is_one_line() -> None:
    twist = 'geometry_msgs/msg/Twist'
    waits = [(Role.SUBSCRIPTION, f'/{name}/cmd_vel', twist) for name in 'abcd']
    (found,) = partners.check_topics(
        _graph(husky_sim=waits, driver=[(Role.PUBLISHER, '/cmd_vel', twist)])
    )
    assert str(found).startswith('/a/cmd_vel, /b/cmd_vel, /c/cmd_vel: /husky_sim subscribes to')
    assert str(found).endswith('start /driver with `--ros-args -r /cmd_vel:=/a/cmd_vel`')


def test_a_name_that_others_hear_is_only_noted() -> None:
    scan = 'sensor_msgs/msg/LaserScan'
    (found,) = partners.check_topics(
        _graph(
            husky_sim=[(Role.PUBLISHER, '/front/scan', scan)],
            view=[(Role.SUBSCRIPTION, '/front/scan', scan)],
            follower=[(Role.SUBSCRIPTION, '/scan', scan)],
        )
    )
    assert not found.serious
    assert '/follower subscribes to this, but /husky_sim publishes /front/scan' in str(found)


def test_a_sensor_that_is_off_is_named_with_what_turns_it_on() -> None:
    scan = 'sensor_msgs/msg/LaserScan'
    (found,) = partners.check_topics(
        _graph(husky_sim=[], follower=[(Role.SUBSCRIPTION, '/front/scan', scan)])
    )
    assert str(found).startswith('/front/scan: /follower subscribes to this, but that sensor of')
    assert '`--ros-args -p lidar_rate_hz:=10.0`' in str(found)


def test_a_sensor_that_is_off_is_known_by_its_type_as_well() -> None:
    waits = [(Role.SUBSCRIPTION, '/scan', 'sensor_msgs/msg/LaserScan')]
    (found,) = partners.check_topics(_graph(husky_sim=[], follower=waits))
    assert not found.serious
    assert str(found).startswith(
        '/scan: /follower subscribes to this, sensor_msgs/msg/LaserScan, which nobody publishes '
        'under any name, because the laser of the simulator is off; start the simulator with `--'
    )
    assert not [*partners.check_topics(_graph(husky_sim=[], husky_view=waits))]
    assert not [*partners.check_topics(_graph(follower=waits))]


def test_ros2_topic_names_a_sensor_that_is_off() -> None:
    clause = topics.why_unknown(_graph(husky_sim=[]), '/front/scan')
    assert clause.startswith('; that sensor of the simulator is off: start the simulator with `--')
    assert topics.why_unknown(_graph(other=[]), '/front/scan') == ''


def test_a_service_that_nobody_offers_is_noted() -> None:
    client = (Role.CLIENT, '/count/_action/send_goal', 'my_msgs/action/Count_SendGoal')
    (found,) = partners.check_services(_graph(asks=[client]))
    assert not found.serious
    assert str(found).startswith('/count: /asks calls this, my_msgs/action/Count, which nobody')


def test_a_node_that_is_asked_for_its_parameters_under_another_name_is_one_line() -> None:
    services = {
        'get_parameters': 'rcl_interfaces/srv/GetParameters',
        'list_parameters': 'rcl_interfaces/srv/ListParameters',
    }
    offered = [(Role.SERVER, f'/talker/{name}', kind) for name, kind in services.items()]
    for asked, serious, what in (
        ('/talkerr', True, "which is not there; did you mean '/talker'?; start it, or give its"),
        ('/map_server', False, 'which is not there; start it, or give its name in full'),
    ):
        calls = [(Role.CLIENT, f'{asked}/{name}', kind) for name, kind in services.items()]
        (found,) = partners.check_services(_graph(talker=offered, asks=calls))
        assert found.serious == serious
        assert str(found).startswith(
            f'{asked}: /asks calls get_parameters, list_parameters of this node, {what}'
        )


def test_a_service_that_a_node_does_not_have_is_noted() -> None:
    call = (Role.CLIENT, '/talker/change_state', 'lifecycle_msgs/srv/ChangeState')
    (found,) = partners.check_services(_graph(talker=[], asks=[call]))
    assert not found.serious
    assert str(found) == (
        '/talker: /asks calls change_state of this node, which does not offer it; ask another one'
    )


def test_a_node_that_is_being_made_is_waited_for(monkeypatch: pytest.MonkeyPatch) -> None:
    made = _graph(husky_sim=[(Role.SUBSCRIPTION, '/cmd_vel', 'geometry_msgs/msg/Twist')])
    read = [Graph([], made.endpoints), made]
    monkeypatch.setattr(discovery, 'read_graph', lambda **_: read.pop(0))
    api.graph.cache_clear()
    try:
        assert api.graph() is made
    finally:
        api.graph.cache_clear()


def test_a_program_without_ros_never_is_a_node(monkeypatch: pytest.MonkeyPatch) -> None:
    made = _graph(plain=[(Role.SUBSCRIPTION, '/cmd_vel', 'geometry_msgs/msg/Twist')])
    monkeypatch.setattr(discovery, 'read_graph', lambda **_: Graph([], made.endpoints))
    monkeypatch.setattr(api, '_MADE_WITHIN_SEC', 0.0)
    api.graph.cache_clear()
    try:
        assert api.graph().endpoints == made.endpoints
    finally:
        api.graph.cache_clear()


def test_an_action_of_two_definitions_is_named_once(
    monkeypatch: pytest.MonkeyPatch, capsys: pytest.CaptureFixture[str]
) -> None:
    parts = {'send_goal': Role.SERVER, 'get_result': Role.SERVER, 'feedback': Role.PUBLISHER}
    used = {Role.SERVER: Role.CLIENT, Role.PUBLISHER: Role.SUBSCRIPTION}

    def told(*changed: str) -> list[str]:
        offers, calls = (
            [
                Endpoint(
                    f'{node}{part}'.encode(),
                    offered if node == 'server' else used[offered],
                    f'/count/_action/{part}',
                    f'my_msgs/action/Count_{part}',
                    f'RIHS01_{node if part in changed else "same"}',
                    _USUAL,
                )
                for part, offered in parts.items()
            ]
            for node in ('server', 'client')
        )
        nodes = [Node('server', '/', offers), Node('client', '/', calls)]
        monkeypatch.setattr(checks, 'graph', lambda: Graph(nodes, offers + calls))
        checks.Types().check()
        return [line.split(': ')[1] for line in capsys.readouterr().out.splitlines()]

    assert told() == []
    assert told(*parts) == ['/count']
    assert told('feedback', 'get_result') == ['/count/_action/feedback']
    assert told('get_result') == ['/count/_action/get_result']


def test_two_servers_of_one_service_are_told_of() -> None:
    def offers(node: str) -> list[tuple[Role, str, str]]:
        action = '/count/_action'
        return [
            (Role.SERVER, '/add', 'example_interfaces/srv/AddTwoInts'),
            (Role.SERVER, f'{action}/send_goal', 'my_msgs/action/Count_SendGoal'),
            (Role.SERVER, f'{action}/cancel_goal', 'action_msgs/srv/CancelGoal'),
            (Role.SERVER, f'/{node}/get_parameters', 'rcl_interfaces/srv/GetParameters'),
            (Role.SERVER, '/tf2_frames', 'tf2_msgs/srv/FrameGraph'),  # of each buffer
        ]

    calls = [(Role.CLIENT, '/add', 'example_interfaces/srv/AddTwoInts')]
    assert not [*nodes.check_servers(_graph(server=offers('server'), a=calls, b=calls))]
    (found,) = nodes.check_servers(_graph(server=offers('server'), old=offers('old'), a=calls))
    assert str(found).startswith('/add, /count: 2 nodes offer this: /old, /server, so that each')
