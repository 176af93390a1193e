# Copyright 2026 The Husky Playpen Lab authors
# SPDX-License-Identifier: Apache-2.0
"""Place what is no module; all else is in pyproject.toml."""

import sysconfig

import setuptools

# Where Python looks at its start, relative to the virtual environment.
SITE_PACKAGES = sysconfig.get_path('purelib', vars={'base': '', 'platbase': ''}).lstrip('/')

# What makes the virtual environment an ament prefix that workspaces can be built upon, rqt_graph a
# package of it, and every Python of it loads so that it can be interrupted.
DATA_FILES = {
    '.': ['prefix/local_setup.sh', 'prefix/local_setup.bash', 'prefix/local_setup.zsh'],
    SITE_PACKAGES: ['prefix/interrupt_while_loading.pth'],
    'lib/rqt_graph': ['lib/rqt_graph/rqt_graph'],
    'share/rqt_graph': ['share/rqt_graph/package.xml'],
    'share/ament_index/resource_index/packages': [
        'share/ament_index/resource_index/packages/rqt_graph',
    ],
}


class Distribution(setuptools.Distribution):
    """Has the method by which setuptools' editable_wheel asks whether there are data files.

    It asks for `has_data`, but distutils calls it `has_data_files`, so that they are left out.
    """

    def has_data(self) -> bool:
        return self.has_data_files()


setuptools.setup(distclass=Distribution, data_files=list(DATA_FILES.items()), scripts=['bin/ros2'])
