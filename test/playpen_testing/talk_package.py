# Copyright 2026 The Husky Playpen Lab authors
# SPDX-License-Identifier: Apache-2.0
"""A small package of students, to be written and then broken."""

from pathlib import Path

FILES = {
    'package.xml': """\
<?xml version="1.0"?>
<package format="3">
  <name>talk</name>
  <version>0.0.0</version>
  <description>Two programs</description>
  <maintainer email="someone@example.org">someone</maintainer>
  <license>Apache-2.0</license>
  <export><build_type>ament_python</build_type></export>
</package>
""",
    'setup.cfg': """\
[develop]
script_dir=$base/lib/talk
[install]
install_scripts=$base/lib/talk
""",
    'setup.py': """\
from setuptools import find_packages, setup

package_name = 'talk'

setup(
    name=package_name,
    packages=find_packages(exclude=['test']),
    data_files=[
        ('share/ament_index/resource_index/packages', ['resource/' + package_name]),
        ('share/' + package_name, ['package.xml']),
    ],
    entry_points={
        'console_scripts': [
            'hello = talk.hello:main',
        ],
    },
)
""",
    'resource/talk': '',
    'talk/__init__.py': '',
    'talk/hello.py': "def main():\n    print('hello')\n",
}
BUILD_TYPE = '<export><build_type>ament_python</build_type></export>'


def write_package(folder: Path) -> Path:
    """Write the package into a folder, and return that."""
    for name, text in FILES.items():
        (folder / name).parent.mkdir(parents=True, exist_ok=True)
        (folder / name).write_text(text)
    return folder


def replace(path: Path, old: str, new: str) -> None:
    """Replace a text that is in a file."""
    text = path.read_text()
    assert old in text
    path.write_text(text.replace(old, new))
