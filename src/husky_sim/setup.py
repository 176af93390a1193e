# Copyright 2026 The Husky Playpen Lab authors
# SPDX-License-Identifier: Apache-2.0
"""Installs husky_sim: the simulator, its launch files and the worlds."""

import os
from pathlib import Path

from setuptools import find_packages, setup

PACKAGE = 'husky_sim'

# The worlds lie at the top of the repository. colcon copies or links setup.py into its build
# folder, so the way to them starts at the file's real path and is written down relative to the
# folder setup runs in, as data_files must be.
WORLDS = Path(__file__).resolve().parents[2] / 'worlds'


def data_files_of(folder: Path, pattern: str) -> list[str]:
    """List the files of a folder, relative to the current one."""
    return sorted(os.path.relpath(path, Path.cwd()) for path in folder.glob(pattern))


setup(
    name=PACKAGE,
    version='0.1.0',
    packages=find_packages(exclude=['test']),
    data_files=[
        ('share/ament_index/resource_index/packages', [f'resource/{PACKAGE}']),
        (f'share/{PACKAGE}', ['package.xml']),
        (
            f'share/{PACKAGE}/launch',
            data_files_of(Path(__file__).resolve().parent / 'launch', '*.launch.py'),
        ),
        (
            f'share/{PACKAGE}/config',
            data_files_of(Path(__file__).resolve().parent / 'config', '*.yaml'),
        ),
        (
            f'share/{PACKAGE}/hook',
            data_files_of(Path(__file__).resolve().parent / 'hook', 'check_fields.*'),
        ),
        (f'share/{PACKAGE}/worlds', data_files_of(WORLDS, '*.xml')),
    ],
    install_requires=['setuptools', 'mujoco', 'numpy'],
    zip_safe=True,
    maintainer='The Husky Playpen Lab authors',
    maintainer_email='husky-playpen-lab@users.noreply.github.com',
    description='Clearpath Huskies in the playpen, simulated with MuJoCo, as a ROS 2 node.',
    license='Apache-2.0',
    entry_points={
        'console_scripts': [
            'husky_sim = husky_sim.programs:main',
            'replay = husky_sim.programs:moved',
            'view = husky_sim.programs:moved',
        ]
    },
)
