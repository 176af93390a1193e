# Copyright 2026 The Husky Playpen Lab authors
# SPDX-License-Identifier: Apache-2.0
"""Make the metadata.yaml of a bag whose recording was killed."""

from __future__ import annotations

from pathlib import Path

from rosbag2_py import bag_files
from rosbag2_py._metadata_io import FILE_NAME, MetadataIo
from rosbag2_py._options import StorageOptions
from rosbag2_py.errors import BagError


class Reindexer:
    """Writes metadata.yaml anew from the files of a bag, which stay as they are."""

    def reindex(self, storage_options: StorageOptions, /) -> None:
        """
        Write the metadata.yaml of a folder.

        :raises BagError: it has no files of a bag, or one of them is damaged; a metadata.yaml
            that is there stays then.
        """
        folder = Path(storage_options.uri)
        if not folder.is_dir():
            raise BagError(f"'{folder}' is no folder of a bag")
        bag = bag_files.describe(folder, storage_options.storage_id, as_named=False)
        (folder / FILE_NAME).unlink(missing_ok=True)
        MetadataIo().write_metadata(str(folder), bag)
