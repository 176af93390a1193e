# Copyright 2026 The Husky Playpen Lab authors
# SPDX-License-Identifier: Apache-2.0
"""
What docs/computers.md offers beside the wheels is well-formed, and calls what there is.

Neither pixi nor an image of a container can be had by every test: these files are read, and of
what is a shell's in them the words are run.
"""

from importlib import import_module
import json
import os
from pathlib import Path
import re
import subprocess
import sys
from typing import Any
import xml.etree.ElementTree as ElementTree

from husky_grader.drive_page import FIRST_PORT
import pytest
import yaml

ROOT = Path(__file__).resolve().parent.parent
WORKFLOW = ROOT / '.github' / 'workflows' / 'computers.yml'
DEVCONTAINERS = sorted(ROOT.glob('.devcontainer/**/devcontainer.json'))
README = (ROOT / 'README.md').read_text()
# containers.dev/implementors/json_reference, as far as it is used here.
DEVCONTAINER_KEYS = {
    *('name', 'build', 'remoteUser', 'forwardPorts', 'portsAttributes'),
    *('updateContentCommand', 'postAttachCommand'),
}
BUILD_KEYS = {'dockerfile', 'context', 'target', 'args'}


def pixi() -> dict[str, Any]:
    toml = import_module('tomllib' if sys.version_info >= (3, 11) else 'tomli')
    found: dict[str, Any] = toml.loads((ROOT / 'pixi.toml').read_text())
    return found


def words_of_the_lab() -> set[str]:
    done = subprocess.run([ROOT / 'lab', 'help'], capture_output=True, text=True, check=True)
    return set(re.findall(r'^  (\w+) ', done.stdout, re.M))


def instructions() -> list[tuple[str, str]]:
    """Return the instructions of the Containerfile, and what follows each."""
    text = (ROOT / 'Containerfile').read_text().replace('\\\n', ' ')
    lines = [line for line in text.splitlines() if line and not line.startswith('#')]
    return [(word, rest) for word, _, rest in (line.partition(' ') for line in lines)]


def test_pixi_has_the_tables_that_pixi_reads() -> None:
    manifest = pixi()
    assert set(manifest) == {'workspace', 'tasks', 'dependencies'}
    assert set(manifest['workspace']) == {'name', 'channels', 'platforms'}
    # Those of RoboStack's Jazzy on which bash, and signals as of POSIX, are.
    assert set(manifest['workspace']['platforms']) == {'linux-64', 'linux-aarch64', 'osx-arm64'}
    assert [channel.rsplit('/')[-1] for channel in manifest['workspace']['channels']] == [
        'robostack-jazzy',
        'conda-forge',
    ]
    names = manifest['dependencies']
    assert all(re.fullmatch(r'[a-z0-9][a-z0-9-]*', name) for name in names)
    assert all(re.fullmatch(r'\*|>=\d+|\d+\.\d+\.\*', version) for version in names.values())


def test_pixi_installs_what_the_packages_name() -> None:
    ours = {path.parent.name for path in ROOT.glob('src/*/package.xml')}
    named = {
        str(entry.text)
        for path in ROOT.glob('src/*/package.xml')
        for entry in ElementTree.parse(path).getroot().iter('exec_depend')
    }
    # What python3- begins comes from pip, into .venv.
    wanted = {name for name in named - ours if not name.startswith('python3-')}
    assert len(wanted) > 15
    ros = {f'ros-jazzy-{name.replace("_", "-")}' for name in wanted}
    assert ros - set(pixi()['dependencies']) == set()


def test_the_tasks_of_pixi_are_words_of_the_lab() -> None:
    tasks = pixi()['tasks']
    assert {'drive', 'test'} <= set(tasks)
    for name, task in tasks.items():
        assert set(task) == {'cmd', 'description'}
        assert task['cmd'] == f'./lab {name}'
        assert name in words_of_the_lab()


@pytest.mark.parametrize('file', DEVCONTAINERS, ids=lambda file: file.parent.name)
def test_a_devcontainer_drives_in_its_first_terminal(file: Path) -> None:
    given = json.loads(file.read_text())
    assert set(given) <= DEVCONTAINER_KEYS
    assert set(given['build']) <= BUILD_KEYS
    assert (file.parent / given['build']['dockerfile']).resolve() == ROOT / 'Containerfile'
    assert (file.parent / given['build']['context']).resolve() == ROOT
    stages = [rest.partition(' AS ')[2] for word, rest in instructions() if word == 'FROM']
    assert given['build']['target'] in stages
    arguments = {rest.partition('=')[0] for word, rest in instructions() if word == 'ARG'}
    assert set(given['build'].get('args', {})) <= arguments
    assert given['forwardPorts'] == [FIRST_PORT]
    assert set(given['portsAttributes']) == {str(FIRST_PORT)}
    for key, word in (('updateContentCommand', 'exec true'), ('postAttachCommand', 'drive')):
        command = given[key]
        assert (command if isinstance(command, str) else command[-1]).endswith(f'./lab {word}')


def test_there_is_a_devcontainer_for_either_processor() -> None:
    bases = [json.loads(file.read_text())['build'].get('args', {}) for file in DEVCONTAINERS]
    assert bases == [{'BASE': 'docker.io/library/ros:jazzy-ros-base'}, {}]


def test_the_container_ends_in_a_working_lab(tmp_path: Path) -> None:
    lines = instructions()
    known = {'ARG', 'FROM', 'RUN', 'COPY', 'USER', 'WORKDIR', 'ENTRYPOINT', 'CMD'}
    assert {word for word, _ in lines} == known
    assert [word for word, _ in lines][:2] == ['ARG', 'FROM']
    last = dict(lines)
    assert last['CMD'] == '["drive"]'
    assert last['USER'] == 'ubuntu'
    # The set-up is a part of the image; both it and what is started run here, too.
    for command in (json.loads(last['RUN']), [*json.loads(last['ENTRYPOINT']), 'help']):
        done = subprocess.run(command, cwd=ROOT, capture_output=True, text=True)
        assert done.returncode == 0, done.stderr
    assert done.stdout.startswith('Usage: ./lab')
    for word, rest in lines:
        if word == 'RUN' and not rest.startswith('['):
            checked = subprocess.run(['bash', '-n', '-c', rest], capture_output=True, text=True)
            assert checked.returncode == 0, checked.stderr


def test_nothing_that_was_made_here_gets_into_an_image() -> None:
    made, left_out = (
        {line.strip('/').removeprefix('**/') for line in (ROOT / name).read_text().splitlines()}
        for name in ('.gitignore', '.dockerignore')
    )
    small = {'.hypothesis', '.pytest_cache', '.venv-setup.log', '.build.log'}
    assert made - left_out == small
    assert '.git' in left_out


def test_the_workflow_is_one_that_github_takes() -> None:
    check = ['-m', 'check_jsonschema', '--builtin-schema', 'vendor.github-workflows']
    done = subprocess.run([sys.executable, *check, str(WORKFLOW)], capture_output=True, text=True)
    assert done.returncode == 0, done.stdout + done.stderr


def test_the_workflow_runs_both_commands_of_the_readme_on_every_computer(tmp_path: Path) -> None:
    job = yaml.safe_load(WORKFLOW.read_text())['jobs']['lab']
    computers = {each['computer']: each['by'] for each in job['strategy']['matrix']['include']}
    assert computers == {
        'ubuntu-24.04': '',
        'ubuntu-24.04-arm': 'pixi run',
        'macos-15': 'pixi run',
    }
    for name in ('lab', 'pixi'):
        (tmp_path / name).write_text(f'#!/bin/sh\necho {name} "$@"\n')
        (tmp_path / name).chmod(0o755)
    path = f'{tmp_path}{os.pathsep}{os.environ["PATH"]}'
    shell = ['bash', '--noprofile', '--norc', '-eo', 'pipefail', '-c']
    for by, called in (('', 'lab'), ('pixi run', 'pixi run')):
        ran = [
            subprocess.run(
                [*shell, step['run']],
                cwd=tmp_path,
                env={'PATH': path, 'RUN': by},
                capture_output=True,
                text=True,
                check=True,
            ).stdout
            for step in job['steps']
            if step.get('name') in ('Drive', 'Test')
        ]
        assert ran == [f'{called} drive\n', f'{called} test\n']
    assert re.findall(r'^\./lab (\w+)  ', README, re.M)[:2] == ['drive', 'test']
