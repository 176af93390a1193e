# Copyright 2026 The Husky Playpen Lab authors
# SPDX-License-Identifier: Apache-2.0
from pathlib import Path

from setuptools import setup

setup(
    name='zoo',
    version='0.1.0',
    packages=['zoo'],
    data_files=[
        ('share/ament_index/resource_index/packages', ['resource/zoo']),
        ('share/zoo', ['package.xml']),
        ('lib/zoo', sorted(map(str, Path('bin').iterdir()))),
        ('share/zoo/launch', sorted(map(str, Path('launch').iterdir()))),
    ],
    install_requires=['setuptools'],
    zip_safe=False,
)
