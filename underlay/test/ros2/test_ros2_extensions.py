# Copyright 2026 The Husky Playpen Lab authors
# SPDX-License-Identifier: Apache-2.0
"""Commands and verbs that other people's packages add, by upstream's entry points."""

from __future__ import annotations

from collections.abc import Callable
from pathlib import Path
import subprocess
import sys
from typing import Any

import pytest
from ros2cli.plugin_system import PLUGIN_SYSTEM_VERSION, PluginException, satisfies_version

_PROJECT = """
[build-system]
requires = ['flit_core']
build-backend = 'flit_core.buildapi'

[project]
name = 'greeter'
version = '1.2.3'
description = 'A command and verbs.'

[project.entry-points.'ros2cli.command']
greet = 'greeter:GreetCommand'
broken = 'greeter.broken:BrokenCommand'

[project.entry-points.'ros2greet.verb']
loudly = 'greeter:LoudlyVerb'

[project.entry-points.'ros2topic.verb']
praise = 'greeter:PraiseVerb'
"""
_MODULE = '''
from ros2cli.command import add_subparsers_on_demand, CommandExtension
from ros2cli.node.strategy import add_arguments, NodeStrategy
from ros2cli.verb import VerbExtension


class GreetCommand(CommandExtension):
    """Greet whoever is there."""

    def add_arguments(self, parser, cli_name):
        add_subparsers_on_demand(parser, cli_name, '_verb', 'ros2greet.verb', required=False)

    def main(self, *, parser, args):
        if not hasattr(args, '_verb'):
            parser.print_help()
            return 0
        return args._verb.main(args=args)


class LoudlyVerb(VerbExtension):
    """Greet in capitals."""

    def add_arguments(self, parser, cli_name):
        parser.add_argument('name')

    def main(self, *, args):
        print('HELLO', args.name.upper())
        return 3


class PraiseVerb(VerbExtension):
    """Praise every topic."""

    def add_arguments(self, parser, cli_name):
        add_arguments(parser)

    def main(self, *, args):
        with NodeStrategy(args) as node:
            for name, types in node.get_topic_names_and_types():
                print('good', name, types)
'''


@pytest.fixture(scope='module')
def installed(tmp_path_factory: pytest.TempPathFactory) -> Path:
    """Install a package with a command, a verb of it, a verb of `ros2 topic`, and a defect."""
    folder = tmp_path_factory.mktemp('greeter')
    source, target = folder / 'source', folder / 'target'
    (source / 'greeter').mkdir(parents=True)
    (source / 'pyproject.toml').write_text(_PROJECT)
    (source / 'greeter' / '__init__.py').write_text(_MODULE)
    (source / 'greeter' / 'broken.py').write_text('import no_such_module\n')
    pip = [sys.executable, '-m', 'pip', 'install', '--quiet', '--no-build-isolation', '--no-deps']
    subprocess.run([*pip, '--no-index', '--target', str(target), str(source)], check=True)
    return target


@pytest.fixture
def greeter(domain: int, installed: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    """Let Python find the package."""
    monkeypatch.setenv('PYTHONPATH', str(installed))


@pytest.mark.usefixtures('greeter')
def test_help_lists_commands_and_verbs_of_others(ros2: Callable[..., Any]) -> None:
    assert '\n  greet      Greet whoever is there.\n' in ros2('--help').out
    assert '\n  praise  Praise every topic.\n' in ros2('topic', '--help').out
    assert '\n  loudly  Greet in capitals.\n' in ros2('greet').out
    assert 'usage: ros2 topic praise' in ros2('topic', 'praise', '--help').out


@pytest.mark.usefixtures('greeter')
def test_extensions_tells_of_those_of_others_and_why_not(ros2: Callable[..., Any]) -> None:
    answer = ros2('extensions', '--all')
    assert {'ros2topic.verb', '  praise: Praise every topic'} <= set(answer.lines)
    assert "\n- broken: \n    reason: No module named 'no_such_module'\n" in answer.out
    assert '\nros2topic.verb: ' in ros2('extension_points').out


@pytest.mark.usefixtures('greeter')
def test_a_command_of_others_runs_its_verb(ros2: Callable[..., Any]) -> None:
    answer = ros2('greet', 'loudly', 'you')
    assert (answer.status, answer.out, answer.err) == (3, 'HELLO YOU\n', '')


@pytest.mark.usefixtures('greeter')
def test_a_verb_of_others_gets_a_node(ros2: Callable[..., Any], processes: Any) -> None:
    processes.node('talker', 'talker')
    answer = ros2('topic', 'praise', '--no-daemon')
    assert answer.status == 0
    assert "good /chatter ['std_msgs/msg/String']" in answer.lines


@pytest.mark.usefixtures('greeter')
def test_a_defect_of_others_leaves_the_rest(ros2: Callable[..., Any]) -> None:
    help_text = ros2('--help').out
    assert (
        "broken     cannot be loaded: ModuleNotFoundError: No module named 'no_such_" in help_text
    )
    assert '  topic ' in help_text
    answer = ros2('broken')
    assert answer.status == 1
    assert answer.err.startswith("ModuleNotFoundError: No module named 'no_such_module'")


def test_an_extension_for_another_version_is_refused() -> None:
    satisfies_version(PLUGIN_SYSTEM_VERSION, '^0.1')
    for other in ('^0.2', '^1.0'):
        with pytest.raises(PluginException, match=r'the interface has version 0\.1'):
            satisfies_version(PLUGIN_SYSTEM_VERSION, other)
    with pytest.raises(ValueError, match=r"a range begins with '\^'"):
        satisfies_version(PLUGIN_SYSTEM_VERSION, '0.1')
