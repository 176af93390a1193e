# Copyright 2026 The Husky Playpen Lab authors
# SPDX-License-Identifier: Apache-2.0
"""The package to be created, and its manifest."""

from __future__ import annotations

from dataclasses import dataclass, field
import re
from xml.sax.saxutils import escape, quoteattr

from ros2cli.errors import CommandError, UsageError

_NAME = re.compile(r'[a-z](_?[a-z0-9]+)*')
_IDENTIFIER = re.compile(r'[A-Za-z_]\w*')
BUILD_TYPES = ('cmake', 'ament_cmake', 'ament_python')


@dataclass(frozen=True, kw_only=True)
class NewPackage:
    """What a person said about the package."""

    name: str
    build_type: str
    package_format: int = 3
    version: str = '0.0.0'
    description: str
    license: str
    maintainer_name: str
    maintainer_email: str
    dependencies: list[str] = field(default_factory=list)
    node_name: str | None = None
    library_name: str | None = None

    def check(self) -> None:
        """Refuse what no tool downstream can handle.

        :raises UsageError: a name is none.
        :raises CommandError: the name is taken by the layout of the package.
        """
        if not _NAME.fullmatch(self.name):
            raise UsageError(
                f"'{self.name}' is no package name: small letters, digits and single _, beginning "
                'with a letter (REP-144)'
            )
        if self.build_type == 'ament_python' and self.name == 'test':
            raise CommandError(
                "Aborted since 'ament_python' packages can't be named 'test': that is the folder "
                'of the tests. Please choose a different package name.'
            )
        for what, name in (('node', self.node_name), ('library', self.library_name)):
            if name is not None and not _IDENTIFIER.fullmatch(name):
                raise UsageError(f"'{name}' is no {what} name: letters, digits and _")
        if not re.fullmatch(r'[^@\s<>]+@[^@\s<>]+\.[A-Za-z0-9]+', self.maintainer_email):
            raise UsageError(f"'{self.maintainer_email}' is no email address: name@host.domain")

    @property
    def buildtool_dependencies(self) -> list[str]:
        if self.build_type != 'ament_cmake':
            return []
        return ['ament_cmake_ros' if self.library_name else 'ament_cmake']

    @property
    def test_dependencies(self) -> list[str]:
        if self.build_type == 'ament_cmake':
            return ['ament_lint_auto', 'ament_lint_common']
        if self.build_type == 'ament_python':
            return ['ament_copyright', 'ament_flake8', 'ament_pep257', 'python3-pytest']
        return []


def manifest(package: NewPackage) -> str:
    """Write the package.xml (REP-149)."""
    schema = f'http://download.ros.org/schema/package_format{package.package_format}.xsd'
    groups = [
        [('buildtool_depend', name) for name in package.buildtool_dependencies],
        [('depend', name) for name in package.dependencies],
        [('test_depend', name) for name in package.test_dependencies],
    ]
    lines = [
        '<?xml version="1.0"?>',
        f'<?xml-model href="{schema}" schematypens="http://www.w3.org/2001/XMLSchema"?>',
        f'<package format="{package.package_format}">',
        f'  <name>{package.name}</name>',
        f'  <version>{package.version}</version>',
        f'  <description>{escape(package.description)}</description>',
        f'  <maintainer email={quoteattr(package.maintainer_email)}>'
        f'{escape(package.maintainer_name)}</maintainer>',
        f'  <license>{escape(package.license)}</license>',
    ]
    for group in groups:
        if group:
            lines.append('')
            lines.extend(f'  <{tag}>{escape(name)}</{tag}>' for tag, name in group)
    lines += [
        '',
        '  <export>',
        f'    <build_type>{package.build_type}</build_type>',
        '  </export>',
        '</package>',
    ]
    return '\n'.join(lines) + '\n'
