# Copyright 2026 The Husky Playpen Lab authors
# SPDX-License-Identifier: Apache-2.0
"""Folders of packages."""

from __future__ import annotations

from pathlib import Path
import re
import sys
from typing import cast

from launch.frontend import expose_substitution
from launch.launch_context import LaunchContext
from launch.some_substitutions_type import SomeSubstitutionsType
from launch.source_location import explain_errors_with
from launch.substitution import MarkupArguments, Substitution
from launch.substitutions import PathJoinSubstitution, SubstitutionFailure
from launch.utilities import normalize_to_list_of_substitutions, perform_substitutions


class FindPackage(Substitution):
    """Base of the substitutions for a folder of a package on the AMENT_PREFIX_PATH."""

    _arguments = MarkupArguments('package', error=AttributeError)

    def __init__(self, package: SomeSubstitutionsType) -> None:
        self.package = normalize_to_list_of_substitutions(package)

    def __truediv__(self, part: SomeSubstitutionsType) -> PathJoinSubstitution:
        return PathJoinSubstitution([self, part])

    def find(self, package_name: str) -> str:
        """Return the folder.

        :raises LookupError: there is no such package.
        """
        raise NotImplementedError

    def describe(self) -> str:
        name = ' + '.join(sub.describe() for sub in self.package)
        return f'{type(self).__name__}(pkg={name})'

    def perform(self, context: LaunchContext) -> str:
        package = perform_substitutions(context, self.package)
        from ament_index_python import packages

        try:
            return self.find(package)
        except packages.PackageNotFoundError as error:
            from ros2_diagnosis.packages import why_missing

            hint = why_missing(package)
            raise packages.PackageNotFoundError(f'{error.args[0]}: {hint}') from None


@expose_substitution('find-pkg-prefix')
class FindPackagePrefix(FindPackage):
    """Becomes the prefix that a package is installed to."""

    def find(self, package_name: str) -> str:
        from ament_index_python.packages import get_package_prefix

        return cast(str, get_package_prefix(package_name))


@expose_substitution('find-pkg-share')
class FindPackageShare(FindPackage):
    """Becomes the share folder of a package, where launch files and the like are."""

    def find(self, package_name: str) -> str:
        from ament_index_python.packages import get_package_share_directory

        return cast(str, get_package_share_directory(package_name))


_BELOW_A_SHARE = re.compile(r"""/[^'"\s:]+/share/[^'"\s:]+""")


def _explain(error: BaseException) -> str:
    """Say why a package is missing that a launch file in Python asked for, or a file of one."""
    if isinstance(error, (OSError, SubstitutionFailure)):
        path = getattr(error, 'filename', None)
        if path is None and (named := _BELOW_A_SHARE.search(str(error))) is not None:
            path = named[0]
        if not isinstance(path, str) or '/share/' not in path:
            return ''
        from ros2_diagnosis.packages import why_not_in_share

        return why_not_in_share(Path(path)) or ''
    if isinstance(error, ModuleNotFoundError):
        from ros2_diagnosis import stand_ins

        return stand_ins.hint((error.name or '').partition('.')[0])
    packages = sys.modules.get('ament_index_python.packages')
    if packages is None or not isinstance(error, packages.PackageNotFoundError):
        return ''
    # What a substitution raised has its hint behind the list of folders.
    asked = re.fullmatch(r"package '(.*)' not found, searching: \[.*\]", str(error.args[0]))
    if asked is None:
        return ''
    from ros2_diagnosis.packages import why_missing

    return why_missing(asked[1])


explain_errors_with(_explain)
