# Copyright 2026 The Husky Playpen Lab authors
# SPDX-License-Identifier: Apache-2.0
"""Install the module, and the files that make a virtual environment an ament prefix."""

import sysconfig

import setuptools

NAME = 'interrupt_while_loading'
# Where Python looks at its start, relative to the virtual environment; it depends on the version
# of Python, so that flit, which installs the other distributions, cannot place a file there.
SITE_PACKAGES = sysconfig.get_path('purelib', vars={'base': '', 'platbase': ''}).lstrip('/')


class Distribution(setuptools.Distribution):
    """Has the method by which setuptools' editable_wheel asks whether there are data files.

    It asks for `has_data`, but distutils calls it `has_data_files`, so that they are left out.
    """

    def has_data(self) -> bool:
        return self.has_data_files()


setuptools.setup(
    distclass=Distribution,
    name=NAME,
    version='0.1.0',
    packages=[NAME],
    package_dir={'': '.'},  # makes the editable install one path instead of an import hook
    package_data={NAME: ['py.typed']},
    data_files=[
        ('.', ['prefix/local_setup.sh', 'prefix/local_setup.bash', 'prefix/local_setup.zsh']),
        (SITE_PACKAGES, ['prefix/interrupt_while_loading.pth']),
        (f'share/{NAME}', ['package.xml']),
        ('share/ament_index/resource_index/packages', [f'resource/{NAME}']),
    ],
    scripts=['bin/python_held_back', 'bin/python_of_setup_files'],
)
