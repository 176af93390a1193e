# Copyright 2026 The Husky Playpen Lab authors
# SPDX-License-Identifier: Apache-2.0
import os
from pathlib import Path

from setuptools import find_packages, setup

package_name = 'husky_driver'

# The real folder, even where colcon builds through a link to this file. setuptools wants paths
# relative to where it runs.
here = Path(__file__).resolve().parent
config = here.parents[1] / 'config'


def installed(folder: Path, pattern: str, into: str) -> tuple[str, list[str]]:
    names = sorted(folder.glob(pattern))
    return (f'share/{package_name}/{into}', [os.path.relpath(name) for name in names])


setup(
    name=package_name,
    version='0.1.0',
    packages=find_packages(exclude=['test']),
    data_files=[
        ('share/ament_index/resource_index/packages', [f'resource/{package_name}']),
        (f'share/{package_name}', ['package.xml']),
        installed(here, 'launch/*.launch.py', 'launch'),
        installed(config, '*.yaml', 'config'),
        installed(config, '*.schema.json', 'config'),
        installed(config / 'waypoints', '*.yaml', 'config/waypoints'),
        installed(config / 'rubrics', '*.yaml', 'config/rubrics'),
    ],
    install_requires=['setuptools', 'numpy'],
    zip_safe=True,
    maintainer='The Husky Playpen Lab authors',
    maintainer_email='husky-playpen-lab@users.noreply.github.com',
    description='Drives the Husky along a path of waypoints.',
    license='Apache-2.0',
    entry_points={
        'console_scripts': [
            'follow_path = husky_driver.programs:follow_path',
            'teleop = husky_driver.programs:teleop',
            # Where students looked for them before.
            'check = husky_driver.programs:moved',
            'drive = husky_driver.programs:moved',
            'grade = husky_driver.programs:moved',
        ],
    },
)
