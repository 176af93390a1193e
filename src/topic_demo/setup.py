# Copyright 2026 The Husky Playpen Lab authors
# SPDX-License-Identifier: Apache-2.0
from setuptools import find_packages, setup

package_name = 'topic_demo'

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
    maintainer='The Husky Playpen Lab authors',
    maintainer_email='husky-playpen-lab@users.noreply.github.com',
    description='A publisher and a subscriber: the first two nodes of the lab.',
    license='Apache-2.0',
    entry_points={
        'console_scripts': [
            'publisher = topic_demo.publisher:main',
            'subscriber = topic_demo.subscriber:main',
        ],
    },
)
