# Copyright 2026 The Husky Playpen Lab authors
# SPDX-License-Identifier: Apache-2.0
"""The files of a Python package (build type ament_python)."""

from __future__ import annotations

from ros2pkg.creation.package import NewPackage

_SETUP = """\
from setuptools import find_packages, setup

package_name = '{name}'

setup(
    name=package_name,
    version='{version}',
    packages=find_packages(exclude=['test']),
    data_files=[
        ('share/ament_index/resource_index/packages',
            ['resource/' + package_name]),
        ('share/' + package_name, ['package.xml']),
    ],
    install_requires=['setuptools'],
    zip_safe=True,
    maintainer={maintainer!r},
    maintainer_email={email!r},
    description={description!r},
    license={license!r},
    extras_require={{
        'test': [
            'pytest',
        ],
    }},
    entry_points={{
        'console_scripts': [{scripts}],
    }},
)
"""
_SETUP_CFG = """\
[develop]
script_dir=$base/lib/{name}
[install]
install_scripts=$base/lib/{name}
"""
_NODE = """\
def main():
    print('Hi from {name}.')


if __name__ == '__main__':
    main()
"""
# The linters are part of a full ROS 2; where they are missing, their tests are skipped.
_TEST_COPYRIGHT = """\
import pytest


# Remove this line when every source file has its copyright notice.
@pytest.mark.skip(reason='No copyright header has been placed in the generated source file.')
@pytest.mark.copyright
@pytest.mark.linter
def test_copyright():
    linter = pytest.importorskip('ament_copyright.main')
    assert linter.main(argv=['.', 'test']) == 0, 'Found errors'
"""
_TEST_FLAKE8 = """\
import pytest


@pytest.mark.flake8
@pytest.mark.linter
def test_flake8():
    linter = pytest.importorskip('ament_flake8.main')
    rc, errors = linter.main_with_errors(argv=[])
    assert rc == 0, \\
        'Found %d code style errors / warnings:\\n' % len(errors) + \\
        '\\n'.join(errors)
"""
_TEST_PEP257 = """\
import pytest


@pytest.mark.linter
@pytest.mark.pep257
def test_pep257():
    linter = pytest.importorskip('ament_pep257.main')
    assert linter.main(argv=['.', 'test']) == 0, 'Found code style errors / warnings'
"""
# Without it, pytest warns of the markers of the linters.
_PYTEST_INI = """\
[pytest]
markers =
    copyright
    flake8
    linter
    pep257
"""


def files(package: NewPackage) -> dict[str, str]:
    """Return the texts of the package's files by their paths."""
    name = package.name
    scripts = ''
    if package.node_name:
        scripts = (
            f"\n            '{package.node_name} = {name}.{package.node_name}:main',\n        "
        )
    found = {
        'setup.py': _SETUP.format(
            name=name,
            version=package.version,
            maintainer=package.maintainer_name,
            email=package.maintainer_email,
            description=package.description,
            license=package.license,
            scripts=scripts or '\n        ',
        ),
        'setup.cfg': _SETUP_CFG.format(name=name),
        'pytest.ini': _PYTEST_INI,
        f'resource/{name}': '',
        f'{name}/__init__.py': '',
        'test/test_copyright.py': _TEST_COPYRIGHT,
        'test/test_flake8.py': _TEST_FLAKE8,
        'test/test_pep257.py': _TEST_PEP257,
    }
    if package.node_name:
        found[f'{name}/{package.node_name}.py'] = _NODE.format(name=name)
    if package.library_name:
        found[f'{name}/{package.library_name}/__init__.py'] = ''
    return found
