# Copyright 2026 The Husky Playpen Lab authors
# SPDX-License-Identifier: Apache-2.0
from setuptools import setup

setup(
    name='shape_nodes',
    version='0.0.0',
    packages=['shape_nodes'],
    data_files=[
        ('share/ament_index/resource_index/packages', ['resource/shape_nodes']),
        ('share/shape_nodes', ['package.xml']),
    ],
    entry_points={'console_scripts': ['shapes = shape_nodes.shapes:main']},
)
