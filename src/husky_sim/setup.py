# Copyright 2026 The Husky Playpen Lab authors
# SPDX-License-Identifier: Apache-2.0
"""Installs husky_sim: the simulator, its launch files and the worlds."""

import os
from pathlib import Path

from setuptools import find_packages, setup

PACKAGE = 'husky_sim'

# The real folder, even where colcon builds through a link to this file. setuptools wants paths
# relative to where it runs. The worlds lie at the top of the repository.
HERE = Path(__file__).resolve().parent


def installed(folder: Path, pattern: str) -> tuple[str, list[str]]:
    names = sorted(folder.glob(pattern))
    return (f'share/{PACKAGE}/{folder.name}', [os.path.relpath(name) for name in names])


setup(
    name=PACKAGE,
    version='0.1.0',
    packages=find_packages(exclude=['test']),
    data_files=[
        ('share/ament_index/resource_index/packages', [f'resource/{PACKAGE}']),
        (f'share/{PACKAGE}', ['package.xml']),
        installed(HERE / 'launch', '*.launch.py'),
        installed(HERE / 'config', '*.yaml'),
        installed(HERE / 'hook', 'check_fields.*'),
        installed(HERE / 'meshes', '*.stl'),
        installed(HERE.parents[1] / 'worlds', '*.xml'),
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
