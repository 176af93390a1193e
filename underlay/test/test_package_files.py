# Copyright 2026 The Husky Playpen Lab authors
# SPDX-License-Identifier: Apache-2.0
"""What colcon would misread in a package, or end at with a traceback, is told in a line."""

from __future__ import annotations

from pathlib import Path
import shutil
import subprocess
import sys

from playpen_testing.talk_package import BUILD_TYPE, FILES, replace, write_package
import pytest
from ros2_diagnosis import package_files, PackageError, packages, setup_py, workspaces

CATKIN = '<buildtool_depend>catkin</buildtool_depend>'


@pytest.fixture
def folder(tmp_path: Path) -> Path:
    return write_package(tmp_path / 'src' / 'talk')


def test_nothing_is_wrong_with_what_builds(folder: Path) -> None:
    two_groups = "={\n        'talk.plugin': ['hello = talk.hello:Plugin'],"
    replace(folder / 'setup.py', '={', two_groups)
    assert package_files.why_refused(folder) == []
    for encoded in (lambda text: '\ufeff' + text, lambda text: text.replace('\n', '\r\n')):
        for name in ('package.xml', 'setup.py'):
            (folder / name).write_bytes(encoded(FILES[name]).encode())
        assert package_files.why_refused(folder) == []
    (folder / 'setup.cfg').unlink()
    assert package_files.why_refused(folder) == []
    assert list(setup_py.broken_programs(folder, 'talk')) == []


@pytest.mark.parametrize(
    ('old', 'new'),
    [
        (FILES['setup.py'], 'from talk.of_ours import set_up\n\nset_up()\n'),
        ('\nsetup(', "\nopen('made.xml', 'w').close()\nsetup("),
        ("= 'talk'", "= 'talk'\nexec(open('about.py').read())\nprint(VERSION)"),
        ('    entry_points', "    cmdclass={'build': 'makes_files'},\n    entry_points"),
        ('\nsetup(', '\ntry:\n    odd()\nexcept NameError:\n    pass\nsetup('),
        ('\nsetup(', '\ntry:\n    import odd\nexcept ImportError:\n    open("made.xml")\nsetup('),
        ('find_packages, setup', '*\nmake()'),
    ],
)
def test_what_is_not_certain_colcon_shall_try(folder: Path, old: str, new: str) -> None:
    replace(folder / 'setup.py', old, new)
    if old != FILES['setup.py']:
        replace(folder / 'setup.py', "['package.xml']", "['made.xml']")
    assert package_files.why_refused(folder) == []


def test_programs_elsewhere_and_folders_that_are_packages_are_not_complained_of(
    folder: Path,
) -> None:
    below = folder / 'talk' / 'below'
    below.mkdir()
    (below / '__init__.py').write_text('def main():\n    pass\n')
    names = "'hello = talk.hello:main', 'tool = json.tool:main', 'below = talk.below:main'"
    replace(folder / 'setup.py', "'hello = talk.hello:main'", names)
    assert [*setup_py.broken_programs(folder, 'talk')] == []
    assert setup_py.left_out(folder, 'talk') == {}
    # Which asks for no __init__.py.
    text = (folder / 'setup.py').read_text()
    (folder / 'setup.py').write_text(text.replace('find_packages', 'find_namespace_packages'))
    (folder / 'talk' / '__init__.py').unlink()
    (below / '__init__.py').rename(below / 'program.py')
    replace(folder / 'setup.py', 'talk.below:', 'talk.below.program:')
    assert [*setup_py.broken_programs(folder, 'talk')] == []
    assert setup_py.left_out(folder, 'talk') == {}


@pytest.mark.parametrize('name', ['package.xml', 'setup.cfg', 'setup.py'])
@pytest.mark.parametrize(
    ('encoding', 'reason'),
    [('utf-16', ' is saved as UTF-16'), ('latin-1', ':1: byte 0xfc is no UTF-8')],
)
def test_another_encoding_is_named(folder: Path, name: str, encoding: str, reason: str) -> None:
    (folder / name).write_bytes(f'# für\n{FILES[name]}'.encode(encoding))
    (told,) = package_files.why_refused(folder)
    assert told.startswith(name + reason)


@pytest.mark.parametrize(
    ('name', 'before', 'line'),
    [('package.xml', '  <license>', 7), ('setup.cfg', '[install]', 3), ('setup.py', 'setup(', 5)],
)
def test_a_merge_conflict_is_told(folder: Path, name: str, before: str, line: int) -> None:
    ours = f'<<<<<<< HEAD\n# ours\n=======\n# theirs\n>>>>>>> theirs\n{before}'
    replace(folder / name, f'\n{before}', f'\n{ours}')
    assert package_files.why_refused(folder) == [
        f'{name}:{line}: a merge conflict of git begins here: keep one of its two sides, and '
        'remove the lines that begin with <<<<<<<, ======= and >>>>>>>'
    ]


@pytest.mark.parametrize(
    ('name', 'old', 'new', 'reason'),
    [
        ('package.xml', '</license>', '', 'package.xml: mismatched tag: line 9'),
        ('package.xml', 'Two', 'Two & a half', 'package.xml: not well-formed (invalid token)'),
        ('package.xml', '0.0.0', '1.0', 'package.xml: Package version "1.0" does not follow'),
        ('package.xml', '>talk<', '>my talk<', 'package.xml: Package name "my talk" does not fol'),
        ('package.xml', BUILD_TYPE, '', f'package.xml has no build type: write {BUILD_TYPE}'),
        ('package.xml', BUILD_TYPE, CATKIN, 'package.xml is that of a package of ROS 1, which bu'),
        ('package.xml', 't_python<', 't-python<', "has the build type 'ament-python': write"),
        ('package.xml', 'ament_python<', 'catkin<', "package.xml has the build type 'catkin': "),
        ('setup.cfg', '[dev', '\ufeff[dev', 'byte order mark, which setuptools does not read'),
        ('setup.cfg', '[develop]', '', 'setup.cfg: File contains no section headers.'),
        ('setup.py', FILES['setup.py'], '', 'setup.py does not call setup(): `ros2 pkg create`'),
        ('setup.py', 'from', 'import odd.a\nfrom', ":1: no module 'odd' is installed: noth"),
        ('setup.py', 'setuptools', 'setuptool', "'setuptool' is installed: did you mean "),
        ('setup.py', "'talk'", 'odd.N\nimport odd', ":4: no module 'odd' is installed: inst"),
        ('setup.py', "'talk'", '’talk’', "setup.py:3: invalid character '’' (U+2019), which a"),
        ('setup.py', '],\n    entry', '\n    entry', 'setup.py:'),
        ('setup.py', "'hello =", "'hello:", "setup.py:14: 'hello: talk.hello:main' is no entry p"),
        ('setup.py', ':main', ':main()', "'hello = talk.hello:main()' is no entry point: write"),
        ('setup.py', "main',", "main'\n 'b = talk.b:main',", 'is there no comma behind the line'),
        ('setup.py', "main',", "main',\n 'hello = talk.b:main',", "'hello' is the name of an ent"),
        ('setup.py', "['package.xml']", "glob('*.xml')", 'is `from glob import glob` missing abo'),
        ('setup.py', "['package.xml']", 'os.listdir()', 'os is not defined: is `import os` miss'),
        ('setup.py', "['package.xml']", "'package.xml'", 'in data_files: write a list, ['),
        ('setup.py', "['package.xml']", "['a.xml']", ":10: 'a.xml' in data_files is not there"),
        ('setup.py', "['package.xml']", "['talk']", "name the files in it, glob('talk/*')"),
        ('setup.py', "['package.xml']", "['/etc/hosts']", "'/etc/hosts' in data_files begins wi"),
        ('setup.py', "= 'talk'", "= 'talks'", "setup.py:9: 'resource/talks' in data_files is not"),
    ],
)  # fmt: skip
def test_what_cannot_be_built_is_told(
    folder: Path, name: str, old: str, new: str, reason: str
) -> None:
    replace(folder / name, old, new)
    (told,) = package_files.why_refused(folder)
    assert reason in told


@pytest.mark.parametrize('letter', ':;"`${}')
def test_a_folder_that_colcon_cannot_build_in_is_told(tmp_path: Path, letter: str) -> None:
    folder = write_package(tmp_path / f'a{letter}b' / 'src' / 'talk')
    assert package_files.why_refused(folder) == [
        f'{folder}: colcon cannot build in a folder with {letter} in its name; rename it'
    ]


@pytest.mark.parametrize('module', ['numbers/__init__.py', 'queue.py'])
def test_a_module_that_hides_one_of_python_is_told(folder: Path, module: str) -> None:
    for harmless in ('turtle.py', 'test/__init__.py', 'random', 'signal/notes.txt'):
        (folder / harmless).parent.mkdir(exist_ok=True)
        (folder / harmless).touch()
    assert package_files.why_refused(folder) == []
    (folder / module).parent.mkdir(exist_ok=True)
    (folder / module).touch()
    (told,) = package_files.why_refused(folder)
    name = module.partition('/')[0]
    assert told.startswith(
        f'{name} hides the module {name.removesuffix(".py")!r} of Python, which'
    )
    command = [sys.executable, 'setup.py', '--name']
    assert subprocess.run(command, cwd=folder, capture_output=True).returncode != 0  # it is true


@pytest.mark.filterwarnings('ignore::DeprecationWarning')  # of pyparsing 3.3, by catkin_pkg
def test_a_package_of_both_ros_is_of_the_one_that_is_here(folder: Path) -> None:
    one, two = (
        f'<build_type condition="$ROS_VERSION == {version}">{kind}</build_type>'
        for version, kind in ((1, 'catkin'), (2, 'ament_python'))
    )
    replace(folder / 'package.xml', BUILD_TYPE, f'<export>{one}{two}</export>')
    assert package_files.why_refused(folder) == []
    replace(folder / 'package.xml', two, two.replace('ament_python', 'ament_cmake'))
    (folder / 'setup.py').unlink()  # of which a build by CMake knows nothing
    assert package_files.why_refused(folder) == []


def test_a_missing_setup_file_is_told(folder: Path) -> None:
    (folder / 'setup.py').unlink()
    assert package_files.why_refused(folder) == [
        'setup.py: there is none; package.xml says ament_python'
    ]


@pytest.mark.parametrize(
    ('old', 'new', 'reason'),
    [
        ('talk.hello:', 'talk.helo:', "talk/helo.py; did you mean 'hello'?"),
        ('talk.hello:', 'tolk.hello:', 'has no folder tolk; that of the package is talk'),
        ('talk.hello:', 'talk.hello.py:', 'write the name of a module without .py'),
        ('talk.hello:main', 'talk.hello', 'names no function: write talk.hello:main'),
        (':main', ':mian', 'hello.py has no mian()'),
    ],
)
def test_a_program_that_cannot_start_is_told(
    folder: Path, old: str, new: str, reason: str
) -> None:
    replace(folder / 'setup.py', old, new)
    assert package_files.why_refused(folder) == []  # as colcon builds it everywhere
    ((program, told),) = setup_py.broken_programs(folder, 'talk')
    assert program == 'hello'
    assert reason in told


@pytest.mark.parametrize(
    ('line', 'remedy'),
    [
        ('import arm', 'from talk import arm'),
        ('from arm import LENGTH', 'from talk.arm import LENGTH'),
        ('from talk.arm import LENGTH', ''),
        ('from .arm import LENGTH', ''),
        ('import json', ''),
        ('try:\n    import arm\nexcept ImportError:\n    pass', ''),
    ],
)
def test_an_import_of_what_lies_beside_is_told(folder: Path, line: str, remedy: str) -> None:
    for name in ('arm', 'json'):
        (folder / 'talk' / f'{name}.py').write_text('LENGTH = 1\n')
    hello = folder / 'talk' / 'hello.py'
    hello.write_text(f'{line}\n\n\n{FILES["talk/hello.py"]}')
    command = [sys.executable, '-c', 'import talk.hello']
    done = subprocess.run(command, cwd=folder, capture_output=True, text=True)
    assert (done.returncode != 0) == (remedy != ''), done.stderr
    told = f'{hello}:1: arm is a module of this package: write `{remedy}`'
    assert dict(setup_py.broken_programs(folder, 'talk')) == ({'hello': told} if remedy else {})


def test_a_program_beside_the_folder_of_the_programs_is_told(folder: Path) -> None:
    (folder / 'src').mkdir()
    lost = (folder / 'talk' / 'hello.py').rename(folder / 'src' / 'hello.py')
    ((_, told),) = setup_py.broken_programs(folder, 'talk')
    assert told.endswith(f'there is no {folder}/talk/hello.py: move {lost} there')


def test_what_a_setup_py_says_beside_cmake_counts_for_nothing(
    folder: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    replace(folder / 'package.xml', 'ament_python', 'ament_cmake')
    (lists := folder / 'CMakeLists.txt').write_text('project(talk)\nament_package()\n')
    (folder / 'talk' / 'bye.py').write_text('import rclpy\n\n\ndef main():\n    pass\n')
    prefix = folder.parents[1] / 'install' / 'talk'
    index = prefix / 'share/ament_index/resource_index/packages/talk'
    index.parent.mkdir(parents=True)
    index.touch()
    monkeypatch.setenv('AMENT_PREFIX_PATH', str(prefix))
    assert list(workspaces.check_changed('talk', prefix)) == []
    for name in ('hello', 'bye.py'):
        script = f'talk/{name.removesuffix(".py")}.py'
        with pytest.raises(PackageError) as refused:
            packages.find_executable('talk', name)
        assert str(refused.value).startswith(
            f'No executable found: {folder}/{script} is not installed: write install(PROGRAMS '
            f'{script} DESTINATION lib/${{PROJECT_NAME}}) in {lists}, which alone counts where'
        )
    lists.write_text('install(PROGRAMS talk/bye.py DESTINATION lib/${PROJECT_NAME})\n')
    with pytest.raises(PackageError, match=r'bye\.py is not installed yet: run `colcon build'):
        packages.find_executable('talk', 'bye')
    (program := prefix / 'lib' / 'talk' / 'bye.py').parent.mkdir(parents=True)
    program.touch(mode=0o755)
    with pytest.raises(PackageError, match="has no 'bye'; did you mean 'bye"):
        packages.find_executable('talk', 'bye')


def test_a_program_in_utf_16_is_told(folder: Path) -> None:
    (folder / 'talk' / 'hello.py').write_text(FILES['talk/hello.py'], encoding='utf-16')
    ((_, told),) = setup_py.broken_programs(folder, 'talk')
    assert told.endswith('hello.py is saved as UTF-16 (Windows: Unicode): save it as UTF-8')


def test_a_package_without_init_is_told(folder: Path) -> None:
    (folder / 'talk' / '__init__.py').unlink()
    ((_, told),) = setup_py.broken_programs(folder, 'talk')
    assert 'talk/__init__.py is missing, without which its folder is not installed' in told


def test_modules_that_no_build_copies_have_not_changed(folder: Path, tmp_path: Path) -> None:
    prefix = tmp_path / 'install' / 'talk'
    copy = prefix / 'lib' / 'python3.11' / 'site-packages' / 'talk'
    (folder / 'talk' / 'hello.py').write_text('from talk.parts import arm\ndef main(): pass\n')
    shutil.copytree(folder / 'talk', copy)
    for name in ('parts', 'notes'):  # the one is imported, the other is not
        (folder / 'talk' / name).mkdir()
        (folder / 'talk' / name / 'arm.py').touch()
    parts = folder / 'talk' / 'parts'
    left = f'talk: {parts} is imported, but not installed; '
    build = f', then run `colcon build --packages-select talk` in {tmp_path}'
    (told,) = workspaces.check_changed('talk', prefix)
    assert str(told) == f'{left}make an empty {parts / "__init__.py"}{build}'

    setup = folder / 'setup.py'
    replace(setup, "find_packages(exclude=['test'])", '[package_name]')
    (parts / '__init__.py').touch()
    (told,) = workspaces.check_changed('talk', prefix)
    found = f"packages=find_packages(exclude=['test']) in {setup}"
    assert str(told) == f'{left}write {found}{build}'

    replace(setup, '[package_name]', "[package_name, 'talk.parts']")
    (told,) = workspaces.check_changed('talk', prefix)
    assert str(told).startswith(f'talk: {parts}/__init__.py has changed since the package was bu')
    shutil.copytree(parts, copy / 'parts')
    assert list(workspaces.check_changed('talk', prefix)) == []


def test_a_program_that_is_installed_elsewhere_is_told(folder: Path) -> None:
    assert package_files.why_not_run(folder, 'talk') is None
    replace(folder / 'setup.cfg', 'install_scripts', 'install-scripts')
    assert package_files.why_not_run(folder, 'talk') is None
    replace(folder / 'setup.cfg', 'lib/talk', 'lib/tolk')
    told = package_files.why_not_run(folder, 'talk')
    assert told is not None
    assert 'write script_dir=$base/lib/talk below [develop] and build again' in told
    assert package_files.why_not_run(folder, 'tolk') == (
        f"but package.xml calls the package 'tolk', and {folder / 'setup.py'} 'talk': write one "
        'name in both, and build again'
    )
    replace(folder / 'setup.py', 'console_scripts', 'console_script')
    told = package_files.why_not_run(folder, 'talk')
    assert told == "but not under 'console_scripts' of entry_points; put it there, and build again"
    (folder / 'setup.py').write_text(FILES['setup.py'], encoding='utf-16')
    told = package_files.why_not_run(folder, 'talk')
    assert told is not None
    assert told.startswith('but colcon cannot build it: setup.py is saved as UTF-16')
    assert list(setup_py.broken_programs(folder, 'talk')) == []


def test_a_package_xml_of_another_name_is_told(folder: Path) -> None:
    (folder / 'package.xml').rename(folder / 'package.xml.txt')
    assert package_files.why_refused(folder) == [
        'package.xml: there is none, by which ROS knows a package; rename package.xml.txt, if '
        'that is it'
    ]
