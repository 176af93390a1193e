# Copyright 2026 The Husky Playpen Lab authors
# SPDX-License-Identifier: Apache-2.0
"""What is refused in definitions and in CMakeLists.txt, by file, line and what is allowed.

And the tests of packages that were made with a full ROS 2.
"""

from __future__ import annotations

import os
from pathlib import Path
import subprocess
import sys

from colcon_rosidl_python.build import build, BuildError
from colcon_rosidl_python.cmake_commands import CMakeListsError
from colcon_rosidl_python.cmake_package import Install, read_cmake_package
import pytest
from setuptools import Distribution

MANIFEST = """\
<?xml version="1.0"?>
<package format="3">
  <name>own_msgs</name>
  <version>0.0.0</version>
  <description>for tests</description>
  <maintainer email="someone@example.org">someone</maintainer>
  <license>Apache-2.0</license>
  <depend>geometry_msgs</depend>
  <member_of_group>rosidl_interface_packages</member_of_group>
  <export><build_type>ament_cmake</build_type></export>
</package>
"""


@pytest.fixture
def folder(tmp_path: Path) -> Path:
    (tmp_path / 'package.xml').write_text(MANIFEST)
    return tmp_path


FINDS = ('rosidl_default_generators', 'geometry_msgs', 'nav_msgs')


def write_cmake(folder: Path, text: str, finds: tuple[str, ...] = FINDS) -> None:
    found = ' '.join(f'find_package({name} REQUIRED)' for name in finds)
    (folder / 'CMakeLists.txt').write_text(f'project(own_msgs) {found}\n{text}\n')


def refusal(folder: Path, name: str, text: str, dependencies: str = 'geometry_msgs') -> str:
    """Build a package with one definition, and return why that is refused."""
    write_cmake(
        folder,
        f'rosidl_generate_interfaces(${{PROJECT_NAME}} "msg/Known.msg" "{name}"\n'
        f'  DEPENDENCIES {dependencies})',
    )
    for path, content in (('msg/Known.msg', 'int8 x'), (name, text)):
        (folder / path).parent.mkdir(exist_ok=True)
        (folder / path).write_text(content)
    with pytest.raises(BuildError) as refused:
        build(folder, folder / 'prefix', link=False)
    assert not (folder / 'prefix').exists()
    return str(refused.value)


@pytest.mark.parametrize(
    ('text', 'reason'),
    [
        (
            'int64 a\nint b',
            "msg/Own.msg:2: 'int' is no type: did you mean int8? allowed are bool,",
        ),
        ('Int64 a', 'msg/Own.msg:1: Int64: CMakeLists.txt names no msg/Int64.msg; its messages'),
        ('Int64 a', 'did you mean int64?'),
        ('float a', "msg/Own.msg:1: 'float' is no type: did you mean float"),
        ('double a', "msg/Own.msg:1: 'double' is no type: did you mean float64?"),
        (
            'geometry_msgs/msg/Point a',
            "'geometry_msgs/msg/Point' is no type: did you mean geometry_msgs/Point?",
        ),
        ('int64', "msg/Own.msg:1: 'int64' is no field: write TYPE NAME, as in 'int64 num'"),
        ('int64 Num', "'Num' is no name of a field: allowed are small letters, digits and"),
        ('int64 a__b', "'a__b' is no name of a field"),
        ('int64 class', "'class' is a word of Python: choose another name"),
        ('int64 a\n\nint8 a', "msg/Own.msg:3: 'a' stands in line 1 already: rename one"),
        ('  int64 a', "'int64 a' does not begin at the margin: take the spaces away"),
        ('int8 answer=1', "'answer' is no name of a constant: allowed are capital letters"),
        ('int8 answer = 1', "; a default has no =: 'int8 answer 1'"),
        ('int8 A=300', "value '300' can not be converted to type 'int8': must be a valid integer"),
        ('uint8 a 256', "value '256' can not be converted to type 'uint8'"),
        ('bool a maybe', "value 'maybe' can not be converted to type 'bool'"),
        ('int8[2] a [1]', 'array must have exactly 2 elements, not 1'),
        ('geometry_msgs/Point p 1', 'only numbers, bool and text have defaults'),
        ('int8[0] a', "'int8[0]': allowed are TYPE, TYPE[], TYPE[3], TYPE[<=3], and string<=10"),
        ('int8<=3 a', "'int8<=3': allowed are TYPE"),
        ('int8[ a', "'int8[': allowed are TYPE"),
        ('Header header', 'msg/Own.msg:1: Header alone is of ROS 1: use std_msgs/Header'),
        ('time t', 'time is of ROS 1: use builtin_interfaces/Time'),
        ('geometry_msgs/Pont p', 'Pont: geometry_msgs has no such message; it has Accel,'),
        ('nav_msgs/Path p', 'Path: of nav_msgs: add nav_msgs to DEPENDENCIES in CMakeLists.txt'),
        ('int8 a;', "'a;' is no name of a field"),
        ('float64 a nan', "'float64 a nan': nan cannot be written in IDL: use a finite number"),
        (
            'string[] a ["b\']',
            "msg/Own.msg:1: 'string[] a [\"b\\']': string [\"b'] incorrectly quoted",
        ),
        ('string a "\\n"', "msg/Own.msg: upstream's generators refuse it: UnexpectedCharacters: "),
        ('\ufeffint8 a', 'msg/Own.msg:1: the file begins with a byte order mark: save it as'),
        ('Own[] children', 'a message cannot hold itself: Own in Own: take a field out'),
        ('int8 a\n---\nint8 b', 'msg/Own.msg: 1 lines of ---, not 0: a .msg has fields'),
    ],
)
def test_a_mistake_in_a_message_is_told_by_its_line(folder: Path, text: str, reason: str) -> None:
    assert reason in refusal(folder, 'msg/Own.msg', text)


@pytest.mark.parametrize('names', ['"msg/Known.msg", "msg/Own.msg"', 'msg/Known.msg, msg/Own.msg'])
def test_a_comma_between_files_is_told(folder: Path, names: str) -> None:
    write_cmake(folder, f'rosidl_generate_interfaces(${{PROJECT_NAME}} {names})')
    (folder / 'msg').mkdir()
    for name in ('Known', 'Own'):
        (folder / 'msg' / f'{name}.msg').write_text('int8 x')
    with pytest.raises(BuildError) as refused:
        build(folder, folder / 'prefix', link=False)
    assert str(refused.value).startswith(
        'CMakeLists.txt: CMake parts files by blanks: take the comma behind the name away'
    )


def test_a_merge_conflict_in_a_message_is_told_once(folder: Path) -> None:
    text = 'bool b\n<<<<<<< HEAD\nint8 a\n=======\nint16 a\n>>>>>>> theirs\n'
    told = refusal(folder, 'msg/Own.msg', text)
    assert told == (
        'msg/Own.msg:2: a merge conflict of git begins here: keep one of its two sides, and '
        'remove the lines that begin with <<<<<<<, ======= and >>>>>>>'
    )


@pytest.mark.parametrize(
    ('name', 'text', 'reason'),
    [
        ('srv/Own.srv', 'int8 a', '0 lines of ---, not 1: a .srv has request, ---, response'),
        ('srv/Own.srv', 'int8 a\n---\nint8 a\nstrng b', "srv/Own.srv:4: 'strng' is no type: did"),
        ('action/Own.action', '---', '1 lines of ---, not 2: a .action has goal, ---, result,'),
        ('msg/own.msg', 'int8 a', "'own' is no name of an interface: allowed are letters and"),
        ('msg/Own.txt', 'int8 a', 'msg/Own.txt: allowed are .msg, .srv, .action and .idl'),
        ('msg/Own.idl', 'module own_msgs {\n  struct', 'msg/Own.idl:2: this is no IDL: '),
        (
            'msg/Own.idl',
            'module m {\nmodule msg {\nstruct Own { char c; }; }; };',
            'char is no ty',
        ),
    ],
)
def test_a_mistake_in_other_definitions_is_told_by_its_line(
    folder: Path, name: str, text: str, reason: str
) -> None:
    assert reason in refusal(folder, name, text)


def test_every_mistake_is_told_at_once(folder: Path) -> None:
    manifest = MANIFEST.replace('<member_of_group>rosidl_interface_packages</member_of_group>', '')
    (folder / 'package.xml').write_text(manifest)
    reasons = refusal(folder, 'msg/Own.msg', 'int a\nint8\nint8 b')
    assert [line.partition(': ')[0] for line in reasons.splitlines()] == [
        'package.xml',
        'msg/Own.msg:1',
        'msg/Own.msg:2',
    ]
    assert reasons.startswith('package.xml: add <member_of_group')


def test_a_text_that_is_no_utf8_is_told_by_its_line(folder: Path) -> None:
    refusal(folder, 'msg/Own.msg', 'int8')
    (folder / 'msg' / 'Own.msg').write_bytes(b'int8 a\n# \xe4\n')
    with pytest.raises(BuildError, match=r'msg/Own\.msg:2: this is not UTF-8'):
        build(folder, folder / 'prefix', link=False)


def test_what_is_named_and_not_there_is_told(folder: Path) -> None:
    write_cmake(folder, 'rosidl_generate_interfaces(${PROJECT_NAME} "msg/Lost.msg")')
    with pytest.raises(BuildError, match=r'msg/Lost\.msg: there is no such file'):
        build(folder, folder / 'prefix', link=False)
    reason = refusal(folder, 'msg/Own.msg', 'int8 a', 'lost_msgs')
    assert 'DEPENDENCIES names lost_msgs, which is not found' in reason
    assert reason.endswith('; package.xml: add <depend>lost_msgs</depend>')


def test_what_cmake_does_not_know_yet_is_told(folder: Path) -> None:
    (folder / 'msg').mkdir()
    (folder / 'msg/Own.msg').write_text('geometry_msgs/Point place')
    generate = 'rosidl_generate_interfaces(own_msgs "msg/Own.msg" DEPENDENCIES geometry_msgs)'

    def build_with(*finds: str, text: str = generate) -> None:
        write_cmake(folder, text, finds)
        build(folder, folder / 'prefix', link=False)

    generators, messages = FINDS[:2]
    later = f'{generate}\nfind_package({generators})'
    for text in (generate, later):
        with pytest.raises(CMakeListsError, match=rf':2: .*write find_package\({generators} REQ'):
            build_with(messages, text=text)
    with pytest.raises(BuildError, match=rf'names {messages}, .*write find_package\({messages} R'):
        build_with(generators)
    assert not (folder / 'prefix').exists()
    build_with(generators, 'nav_msgs')  # which itself looks for geometry_msgs
    write_cmake(folder, f'ament_auto_find_build_dependencies()\n{generate}', ())
    depends = f'<buildtool_depend>{generators}</buildtool_depend><depend>geometry_msgs</depend>'
    manifest = MANIFEST.replace('<depend>geometry_msgs</depend>', depends)
    (folder / 'package.xml').write_text(manifest)
    build(folder, folder / 'prefix', link=False)


def test_definitions_may_name_what_cmake_finds(
    folder: Path, capsys: pytest.CaptureFixture[str]
) -> None:
    for name, text in (
        (
            'msg/Own.msg',
            'std_msgs/Header header\nnav_msgs/Path path',
        ),  # geometry_msgs has std_msgs
        ('srv/Own.srv', 'builtin_interfaces/Duration d\n---\nservice_msgs/ServiceEventInfo i'),
        ('action/Own.action', 'unique_identifier_msgs/UUID id\n---\n---\n'),
    ):
        (folder / name).parent.mkdir()
        (folder / name).write_text(text)
    (folder / 'msg/Forgotten.msg').touch()
    write_cmake(
        folder,
        'rosidl_generate_interfaces(own_msgs "msg/Own.msg" "srv/Own.srv" "action/Own.action"\n'
        '  DEPENDENCIES geometry_msgs nav_msgs rosidl_default_generators)',
    )
    build(folder, folder / 'prefix', link=False)
    assert (folder / 'prefix/share/own_msgs/msg/Own.json').is_file()
    assert capsys.readouterr().err.splitlines() == [
        'own_msgs: msg/Forgotten.msg: is not built: no rosidl_generate_interfaces of '
        'CMakeLists.txt names it',
        'own_msgs: package.xml: add <depend>nav_msgs</depend>; CMakeLists.txt names it',
    ]


def test_a_name_that_no_interfaces_can_have_is_refused(folder: Path) -> None:
    manifest = folder / 'package.xml'
    manifest.write_text(MANIFEST.replace('own_msgs', 'own-msgs'))
    assert refusal(folder, 'msg/Own.msg', 'int8 a') == (
        "package.xml: 'own-msgs' is no name of a package of interfaces: allowed are small "
        'letters, digits and single underscores, beginning with a letter'
    )


@pytest.mark.parametrize(
    ('text', 'reason'),
    [
        (
            'add_executable(talker src/talker.cpp)',
            r':2: add_executable\(\.\.\.\): needs a C\+\+ co',
        ),
        (
            'install(TARGETS talker\n  DESTINATION lib)',
            r':2: install\(\.\.\.\): needs a C\+\+ comp',
        ),
        (
            'ament_auto_find_build_dependencies()\nament_auto_add_library(talk src/talk.cpp)',
            r':3: ament_auto_add_library\(\.\.\.\): needs a C\+\+ co',
        ),
        (
            '\nfoo(bar)',
            r':3: foo\(\.\.\.\): is not understood here; what is: ament_auto_package, ament_py',
        ),
        ('foo(bar)\nadd_library(talk)', r':3: add_library\(\.\.\.\): needs a C\+\+ co'),
        ('ament_auto_package(INSTALL_TO_SHARE lost)', r'there is no folder lost: mend the name'),
        ('if(WIN32)\ninstall(FILES a DESTINATION b)\nendif()', r'stands in if\(WIN32\)'),
        ('install(FILES lost DESTINATION share)', r'there is no file lost: mend the name'),
        ('install(DIRECTORY package.xml DESTINATION x)', r'there is no folder package\.xml: mend'),
        (
            'install(FILES package.xml DESTINATION)',
            r'allowed is FILES, PROGRAMS or DIRECTORY with',
        ),
        ('list(APPEND)', r':2: list\(\.\.\.\): is not understood here'),
        ('file(GLOB found /msg/*)', r':2: file\(\.\.\.\): .* allowed is msg/\*\.msg or the like'),
        ('ament_python_install_package(lost PACKAGE_DIR)', r'there is no lost/__init__\.py'),
        ('install(FILES package.xml DESTINATION ../..)', r'only what is in the package'),
        ('install(FILES package.xml DESTINATION /etc)', r'only what is in the package'),
        ('install(SCRIPT x)', r'allowed is FILES, PROGRAMS or DIRECTORY with a DESTINATION'),
        ('ament_python_install_package(lost)', r'there is no lost/__init__\.py'),
        ('install(FILES a', r':2: install\( has no'),
        ('set(a "b)', r":2: '\"' is not closed"),
        (')', r":2: '\)' closes nothing"),
        (
            'ament_package()\nrosidl_generate_interfaces(own_msgs "msg/Own.msg")',
            r':3: rosidl_generate_interfaces\(\.\.\.\): stands behind ament_package\(\): move',
        ),
        (
            'find_package(rosidl_default_generators)\nset(files "msg/A.msg")\n'
            'rosidl_generate_interfaces(own_msgs ${file} DEPENDENCIES std_msgs)',
            r':4: rosidl_generate_interfaces\(\.\.\.\): names no interface, as where a variable',
        ),
        (
            'ament_auto_package()\nrosidl_generate_interfaces(own_msgs "msg/Own.msg")',
            r':3: rosidl_generate_interfaces\(\.\.\.\): stands behind ament_package\(\): move',
        ),
    ],
)
def test_what_cannot_be_built_is_told_by_its_line(folder: Path, text: str, reason: str) -> None:
    write_cmake(folder, text)
    with pytest.raises(CMakeListsError, match=rf'^CMakeLists\.txt.*{reason}'):
        read_cmake_package(folder)


def test_a_cmake_file_is_read_as_cmake_reads_it(folder: Path) -> None:
    (folder / 'msg').mkdir()
    for name in ('A', 'B'):
        (folder / 'msg' / f'{name}.msg').touch()
    write_cmake(
        folder,
        '#[[ add_executable(no)\n ]] # neither\n'
        'SET(files msg/C.msg;"msg/D.msg")\n'
        'file(GLOB found CONFIGURE_DEPENDS ${CMAKE_CURRENT_SOURCE_DIR}/msg/*.msg)\n'
        'list(APPEND files ${found} ${nothing})\n'
        'rosidl_generate_interfaces(${PROJECT_NAME}_x ${files} "srv/E.srv"\n'
        '  DEPENDENCIES std_msgs # (not) this\n'
        '  geometry_msgs LIBRARY_NAME ${PROJECT_NAME} ADD_LINTER_TESTS)\n'
        'if(BUILD_TESTING AND (NOT WIN32))\n  anything(here)\nendif()\n'
        'install(FILES "package.xml" DESTINATION ${CMAKE_INSTALL_PREFIX}/share/${PROJECT_NAME}\n'
        '  RENAME other.xml)\n',
    )
    cmake = folder / 'CMakeLists.txt'
    cmake.write_text(f'\ufeff{cmake.read_text()}')
    package = read_cmake_package(folder)
    assert [path.stem for path in package.interfaces] == ['C', 'D', 'A', 'B', 'E']
    assert package.dependencies == ['std_msgs', 'geometry_msgs']
    assert package.installs == [Install(Path('package.xml'), Path('share/own_msgs/other.xml'))]
    cmake.write_text(cmake.read_text(), encoding='utf-16')
    with pytest.raises(CMakeListsError, match=r'CMakeLists\.txt is saved as UTF-16 '):
        read_cmake_package(folder)


def test_folders_and_modules_are_installed(folder: Path) -> None:
    installed = ('data/a.txt', 'data/deep/b.txt', 'data/c.bak', 'own_tools/__init__.py')
    for path in (*installed, 'launch/a.launch.py', 'include/own_msgs/a.hpp'):
        (folder / path).parent.mkdir(parents=True, exist_ok=True)
        (folder / path).touch()
    write_cmake(
        folder,
        'link_directories(${GAZEBO_LIBRARY_DIRS})\n'  # where nothing is linked, it does nothing
        'install(DIRECTORY data/ DESTINATION share/one FILES_MATCHING PATTERN "*.txt")\n'
        'install(DIRECTORY data DESTINATION share/two PATTERN deep EXCLUDE)\n'
        'ament_python_install_package(own_tools)\n'
        'install(DIRECTORY own_tools/ DESTINATION ${PYTHON_INSTALL_DIR}/by_hand)\n'
        'ament_auto_package(INSTALL_TO_PATH INSTALL_TO_SHARE launch data/deep)\n',
    )
    prefix = folder / 'prefix'
    build(folder, prefix, link=True)
    files = {str(path.relative_to(prefix)) for path in prefix.rglob('*') if path.is_file()}
    assert {name for name in files if name.startswith(('share/one', 'share/two'))} == {
        'share/one/a.txt', 'share/one/deep/b.txt', 'share/two/data/a.txt', 'share/two/data/c.bak',
    }  # fmt: skip
    assert (prefix / 'share/one/a.txt').is_symlink()
    for name in ('share/own_msgs/launch/a.launch.py', 'share/own_msgs/deep/b.txt'):
        assert name in files
    assert 'include/own_msgs/a.hpp' in files
    for name in ('own_tools', 'by_hand'):
        assert any(file.endswith(f'-packages/{name}/__init__.py') for file in files)


def test_a_program_can_be_executed_where_it_is_installed(folder: Path) -> None:
    (folder / 'node.py').write_text('#!/usr/bin/env python3\n')
    (folder / 'node.py').chmod(0o644)  # as an editor saves it
    write_cmake(
        folder,
        'install(PROGRAMS node.py DESTINATION lib/own_msgs)\n'
        'install(FILES node.py DESTINATION share/own_msgs)\n',
    )
    prefix = folder / 'prefix'
    for link in (True, False):  # a copy in the place of a link leaves the package's file alone
        build(folder, prefix, link=link)
    assert os.access(prefix / 'lib/own_msgs/node.py', os.X_OK)
    for other in (prefix / 'share/own_msgs/node.py', folder / 'node.py'):
        assert other.stat().st_mode & 0o777 == 0o644


def test_setuptools_knows_tests_require() -> None:
    package = Distribution({'name': 'demo', 'tests_require': ['pytest']})
    assert vars(package)['tests_require'] == ['pytest']  # colcon reads it there


def test_missing_linters_do_not_keep_other_tests_from_running(tmp_path: Path) -> None:
    for linter in ('ament_copyright', 'ament_flake8', 'ament_pep257'):
        text = f'from {linter}.main import main\ndef test_style(): assert main([]) == 0\n'
        (tmp_path / f'test_{linter}.py').write_text(text)
    (tmp_path / 'test_own.py').write_text('def test_own(): pass\n')
    options = ['-c', os.devnull, '-p', 'no:cacheprovider', '-rs', '--rootdir=.']
    done = subprocess.run(
        [sys.executable, '-m', 'pytest', *options, '.'],
        cwd=tmp_path,
        capture_output=True,
        text=True,
        check=False,
    )
    assert '1 passed, 3 skipped' in done.stdout, done.stdout + done.stderr
    assert 'ament_flake8 is part of a full ROS 2, and has no wheel' in done.stdout
    assert done.returncode == 0
