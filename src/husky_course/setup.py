# Copyright 2026 The Husky Playpen Lab authors
# SPDX-License-Identifier: Apache-2.0
from setuptools import find_packages, setup

setup(
    name='husky_course',
    version='0.1.0',
    packages=find_packages(exclude=['test']),
    data_files=[
        ('share/ament_index/resource_index/packages', ['resource/husky_course']),
        ('share/husky_course', ['package.xml']),
    ],
    install_requires=['setuptools', 'numpy', 'PyYAML'],
    zip_safe=True,
    maintainer='The Husky Playpen Lab authors',
    maintainer_email='husky-playpen-lab@users.noreply.github.com',
    description='Waypoint files, routes, obstacles seen from above, and the record of a run.',
    license='Apache-2.0',
)
