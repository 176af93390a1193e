# Copyright 2026 The Husky Playpen Lab authors
# SPDX-License-Identifier: Apache-2.0
from setuptools import find_packages, setup

setup(
    name='husky_runtime',
    version='0.1.0',
    packages=find_packages(exclude=['test']),
    data_files=[
        ('share/ament_index/resource_index/packages', ['resource/husky_runtime']),
        ('share/husky_runtime', ['package.xml']),
    ],
    install_requires=['setuptools', 'psutil'],
    zip_safe=True,
    maintainer='The Husky Playpen Lab authors',
    maintainer_email='husky-playpen-lab@users.noreply.github.com',
    description='How programs of the lab start, spin and end; DDS domains and child processes.',
    license='Apache-2.0',
    entry_points={
        'console_scripts': [
            'supervise = husky_runtime.supervise:program',
        ],
    },
)
