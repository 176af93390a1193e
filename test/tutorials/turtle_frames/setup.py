# Copyright 2026 The Husky Playpen Lab authors
# SPDX-License-Identifier: Apache-2.0
"""Installs turtle_frames."""

from pathlib import Path

from setuptools import find_packages, setup

setup(
    name='turtle_frames',
    version='0.0.0',
    packages=find_packages(exclude=['test']),
    data_files=[
        ('share/ament_index/resource_index/packages', ['resource/turtle_frames']),
        ('share/turtle_frames', ['package.xml']),
        ('share/turtle_frames/launch', [str(path) for path in Path('launch').glob('*.launch.*')]),
    ],
    install_requires=['setuptools'],
    zip_safe=True,
    maintainer='The Husky Playpen Lab authors',
    maintainer_email='husky-playpen-lab@users.noreply.github.com',
    description='Turtles that follow each other by frames, in the manner of the tutorials.',
    license='Apache-2.0',
    entry_points={
        'console_scripts': [
            'broadcaster = turtle_frames.broadcaster:main',
            'carrot = turtle_frames.carrot:main',
            'follower = turtle_frames.follower:main',
            'standing = turtle_frames.standing:main',
            'watcher = turtle_frames.watcher:main',
        ]
    },
)
