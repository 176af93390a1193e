# Copyright 2026 The Husky Playpen Lab authors
# SPDX-License-Identifier: Apache-2.0
"""
What a CMakeLists.txt of ament_cmake asks for, as far as it needs no compiler.

Interfaces are made and files are installed. All else is refused by its line: no half of a package
is built.
"""

from __future__ import annotations

from collections.abc import Iterator
from dataclasses import dataclass, field, replace
from pathlib import Path

from catkin_pkg.package import parse_package

from colcon_rosidl_python.cmake_commands import Command, read_commands

# They change nothing here: they find, check or describe.
_HARMLESS = {
    *('cmake_minimum_required', 'project', 'find_package', 'include', 'include_directories'),
    *('add_compile_options', 'add_definitions', 'message', 'option', 'enable_testing', 'else'),
    *('elseif', 'include_guard', 'cmake_policy', 'mark_as_advanced', 'set_property'),
    *('add_compile_definitions', 'link_directories', 'find_library', 'pkg_check_modules'),
    *('pkg_search_module', 'ament_auto_find_build_dependencies'),
    *('ament_package', 'ament_export_dependencies', 'ament_export_include_directories'),
    *('ament_export_libraries', 'ament_export_targets', 'ament_lint_auto_find_test_dependencies'),
    *('rosidl_export_typesupport_libraries', 'rosidl_export_typesupport_targets'),
}
_NEEDS_A_COMPILER = (
    'needs a C++ compiler and ROS built for it, which the pip installation has not: '
    'write the node in Python, or build the package where a ROS 2 Jazzy is sourced'
)
_COMPILED = {
    *('add_executable', 'add_library', 'ament_auto_add_executable', 'ament_auto_add_library'),
    *('ament_target_dependencies', 'target_link_libraries', 'target_include_directories'),
    *('target_compile_features', 'target_compile_definitions', 'target_compile_options'),
    *('rosidl_get_typesupport_target', 'rosidl_target_interfaces', 'pybind11_add_module'),
    *('rclcpp_components_register_node', 'rclcpp_components_register_nodes'),
    *('pluginlib_export_plugin_description_file', 'generate_parameter_library'),
}
_TESTS = {
    *('ament_add_pytest_test', 'add_launch_test', 'ament_add_test', 'add_test'),
    *('ament_add_gtest', 'ament_add_gmock'),
}
_GENERATORS = {'rosidl_default_generators', 'rosidl_cmake'}
_FINDS_ALL = 'ament_auto_find_build_dependencies'
_COMPLETES = ('ament_package', 'ament_auto_package')
_OPTIONS_OF_INTERFACES = {'ADD_LINTER_TESTS', 'SKIP_INSTALL', 'SKIP_GROUP_MEMBERSHIP_CHECK'}
_OPTIONS_OF_INSTALL = {'USE_SOURCE_PERMISSIONS', 'OPTIONAL'}


@dataclass(frozen=True)
class Install:
    """
    A file, or a folder with all in it, that is installed.

    :param source: from the package's folder.
    :param target: from the prefix, with the name that it has there.
    :param is_program: a copy can be executed, whether or not the file in the package can.
    """

    source: Path
    target: Path
    without: tuple[str, ...] = ()
    only: tuple[str, ...] = ()
    is_program: bool = False


@dataclass
class CMakePackage:
    """
    What a package asks for.

    :param dependencies: whose messages its interfaces may name.
    :param found: what find_package has found before.
    :param modules: folders of Python, by the names of the packages that they become.
    """

    interfaces: list[Path] = field(default_factory=list)
    dependencies: list[str] = field(default_factory=list)
    found: list[str] = field(default_factory=list)
    installs: list[Install] = field(default_factory=list)
    modules: dict[str, Path] = field(default_factory=dict)


def read_cmake_package(folder: Path) -> CMakePackage:
    """
    Read CMakeLists.txt in a package's folder.

    :raises CMakeListsError: if it asks for what cannot be done here.
    """
    package = CMakePackage()
    commands = list(_commands_to_do(folder))
    for command in commands:  # no other line of such a package is worth mending
        if command.name in _COMPILED or command.arguments[:1] == ('TARGETS',):
            raise command.refused(_NEEDS_A_COMPILER)
    complete = False  # ament_package() writes down what came before it
    for command in commands:
        complete = complete or command.name in _COMPLETES
        if complete and command.name == 'rosidl_generate_interfaces':
            raise command.refused('stands behind ament_package(): move it before that')
        if command.name in _HARMLESS:
            package.found += _found(command, folder)
            continue
        if command.name not in _DONE:
            raise command.refused(f'is not understood here; what is: {", ".join(sorted(_DONE))}')
        if command.conditions:
            raise command.refused(
                f'stands in if({command.conditions[-1]}), which is not worked out: take it out'
            )
        _DONE[command.name](package, command, folder)
    return package


def _commands_to_do(folder: Path) -> Iterator[Command]:
    for command in read_commands(folder / 'CMakeLists.txt'):
        if 'BUILD_TESTING' not in ' '.join(command.conditions):
            yield command


def tests_left_out(folder: Path) -> Iterator[str]:
    """
    Tell of each test that CMake would run, and how to run it.

    :raises CMakeListsError: if there is no CMakeLists.txt in the folder, or it is not well-formed.
    """
    for command in read_commands(folder / 'CMakeLists.txt'):
        if command.name in _TESTS:
            test = f'{command.name}({" ".join(command.arguments[:1])})'
            yield (
                f'CMakeLists.txt:{command.line}: {test}: is not run, there is no CMake here; '
                '`python3 -m pytest FILE` runs one in Python, `launch_test FILE` one of a launch'
            )


def _found(command: Command, folder: Path) -> Iterator[str]:
    """Yield the names of the packages that a command finds."""
    if command.name == 'find_package':
        yield from command.arguments[:1]
    elif command.name == _FINDS_ALL:
        manifest = parse_package(folder)
        yield from (each.name for each in manifest.build_depends + manifest.buildtool_depends)


def _add_interfaces(package: CMakePackage, command: Command, folder: Path) -> None:
    if _GENERATORS.isdisjoint(package.found):
        raise command.refused(
            'CMake does not know it yet: write find_package(rosidl_default_generators REQUIRED) '
            'above it'
        )
    wanted: str | None = 'INTERFACES'
    known = len(package.interfaces)
    for argument in command.arguments[1:]:
        if argument in ('DEPENDENCIES', 'LIBRARY_NAME'):
            wanted = argument
        elif argument in _OPTIONS_OF_INTERFACES:
            wanted = None
        elif wanted == 'DEPENDENCIES':
            package.dependencies.append(argument)
        elif wanted == 'INTERFACES':
            path = Path(argument.replace(f'{folder}:', '').removeprefix(f'{folder}/'))
            if path in package.interfaces:
                raise command.refused(f'{path} is named twice: take one out')
            package.interfaces.append(path)
    if len(package.interfaces) == known:  # CMake ends here, too
        raise command.refused(
            'names no interface, as where a variable has another name than in its set(): write '
            '"msg/NAME.msg" or the like'
        )


def _add_install(package: CMakePackage, command: Command, folder: Path) -> None:
    what, *arguments = command.arguments or ('',)
    if what not in ('FILES', 'PROGRAMS', 'DIRECTORY') or 'DESTINATION' not in arguments[:-1]:
        raise command.refused('allowed is FILES, PROGRAMS or DIRECTORY with a DESTINATION')
    sources = arguments[: arguments.index('DESTINATION')]
    destination, *rest = arguments[arguments.index('DESTINATION') + 1 :]
    without, only, rename = _install_options(command, rest)
    for source in sources:
        path = Path(source.removeprefix(f'{folder}/'))
        # without a / at its end the folder itself is put there, not what is in it
        inside = what == 'DIRECTORY' and source.endswith('/')
        target = Path(destination) / ('' if inside else rename or path.name)
        if path.is_absolute() or target.is_absolute() or '..' in (*path.parts, *target.parts):
            raise command.refused(f'{source}: only what is in the package, to inside the prefix')
        place, kind = folder / path, 'folder' if what == 'DIRECTORY' else 'file'
        if not (place.is_dir() if what == 'DIRECTORY' else place.is_file()):
            raise command.refused(f'there is no {kind} {path}: mend the name, or take it out')
        is_program = what == 'PROGRAMS'
        package.installs.append(Install(path, target, without, only, is_program))


def _install_options(
    command: Command, rest: list[str]
) -> tuple[tuple[str, ...], tuple[str, ...], str]:
    """Return which files to leave out, which alone to take, and a new name."""
    without: list[str] = []
    only: list[str] = []
    rename = ''
    words = iter(rest)
    for word in words:
        if word == 'RENAME':
            rename = next(words, '')
        elif word == 'PATTERN':
            only.append(next(words, ''))
        elif word == 'EXCLUDE' and only:
            without.append(only.pop())
        elif word != 'FILES_MATCHING' and word not in _OPTIONS_OF_INSTALL:
            raise command.refused(f'{word} is not understood here')
    return tuple(without), tuple(only), rename


def _install_to_share(package: CMakePackage, command: Command, folder: Path) -> None:
    """Do what ament_auto_package() does of itself: ament_cmake_auto's short form of install()."""
    installs = [('include/', 'include')] if (folder / 'include').is_dir() else []
    wanted = ''
    for argument in command.arguments:
        if argument in ('INSTALL_TO_SHARE', 'INSTALL_TO_PATH'):
            wanted = argument
        elif wanted == 'INSTALL_TO_SHARE':
            installs.append((argument, f'share/{parse_package(folder).name}'))
    for source, target in installs:
        install = replace(command, arguments=('DIRECTORY', source, 'DESTINATION', target))
        _add_install(package, install, folder)


def _add_module(package: CMakePackage, command: Command, folder: Path) -> None:
    name, *rest = command.arguments or ('',)
    path = Path(rest[rest.index('PACKAGE_DIR') + 1] if 'PACKAGE_DIR' in rest[:-1] else name)
    if not name or not (folder / path / '__init__.py').is_file():
        raise command.refused(f'there is no {path}/__init__.py')
    package.modules[name] = path


_DONE = {
    'rosidl_generate_interfaces': _add_interfaces,
    'install': _add_install,
    'ament_python_install_package': _add_module,
    'ament_auto_package': _install_to_share,
}
