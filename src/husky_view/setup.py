# Copyright 2026 The Husky Playpen Lab authors
# SPDX-License-Identifier: Apache-2.0
from setuptools import find_packages, setup

setup(
    name='husky_view',
    version='0.1.0',
    packages=find_packages(exclude=['test']),
    data_files=[
        ('share/ament_index/resource_index/packages', ['resource/husky_view']),
        ('share/husky_view', ['package.xml']),
        # Where husky_playpen.launch.py looks for views.
        (
            'share/ament_index/resource_index/husky_sim.view',
            ['resource/husky_sim.view/husky_view'],
        ),
        # Where `drive` looks for what plays its run.
        (
            'share/ament_index/resource_index/husky_grader.replay',
            ['resource/husky_grader.replay/husky_view'],
        ),
    ],
    install_requires=[
        'setuptools',
        'mujoco',
        'mjviser',
        'msgspec',
        'numpy',
        'trimesh',
        'viser',
        'websockets',
    ],
    zip_safe=True,
    maintainer='The Husky Playpen Lab authors',
    maintainer_email='husky-playpen-lab@users.noreply.github.com',
    description='The playpen in the browser: live, as a replay, and with an editor of waypoints.',
    license='Apache-2.0',
    entry_points={
        'console_scripts': [
            'replay = husky_view.programs:replay',
            'view = husky_view.programs:view',
        ],
    },
)
