# Copyright 2026 The Husky Playpen Lab authors
# SPDX-License-Identifier: Apache-2.0
"""
Lets colcon build packages of ament_cmake where there is neither CMake nor a compiler of ROS.

It is installed with the wheels of ROS alone: where a Jazzy is sourced, CMake builds them.
"""

from __future__ import annotations

import contextlib
from pathlib import Path
import sys
from typing import Any

from colcon_core.environment import create_environment_scripts
from colcon_core.event.output import StderrLine
from colcon_core.package_augmentation import PackageAugmentationExtensionPoint
from colcon_core.shell import create_environment_hook, get_command_environment
from colcon_core.task import run, TaskExtensionPoint

from colcon_rosidl_python.cmake_commands import CMakeListsError
from colcon_rosidl_python.cmake_package import tests_left_out

TYPE = 'ros.ament_cmake_without_compiler'


class WithoutCompilerAugmentation(PackageAugmentationExtensionPoint):
    """Give packages of ament_cmake the type that the tasks below are registered for."""

    PRIORITY = PackageAugmentationExtensionPoint.PRIORITY - 10  # after that of colcon-ros

    def augment_package(self, desc: Any, *, additional_argument_names: Any = None) -> None:
        if desc.type == 'ros.ament_cmake':
            desc.type = TYPE


class WithoutCompilerBuildTask(TaskExtensionPoint):
    """Build what is interfaces and files, and refuse what is C++."""

    async def build(self) -> int:
        args, package = self.context.args, self.context.pkg
        try:
            env = await get_command_environment(
                'build', args.build_base, self.context.dependencies
            )
        except RuntimeError as error:
            print(error, file=sys.stderr)
            return 1
        options = ['--symlink-install'] if args.symlink_install else []
        command = [sys.executable, '-m', 'colcon_rosidl_python.build', *options]
        command += [args.install_base, args.path]  # from everywhere
        # Python would look first where colcon was called, where a student may have a random.py.
        done = await run(self.context, command, cwd='/', env=env)
        if done.returncode == 0:
            hooks = create_environment_hook(
                'ament_prefix_path',
                Path(args.install_base),
                package.name,
                'AMENT_PREFIX_PATH',
                '',
                mode='prepend',
            )
            create_environment_scripts(package, args, additional_hooks=hooks)
        return int(done.returncode)


class WithoutCompilerTestTask(TaskExtensionPoint):
    """Test nothing, and say so: the tests of ament_cmake are those of CMake."""

    async def test(self) -> int:
        package = self.context.pkg
        with contextlib.suppress(CMakeListsError):  # the build tells of those
            for line in tests_left_out(Path(package.path)):
                text = f'{package.name}: {line}\n'
                self.context.put_event_into_queue(StderrLine(text.encode()))
        return 0
