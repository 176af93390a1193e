# Copyright 2026 The Husky Playpen Lab authors
# SPDX-License-Identifier: Apache-2.0
"""Let an editable installation place the data files; all else is in pyproject.toml."""

import setuptools


class Distribution(setuptools.Distribution):
    """Has the method by which setuptools' editable_wheel asks whether there are data files.

    It asks for `has_data`, but distutils calls it `has_data_files`, so that they are left out.
    """

    def has_data(self) -> bool:
        return self.has_data_files()


setuptools.setup(distclass=Distribution)
