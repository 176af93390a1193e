# Copyright 2026 The Husky Playpen Lab authors
# SPDX-License-Identifier: Apache-2.0
from setuptools import find_packages, setup

setup(
    name='husky_grader',
    version='0.1.0',
    packages=find_packages(exclude=['test']),
    package_data={
        'husky_grader': [
            *('outputs/*.css', 'outputs/*.jinja', 'report/*.css', 'report/*.jinja'),
            *('jail/*.xml', 'autograder/gradescope_scripts/*'),
        ],
    },
    data_files=[
        ('share/ament_index/resource_index/packages', ['resource/husky_grader']),
        ('share/husky_grader', ['package.xml']),
        ('share/husky_grader/launch', ['launch/drive.launch.py']),
    ],
    install_requires=[
        'setuptools',
        'distributed',
        'jinja2',
        'markupsafe',
        'mcap',
        'numpy',
        'psutil',
        'PyYAML',
        'resvg-py',
    ],
    zip_safe=False,
    maintainer='The Husky Playpen Lab authors',
    maintainer_email='husky-playpen-lab@users.noreply.github.com',
    description='Judges runs: check of a course, rehearsal, score, live runs, classes, reports.',
    license='Apache-2.0',
    entry_points={
        'console_scripts': [
            'check = husky_grader.programs:check',
            'drive = husky_grader.programs:drive',
            'grade = husky_grader.programs:grade',
        ],
        'husky_driver.route_check': [
            'playpen = husky_grader.playpen:check_route',
        ],
    },
)
