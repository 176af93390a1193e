# Copyright 2026 The Husky Playpen Lab authors
# SPDX-License-Identifier: Apache-2.0
from setuptools import find_packages, setup

package_name = 'my_driver'

setup(
    name=package_name,
    version='0.1.0',
    packages=find_packages(exclude=['test']),
    data_files=[
        ('share/ament_index/resource_index/packages', [f'resource/{package_name}']),
        (f'share/{package_name}', ['package.xml']),
    ],
    install_requires=['setuptools'],
    zip_safe=True,
    maintainer='Your name',
    maintainer_email='you@example.com',
    description='Drives the Husky along a path.',
    license='Apache-2.0',
    entry_points={'console_scripts': ['follow_path = my_driver.follow_path:main']},
)
