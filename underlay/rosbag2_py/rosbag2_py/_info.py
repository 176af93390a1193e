# Copyright 2026 The Husky Playpen Lab authors
# SPDX-License-Identifier: Apache-2.0
"""Tell what a bag holds."""

from __future__ import annotations

from pathlib import Path

from rosbag2_py import bag_files
from rosbag2_py._metadata import BagMetadata
from rosbag2_py._options import StorageOptions
from rosbag2_py.info_text import describe, services_of
from rosbag2_py.service_calls import count


class Info:
    """Reads what is known of a bag."""

    def read_metadata(self, uri: str, storage_id: str, /) -> BagMetadata:
        """
        Read the metadata.yaml of a bag, or the files themselves where there is none.

        :raises BagError: there is no bag, or it is stored in another way.
        """
        return bag_files.read_metadata(Path(uri), storage_id)

    def read_metadata_and_output_service_verbose(self, uri: str, storage_id: str, /) -> None:
        """
        Print what a bag holds, and of its services how many requests and responses.

        :raises BagError: it cannot be read, or holds something else than events there.
        """
        bag = self.read_metadata(uri, storage_id)
        options = StorageOptions(uri, storage_id)
        print(describe(bag, count(options, services_of(bag))))
