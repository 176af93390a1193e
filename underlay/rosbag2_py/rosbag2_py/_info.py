# Copyright 2026 The Husky Playpen Lab authors
# SPDX-License-Identifier: Apache-2.0
"""Tell what a bag holds."""

from __future__ import annotations

from pathlib import Path

from rosbag2_py import bag_files
from rosbag2_py._metadata import BagMetadata
from rosbag2_py._metadata_io import MetadataIo
from rosbag2_py.errors import BagError
from rosbag2_py.storages import storage_of


class Info:
    """Reads what is known of a bag."""

    def read_metadata(self, uri: str, storage_id: str, /) -> BagMetadata:
        """
        Read the metadata.yaml of a bag, or the files themselves where there is none.

        :raises BagError: there is no bag, or it is stored in another way.
        """
        return read_metadata(Path(uri), storage_id)

    def read_metadata_and_output_service_verbose(self, uri: str, storage_id: str, /) -> None:
        raise BagError(
            f'Requests and responses of services are not counted here; `ros2 bag info {uri}` '
            'counts their messages'
        )


def read_metadata(path: Path, storage_id: str) -> BagMetadata:
    if storage_id:
        storage_of(storage_id)
    metadata_io = MetadataIo()
    if metadata_io.metadata_file_exists(str(path)):
        return metadata_io.read_metadata(str(path))
    return bag_files.describe(path, storage_id)
