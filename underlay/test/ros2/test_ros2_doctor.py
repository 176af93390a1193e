# Copyright 2026 The Husky Playpen Lab authors
# SPDX-License-Identifier: Apache-2.0
"""Each fault about which ROS is silent is brought about here, and the line about it is read."""

from __future__ import annotations

from collections.abc import Callable
import os
from pathlib import Path
import shutil
import subprocess
import sys
from typing import Any

from playpen_testing.processes import find_line
from playpen_testing.waiting import wait_until
import pytest
from ros2_diagnosis import command_lines, nodes, ros_arguments
from ros2_diagnosis.command_lines import CommandLine
from ros2_doctor_checks import parameters
from ros2doctor import api
from rtps_graph.graph import Endpoint, Graph, Node, Qos, Role


def test_nothing_is_wrong_with_two_nodes_that_talk(
    processes: Any, ros2: Callable[..., Any], tmp_path: Path
) -> None:
    processes.node('talker', 'talker')
    processes.node('listener', 'listener')
    answer = ros2('doctor', folder=tmp_path)
    assert not [line for line in answer.lines if line.startswith('problem')], answer
    assert answer.status == 0
    assert 'All 20 checks passed' in answer.lines


def test_different_types_on_one_topic(processes: Any, ros2_here: Callable[..., Any]) -> None:
    processes.node('stamped_driver', 'driver')
    processes.node('robot', 'husky')
    answer = ros2_here('doctor')
    assert answer.status == 0  # as upstream
    line = answer.of_check('types')
    assert '/driver publishes geometry_msgs/msg/TwistStamped' in line
    assert '/husky subscribes to geometry_msgs/msg/Twist, so that nothing arrives' in line
    assert 'use one type in both' in line
    assert 'Failed modules: types' in answer.lines


def test_different_types_on_one_service(processes: Any, ros2_here: Callable[..., Any]) -> None:
    processes.node('service', 'server')
    hint = (
        '/flip: /server offers std_srvs/srv/SetBool, but a `ros2` command calls '
        'std_srvs/srv/Trigger, so that no call arrives; use one type in both'
    )
    processes.ros2('service', 'call', '/flip', 'std_srvs/srv/Trigger', ready=f'hint: {hint}')
    assert hint in ros2_here('doctor').of_check('types')


def test_quality_of_service_that_does_not_fit(
    processes: Any, ros2_here: Callable[..., Any]
) -> None:
    processes.node('best_effort', 'sensor')
    processes.node('listener', 'listener')
    answer = ros2_here('doctor', '--report-failed')
    assert 'Failed modules: middleware' in answer.lines
    assert '   QOS COMPATIBILITY LIST' in answer.lines
    assert 'ERROR: Best effort publisher and reliable subscription;' in answer.out
    line = answer.of_check('qos')
    assert '/sensor offers BEST_EFFORT, but /listener requests RELIABLE' in line
    assert 'reliability=ReliabilityPolicy.BEST_EFFORT' in line


def test_a_kept_message_that_a_late_reader_does_not_ask_for(
    processes: Any, ros2_here: Callable[..., Any]
) -> None:
    processes.node('hears_later', 'early')
    processes.node('latched', 'map_server')
    assert ' (qos): ' not in ros2_here('doctor').out
    processes.node('hears_later', 'late')
    answer = ros2_here('doctor')
    line = answer.of_check('qos')
    assert line.startswith('note (qos): /latched: /late began ')
    assert ' s after the newest message was sent, which is kept for who asks for' in line
    assert line.endswith('(depth=1, durability=DurabilityPolicy.TRANSIENT_LOCAL)`')


def test_two_names_for_one_topic(processes: Any, ros2_here: Callable[..., Any]) -> None:
    processes.node('robot', 'husky')
    processes.node('slow_driver', 'driver', '--ros-args', '-r', 'cmd_vel:=speeds')
    line = ros2_here('doctor').of_check('partners')
    assert line.startswith(
        'problem (partners): /cmd_vel: /husky subscribes to this, but /driver publishes /speeds, '
        'of one type, geometry_msgs/msg/Twist, so that nothing arrives; use one name in both, or '
    )
    assert line.endswith('`--ros-args -r /speeds:=/cmd_vel`') or line.endswith(
        '`--ros-args -r /cmd_vel:=/speeds`'
    )
    processes.ros2(
        *('topic', 'echo', '/sped', 'geometry_msgs/msg/Twist'),
        ready='hint: /sped: a `ros2` command subscribes to this, but /driver publishes /speeds, ',
    )


def test_two_names_for_one_service(processes: Any, ros2_here: Callable[..., Any]) -> None:
    processes.node('service', 'server')
    processes.ros2(
        'service', 'call', '/flop', 'std_srvs/srv/SetBool', ready="nobody offers '/flop'"
    )
    line = ros2_here('doctor').of_check('partners')
    assert 'a `ros2` command calls this, but /server offers /flip, of one type' in line
    assert line.endswith('use one name in both')


def test_simulation_time_without_a_clock(processes: Any, ros2_here: Callable[..., Any]) -> None:
    processes.node('plain', 'waits', '--ros-args', '-p', 'use_sim_time:=true')
    line = ros2_here('wtf').of_check('clock')
    assert '/waits: use_sim_time is true, but nobody publishes /clock' in line
    assert '`ros2 param set /waits use_sim_time false`' in line


def test_words_that_stand_behind_no_ros_args(
    processes: Any, ros2_here: Callable[..., Any]
) -> None:
    processes.node('plain', 'first', '-p', 'rate:=5.0', '--ros-args', '-r', '__node:=one')
    processes.node('plain', 'second', 'rate:=5.0')
    in_launch = 'in a launch file, `parameters` or `remappings` of its Node'
    why = 'ROS takes parameters and other names behind --ros-args alone'
    answer = ros2_here('doctor')
    assert sorted(line for line in answer.lines if ' (parameters): ' in line) == [
        f'problem (parameters): nodes.py -p rate:=5.0: {why}; write '
        f'`nodes.py --ros-args -p rate:=5.0`; {in_launch}',
        f'problem (parameters): nodes.py rate:=5.0: {why}; write `--ros-args -p rate:=5.0` for a '
        f'parameter, `--ros-args -r rate:=5.0` for another name; {in_launch}',
    ], answer


def test_words_behind_no_ros_args_are_told_of_students_programs(
    monkeypatch: pytest.MonkeyPatch,
) -> None:
    node = Node('hello', '/', [])

    def told(file: str, *, students: bool) -> list[str]:
        line = CommandLine(
            file=Path(file), folder=Path(), words=('-p', 'rate:=5.0'), nodes=(node,)
        )
        monkeypatch.setattr(ros_arguments, 'is_of_a_student', lambda _: students)
        monkeypatch.setattr(command_lines, 'with_nodes_in', lambda _: [line])
        return [str(each) for each in parameters.check_parameters(Graph([node], []))]

    (of_package,) = told('/install/mine/lib/mine/hello', students=True)
    assert 'write `ros2 run mine hello --ros-args -p rate:=5.0`' in of_package
    (of_file,) = told('/home/me/hello.py', students=False)
    assert 'write `hello.py --ros-args -p rate:=5.0`' in of_file
    assert not told('/install/husky_sim/lib/husky_sim/husky_sim', students=False)
    assert not told('/usr/bin/hello', students=True)


def test_options_that_set_and_rename_nothing(
    processes: Any, ros2_here: Callable[..., Any], tmp_path: Path
) -> None:
    file = tmp_path / 'parameters.yaml'
    file.write_text(
        '/**: {ros__parameters: {command_timeout_sec: 0.5, use_sim_time: false, deep: {er: 1}}}\n'
        'owner: {ros__parameters: {speed: 0.7}}\n'
        'robots: {husk: {ros__parameters: {a: 1, b: 2}}}\n'
    )
    other = tmp_path / 'other.yaml'
    other.write_text('owner: {ros__parameters: {speed: 0.7}}\n')
    processes.node(
        *('robot', 'husky', '--ros-args', '-p', 'command_timeot_sec:=1.0', '-p', 'speed:=1.0'),
        *('-p', 'husky:command_timeout_sec:=1.0', '--params-file', str(file)),
        *('--params-file', str(other), '-r', '/tf:=tf', '-r', 'scan:=front/scan'),
        *('-r', 'cmd_vl:=speeds', '-r', '~/get_parameters:=got'),
    )
    # This one has the parameter of that name, and the file is for it, too.
    processes.node('parameters', 'owner', '--ros-args', '--params-file', str(file))
    processes.node('count', 'counter', '--ros-args', '-r', 'count:=total')
    # As the programs of the wheels' ROS are started.
    module = ('-u', '-m', 'demo_nodes_py.topics.talker')
    processes.start(
        sys.executable, *module, '--ros-args', '-r', 'chater:=said', ready='Publishing'
    )
    answer = ros2_here('doctor')
    found = [line for line in answer.lines if ' (parameters): ' in line]
    assert found == [
        f'problem (parameters): nodes.py --params-file {file}: deep.er sets nothing: no node that '
        "it is for has such a parameter; call declare_parameter('deep.er', ...) in the node, or "
        'mend the name',
        'problem (parameters): nodes.py -p command_timeot_sec:=1.0: command_timeot_sec sets '
        'nothing: no node that it is for has such a parameter; call '
        "declare_parameter('command_timeot_sec', ...) in the node, or mend the name; did you mean "
        "'command_timeout_sec'?",
        'problem (parameters): nodes.py -p speed:=1.0: speed sets nothing: no node that it is for '
        "has such a parameter; call declare_parameter('speed', ...) in the node, or mend the name",
        f'problem (parameters): nodes.py --params-file {other}: what it gives to /owner sets '
        "nothing, because no such node is given it; name one that is, or '/**' for all; there is "
        '/husky',
        f'note (parameters): nodes.py --params-file {file}: what it gives to /robots/husk sets '
        "nothing, because no such node is given it; name one that is, or '/**' for all; there is "
        '/husky, /owner',
    ], answer
    assert {line for line in answer.lines if ' (remappings): ' in line} == {
        'note (remappings): nodes.py -r scan:=front/scan: renames nothing: /husky has no /scan; '
        'mend the name; there is /cmd_vel',
        'problem (remappings): nodes.py -r cmd_vl:=speeds: renames nothing: /husky has no '
        "/cmd_vl; mend the name; did you mean '/cmd_vel'?",
        'problem (remappings): demo_nodes_py.topics.talker -r chater:=said: renames nothing: '
        "/talker has no /chater; mend the name; did you mean '/chatter'?",
        'problem (remappings): nodes.py -r count:=total: renames nothing: /count of /counter is '
        'an action, of which Jazzy renames parts alone; name each part, as `-r '
        '/count/_action/send_goal:=NEW/_action/send_goal`, and so cancel_goal, get_result, '
        'feedback and status',
    }, answer


def test_a_command_that_waits_for_the_clock_is_told_its_option() -> None:
    qos = Qos(True, False, None, None, False, None)
    clock = Endpoint(b'1', Role.SUBSCRIPTION, '/clock', 'rosgraph_msgs/msg/Clock', '', qos)
    command = Node('_ros2cli_7', '/', [clock])
    (finding,) = nodes.check_clock(Graph([command], [clock]))
    assert str(finding).startswith('a `ros2` command: use_sim_time is true, but')
    assert str(finding).endswith('start the simulator, or leave out --use-sim-time')
    (finding,) = nodes.check_clock(Graph([command, Node('rosbag2_player', '/', [])], [clock]))
    assert str(finding).endswith('; play the bag with --clock, or leave out --use-sim-time')


def test_transforms_without_the_time_of_the_simulation(
    processes: Any, ros2_here: Callable[..., Any]
) -> None:
    processes.node('simulator', 'husky')
    processes.node('transforms', 'looks')
    line = ros2_here('doctor').of_check('clock')
    assert line.startswith(
        'note (clock): /looks: use_sim_time is false, while /tf has the time of'
    )
    assert '`--ros-args -p use_sim_time:=true`' in line
    processes.node('transforms', 'heeds', '--ros-args', '-p', 'use_sim_time:=true')
    assert '/heeds' not in ros2_here('doctor').of_check('clock')


def test_two_nodes_of_one_name(processes: Any, ros2_here: Callable[..., Any]) -> None:
    processes.node('plain', 'twin')
    processes.node('plain', 'twin')
    line = ros2_here('doctor').of_check('names')
    assert '/twin: 2 nodes have this name' in line
    assert '-r __node:=twin_2' in line
    assert 'share an exact name' in ros2_here('node', 'list').err


def test_two_simulators_are_told_to_part(processes: Any, ros2_here: Callable[..., Any]) -> None:
    processes.node('simulator', 'husky')
    assert not [line for line in ros2_here('doctor').lines if ' (publishers): ' in line]
    processes.node('simulator', 'fake')
    line = ros2_here('doctor').of_check('publishers')
    assert '/clock, /odometry/filtered: 2 nodes publish this: /fake, /husky' in line
    assert 'end one (Ctrl-C in its terminal), or give one its own ROS_DOMAIN_ID' in line


def test_two_simulators_of_one_name_are_told_to_part(
    processes: Any, ros2_here: Callable[..., Any]
) -> None:
    processes.node('simulator', 'husky')
    processes.node('simulator', 'husky')
    answer = ros2_here('doctor')
    assert '2 nodes publish this: /husky, /husky' in answer.of_check('publishers')
    assert '__node:=' not in answer.out
    assert 'give one its own ROS_DOMAIN_ID' in answer.of_check('names')


def test_two_drivers_of_one_robot(processes: Any, ros2_here: Callable[..., Any]) -> None:
    processes.node('slow_driver', 'driver')
    processes.node('slow_driver', 'other')
    answer = ros2_here('doctor')
    assert '/cmd_vel: 2 nodes publish this: /driver, /other' in answer.of_check('publishers')
    assert 'note: Publisher without subscriber detected on /cmd_vel' in answer.err


def test_a_node_that_makes_its_publisher_in_each_callback(
    processes: Any, ros2_here: Callable[..., Any]
) -> None:
    processes.node('robot', 'husky')
    processes.node('wasteful_driver', 'driver')
    assert ros2_here('doctor').of_check('publishers') == (
        'problem (publishers): /driver: has 12 clients of /count, 12 publishers of /cmd_vel, as '
        'one that makes another in each callback: all of them stay, and of the newest nobody '
        'knows yet when it is used; make each once, in __init__, and use it again'
    )


@pytest.mark.parametrize(
    ('lockstep', 'why'),
    [
        ('true', 'waits for the answer to its odometry, because its parameter `lockstep` is true'),
        ('false', 'tells no new time'),
    ],
)
def test_a_clock_that_stands_still(
    lockstep: str, why: str, processes: Any, ros2_here: Callable[..., Any]
) -> None:
    processes.node('waiting_simulator', 'husky', '--ros-args', '-p', f'lockstep:={lockstep}')
    line = ros2_here('doctor').of_check('clock')
    assert f'/clock: stands still: /husky {why}, so that timers and sleeps' in line


def test_commands_slower_than_the_timeout(processes: Any, ros2_here: Callable[..., Any]) -> None:
    processes.node('robot', 'husky')
    processes.node('slow_driver', 'driver')
    told: list[str] = []

    def twice_a_second() -> bool:  # asked again, for on a busy machine a command comes late
        told.append(ros2_here('doctor').of_check('commands'))
        return '/cmd_vel: commands come up to 0.5' in told[-1]

    wait_until(twice_a_second, timeout_sec=40.0, what=lambda: f'0.5 s apart: {told}')
    line = told[-1]
    assert '/husky stops the robot 0.25 s after the last one' in line
    assert 'publish at least 6 times a second' in line


def test_a_workspace_not_built_not_sourced_or_out_of_date(
    sources: Path, ros2: Callable[..., Any], tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    answer = ros2('doctor', folder=tmp_path)
    assert 'package' in answer.lines[-1].removeprefix('Failed modules: ').split()
    line = answer.of_check('workspace')
    assert f'mine: not built yet in {tmp_path}' in line
    assert f'run `colcon build` in {tmp_path}' in line

    colcon = shutil.which('colcon')
    assert colcon
    subprocess.run([colcon, 'build'], cwd=tmp_path, check=True, capture_output=True)
    line = ros2('doctor', folder=sources).of_check('workspace')
    assert f'mine: built in {tmp_path}, but not sourced in this terminal' in line
    assert f'`source {tmp_path}/install/setup.bash`' in line

    prefixes = [str(tmp_path / 'install' / 'mine'), os.environ['AMENT_PREFIX_PATH']]
    monkeypatch.setenv('AMENT_PREFIX_PATH', os.pathsep.join(prefixes))
    (modules,) = tmp_path.glob('install/mine/lib/python3*/site-packages')
    monkeypatch.setenv('PYTHONPATH', f'{os.environ.get("PYTHONPATH", "")}{os.pathsep}{modules}')
    assert not [x for x in ros2('doctor', folder=tmp_path).lines if '(workspace)' in x]

    (sources / 'mine' / 'mine' / 'hello.py').write_text('def main():\n    print("changed")\n')
    line = ros2('doctor', folder=tmp_path).of_check('workspace')
    assert 'hello.py has changed since the package was built, so that the old one runs' in line
    assert f'run `colcon build --packages-select mine` in {tmp_path}' in line
    ran = ros2('run', 'mine', 'hello')
    assert ran.err.startswith('hint: mine: ')
    assert ran.out == 'Hi from mine.\n'

    # One that others import, or that runs by `python3 -m mine`, needs no entry point.
    for name in ('wheels', 'motors', '__main__'):
        (sources / 'mine' / 'mine' / f'{name}.py').write_text('def main():\n    pass\n')
    (sources / 'mine' / 'mine' / 'hello.py').write_text(
        'from mine import motors\nfrom . import (\n    motors as m,\n    wheels,\n)\n'
        'def main():\n    print(m, wheels, motors)\n'
    )
    told = 'subscriber.py has a main(), but no entry point'
    assert not [x for x in ros2('doctor', folder=tmp_path).lines if told[13:] in x]
    (sources / 'mine' / 'mine' / 'subscriber.py').write_text('def main():\n    pass\n')
    assert any(told in line for line in ros2('doctor', folder=tmp_path).lines)
    for name in ('subscriber', 'subscriber.py'):
        refused = ros2('run', 'mine', name)
        assert told in refused.err
        assert "add 'subscriber = mine.subscriber:main' to 'console_scripts'" in refused.err
        assert refused.status == 1


def test_echo_says_why_nothing_comes(processes: Any) -> None:
    processes.node('best_effort', 'sensor')
    words = ('topic', 'echo', '/chatter', '--qos-reliability', 'reliable')
    processes.ros2(*words, ready='hint: /chatter: /sensor offers BEST_EFFORT')
    quiet = ('topic', 'echo', '/quiet', 'std_msgs/msg/String')
    processes.ros2(*quiet, ready='hint: /quiet: nobody publishes it')


def test_pub_says_why_nobody_hears(processes: Any, ros2_here: Callable[..., Any]) -> None:
    processes.node('robot', 'husky')
    words = ('/cmd_vel', 'geometry_msgs/msg/TwistStamped')
    answer = ros2_here('topic', 'pub', '-t', '1', '-w', '1', '--max-wait-time-secs', '0.5', *words)
    assert '/husky subscribes to geometry_msgs/msg/Twist' in answer.err
    assert 'Timed out waiting for subscribers' in answer.err


def test_a_node_that_waits_in_a_callback_is_named(
    processes: Any, ros2_here: Callable[..., Any]
) -> None:
    processes.node('talker', 'talker')
    processes.node('waiting', 'waiter', '--ros-args', '-p', 'speed:=1.0')
    words = ('service', 'call', '/flip', 'std_srvs/srv/SetBool')
    call = processes.ros2(*words)
    answer = ros2_here('doctor')
    assert ' (parameters): ' not in answer.out, 'it may have that parameter'
    line = answer.of_check('answers')
    assert '/waiter: answers nothing: it does not spin, or one of its callbacks' in line
    assert 'talker' not in line
    find_line(call.stdout, "hint: '/flip' gave no answer within 5 s; its node is busy or stopped")


def test_a_node_that_sleeps_in_a_callback_is_named(
    processes: Any, ros2_here: Callable[..., Any]
) -> None:
    processes.node('talker', 'talker')
    processes.node('sleeping', 'sleeper')
    line = ros2_here('doctor').of_check('answers')
    assert line.startswith('note (answers): /sleeper: answers after ')
    assert 's: one of its callbacks takes long, and the others wait; use a timer in the' in line


def test_the_report_names_the_essentials(processes: Any, ros2: Callable[..., Any]) -> None:
    processes.node('talker', 'talker')
    answer = ros2('doctor', '--report')
    assert answer.status == 0
    shown = [tuple(part.strip() for part in line.split(': ', 1)) for line in answer.lines]
    for pair in (
        ('distribution name', 'jazzy'),
        ('middleware name', 'rmw_fastrtps_cpp'),
        ('node', '/talker'),
        ('topic', '/chatter'),
        ('subscriber count', '0'),
    ):
        assert pair in shown
    assert [name for name, *_ in shown if name == 'rclpy']


def test_a_check_that_fails_to_load_takes_no_other_away(
    monkeypatch: pytest.MonkeyPatch, capsys: pytest.CaptureFixture[str]
) -> None:
    known = {'broken': 'ros2doctor.nothing:Check', 'range': 'ros2_doctor_checks.checks:Workspace'}
    monkeypatch.setattr(api, 'entry_points', lambda _: known)
    assert api.run_checks(include_warnings=False, exclude_packages=True) == (set(), 0, 0)
    monkeypatch.chdir('/')
    assert api.run_checks() == (set(), 0, 1)
    assert capsys.readouterr().err.count("note: 'broken' of ros2 doctor fails: ModuleNot") == 2


def test_hello_counts_what_was_said(domain: int, ros2: Callable[..., Any]) -> None:
    lines = ros2('doctor', 'hello', '--once').lines
    assert 'Topic: /canyouhearme, Published Msg Count: 1' in lines
    assert 'Multicast Group/Port: 225.0.0.1/49150, Sent Msg Count: 1' in lines
