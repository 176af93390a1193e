# Copyright 2026 The Husky Playpen Lab authors
# SPDX-License-Identifier: Apache-2.0
"""What the README and the pages of docs/ name is there; what the README shows is printed."""

from importlib import metadata
import json
from pathlib import Path
import re
import subprocess
import sys

from ament_index_python.packages import get_package_share_directory
from husky_grader.scoring.report import COLLISION_FACTOR, FULL_TRACKING_M
from playpen_testing.processes import Processes
from playpen_testing.which_ros import lacks
import pytest

ROOT = Path(__file__).resolve().parent.parent
README = (ROOT / 'README.md').read_text()
PAGES = [ROOT / 'README.md', *sorted((ROOT / 'docs').glob('*.md'))]
# What a measurement takes from a package that a sourced ROS may lack, or has never.
NEEDED = {'own_interfaces': 'colcon_rosidl_python', 'turtles': 'turtlesim'}
OF_STUDENTS = ('my_driver', 'my_pkg', 'odometer')
NUMBER = re.compile(r'\d+(?:\.\d+)?')
ARCHITECTURE = (ROOT / 'docs' / 'architecture.md').read_text()


@pytest.fixture(scope='module')
def executables() -> set[str]:
    """Return each package with each of its programs, as `ros2` lists them."""
    asked = ['ros2', 'pkg', 'executables']
    listed = subprocess.run(asked, capture_output=True, text=True, timeout=30.0)
    assert listed.returncode == 0, listed.stdout + listed.stderr
    return set(listed.stdout.splitlines())


@pytest.mark.parametrize('page', PAGES, ids=lambda page: page.name)
def test_every_link_leads_to_a_file(page: Path) -> None:
    links = re.findall(r'\]\(([^)#]+)\)|src="([^"]+)"', page.read_text())
    ours = [link or picture for link, picture in links if '://' not in link]
    assert ours, 'the page has links'
    assert [link for link in ours if not (page.parent / link).exists()] == []


@pytest.mark.parametrize('page', PAGES, ids=lambda page: page.name)
def test_every_program_and_launch_file_is_there(page: Path, executables: set[str]) -> None:
    text = page.read_text()
    programs = {p for p in re.findall(r'ros2 run (\w+ \w+)', text) if is_here(p.split()[0])}
    assert programs - executables == set()
    for package, file in re.findall(r'ros2 launch (\w+) (\S+\.launch\.\w+)', text):
        if is_here(package):
            assert (Path(get_package_share_directory(package)) / 'launch' / file).is_file(), file


def is_here(package: str) -> bool:
    """Tell whether a package must be there: a ROS that is sourced has only some of the others'."""
    ours = (ROOT / 'src' / package).is_dir()
    return package not in OF_STUDENTS and (ours or not lacks(package))


def test_every_word_of_the_lab_and_its_options_are_known(processes: Processes) -> None:
    shown = processes.start(str(ROOT / 'lab'), 'help')
    assert shown.wait(timeout_sec=10.0) == 0, shown.output
    lines = [line for line in README.splitlines() if './lab' in line]
    named = {word for line in lines for word in re.findall(r'\./lab (\w+)', line)}
    assert {'drive', 'test'} <= named
    assert {word for word in named if not re.search(rf'^  {word}\b', shown.output, re.M)} == set()
    options = {option for line in lines for option in re.findall(r'--[a-z][a-z-]+', line)}
    known = shown.output + (ROOT / 'src/husky_grader/husky_grader/grade.py').read_text()
    assert {option for option in options if option not in known} == set()


MEASUREMENTS = [
    file
    for file in sorted((ROOT / 'benchmark').glob('*.py'))
    if '__main__' in file.read_text() and not lacks(NEEDED.get(file.stem, 'rclpy'))
]
# They import much the same: in one process that is done once.
CALL_EACH = """
import contextlib, io, json, runpy, sys, traceback
called = {}
sys.path[0] = sys.argv[1]
for program in sys.argv[2:]:
    sys.argv, code = [program, '--no-such-option'], 0
    with contextlib.redirect_stderr(io.StringIO()) as said:
        try:
            runpy.run_path(program, run_name='__main__')
        except SystemExit as end:
            code = end.code
        except BaseException:
            code = traceback.print_exc()
    called[program] = code, said.getvalue()
json.dump(called, sys.stdout)
"""


@pytest.fixture(scope='module')
def called_wrongly() -> dict[str, tuple[int, str]]:
    """Return the exit status of each measurement for a wrong option, and what it says."""
    programs = [str(ROOT / 'benchmark'), *map(str, MEASUREMENTS)]
    done = subprocess.run(
        [sys.executable, '-c', CALL_EACH, *programs], capture_output=True, text=True, timeout=100.0
    )
    assert done.returncode == 0, done.stderr
    return dict(json.loads(done.stdout))


@pytest.mark.parametrize('measurement', MEASUREMENTS, ids=lambda measurement: measurement.stem)
def test_every_measurement_says_how_it_is_called(
    measurement: Path, called_wrongly: dict[str, tuple[int, str]]
) -> None:
    code, said = called_wrongly[str(measurement)]
    assert code == 2, said
    assert f'{measurement.name}: error: ' in said.splitlines()[-1]
    assert 'Traceback' not in said


def test_a_drive_prints_what_the_readme_shows(processes: Processes, tmp_path: Path) -> None:
    block = re.search(r'```\n(central_barrier: .*?)\n```', README, re.S)
    assert block is not None
    course = str(ROOT / 'config' / 'waypoints' / 'central_barrier.yaml')
    graded = processes.start(str(ROOT / 'lab'), 'grade', course, '--report', str(tmp_path))
    assert graded.wait(timeout_sec=60.0) == 0, graded.output
    shown, printed = block[1].splitlines()[:-2], graded.lines[:-1]
    words = [[NUMBER.sub('#', line) for line in lines] for lines in (shown, printed)]
    assert words[0] == words[1]
    if metadata.version('mujoco') == '4.0.0':
        assert shown == printed
    # Another version of MuJoCo drives a little differently.
    values = [
        [float(n) for line in lines for n in NUMBER.findall(line)] for lines in (shown, printed)
    ]
    assert values[1] == pytest.approx(values[0], rel=0.05, abs=0.01)


def test_the_lab_sheet_tells_what_the_score_is_made_of() -> None:
    sheet = (ROOT / 'docs' / 'lab_sheet.md').read_text()
    assert (
        f'each touch costs {1 - COLLISION_FACTOR:.0%} of what is left'.replace('%', ' %') in sheet
    )
    assert f'| tracking | less than {FULL_TRACKING_M:.2f} m off the path on average' in sheet


def test_the_architecture_names_every_module_and_dependency() -> None:
    named = set(re.findall(r'`([\w.-]+)', ARCHITECTURE))
    named |= {word for name in named for word in name.split('.')}
    parts = {
        part.stem
        for package in ROOT.glob('src/*/package.xml')
        for part in (package.parent / package.parent.name).iterdir()
        if (part / '__init__.py').is_file() or (part.suffix == '.py' and part.stem != '__init__')
    }
    assert len(parts) > 80
    assert parts - named == set()
    asked: set[str] = set()
    for file in ROOT.glob('requirements/*.in'):
        asked |= set(re.findall(r'^[a-zA-Z][\w-]*', file.read_text(), re.M))
    for setup in ROOT.glob('src/*/setup.py'):
        for wanted in re.findall(r'install_requires=\[([^]]*)', setup.read_text()):
            asked |= set(re.findall(r"'([\w-]+)'", wanted))
    assert len(asked) > 40
    assert {name for name in asked - named if not re.fullmatch(r'ros-\w+-msgs', name)} == set()
