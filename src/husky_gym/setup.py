# Copyright 2026 The Husky Playpen Lab authors
# SPDX-License-Identifier: Apache-2.0
from setuptools import find_packages, setup

setup(
    name='husky_gym',
    version='0.1.0',
    packages=find_packages(exclude=['test']),
    data_files=[
        ('share/ament_index/resource_index/packages', ['resource/husky_gym']),
        ('share/husky_gym', ['package.xml']),
    ],
    install_requires=['setuptools', 'gymnasium', 'mujoco', 'numpy'],
    zip_safe=True,
    maintainer='The Husky Playpen Lab authors',
    maintainer_email='husky-playpen-lab@users.noreply.github.com',
    description='The simulated Husky on its course as an environment of Gymnasium.',
    license='Apache-2.0',
)
