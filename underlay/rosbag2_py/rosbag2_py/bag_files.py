# Copyright 2026 The Husky Playpen Lab authors
# SPDX-License-Identifier: Apache-2.0
"""The files of a bag, and what they hold together."""

from __future__ import annotations

from collections.abc import Iterable
from pathlib import Path
from typing import NamedTuple

from rosbag2_py import compression
from rosbag2_py._metadata import BagMetadata, FileInformation, TopicInformation, VERSION
from rosbag2_py._metadata_io import FILE_NAME, MetadataIo
from rosbag2_py.errors import BagError
from rosbag2_py.storages import DEFAULT_ID, storage_of, STORAGES
from rosbag2_py.storages.interface import Contents, Span, Storage

_FIRST_WITH_NAMES_INSIDE = 4
"""Older versions of metadata.yaml name the files from the folder above that of the bag."""


class Files(NamedTuple):
    """The files of a bag in their order, and how they are stored."""

    storage: Storage
    paths: list[Path]


def find(path: Path, storage_id: str = '', *, as_named: bool = True) -> Files:
    """
    List the files of a bag, given as its folder or as one file.

    :param storage_id: how it is stored, or '' to find that out.
    :param as_named: those that metadata.yaml names, where there is one.
    :raises BagError: there is no bag, or it is stored in another way.
    """
    asked = storage_of(storage_id) if storage_id else None
    if path.is_file() and path.name == FILE_NAME:
        raise BagError(f"'{path}' is a part of a bag: name its folder, '{path.parent}'")
    if path.is_file():
        return Files(asked or _storage_of_file(path), [path])
    if not path.is_dir():
        raise BagError(f"Bag path '{path}' does not exist!")
    are_named = as_named and (path / FILE_NAME).is_file()
    files = (_named if are_named else _lying_about)(path, asked)
    for file in files.paths:
        if not file.is_file():
            what = 'is no file' if file.exists() else 'does not exist'
            where = f', named in {path / FILE_NAME},' * are_named
            raise BagError(f"'{file}'{where} {what}")
    return files


def read_metadata(path: Path, storage_id: str = '') -> BagMetadata:
    """
    Read the metadata.yaml of a bag, or the files themselves where there is none.

    :raises BagError: there is no bag, or it is stored in another way.
    """
    if storage_id:
        storage_of(storage_id)
    metadata_io = MetadataIo()
    if metadata_io.metadata_file_exists(str(path)):
        return metadata_io.read_metadata(str(path))
    return describe(path, storage_id)


def describe(path: Path, storage_id: str = '', *, as_named: bool = True) -> BagMetadata:
    """
    Tell what a bag holds from its files alone, whatever its metadata.yaml says.

    :param as_named: of the files that metadata.yaml names, where there is one.
    :raises BagError: there is no bag, or a file of it is damaged or stored in another way.
    """
    storage, paths = find(path, storage_id, as_named=as_named)
    contents = []
    for name in paths:
        with compression.read(storage, name) as file:
            contents.append(file.contents)
    bag, names = _told(contents), [_inside(name, path) for name in paths]
    bag.version = VERSION
    bag.storage_identifier = storage.id
    bag.bag_size = sum(each.size for each in contents)
    bag.relative_file_paths = names
    if any(file.suffix == compression.SUFFIX for file in paths):
        bag.compression_format, bag.compression_mode = 'zstd', 'FILE'
    elif bag.compression_mode == 'FILE':  # killed before any was compressed
        bag.compression_format = bag.compression_mode = ''
    bag.files = [
        FileInformation(name, each.span.start, each.span.duration, each.span.count)
        for name, each in zip(names, contents, strict=True)
    ]
    bag.topics_with_message_count = _topics(contents)
    whole = Span()
    for each in contents:
        whole.extend(each.span)
    bag.message_count = whole.count
    bag.starting_time, bag.duration = whole.start, whole.duration
    return bag


def _storage_of_file(path: Path) -> Storage:
    """Tell it by the first bytes, or by the name where they tell nothing."""
    try:
        with path.open('rb') as file:
            head = file.read(max(len(each.magic) for each in STORAGES.values()))
    except OSError as error:
        raise BagError(f"'{path}' cannot be read: {error.strerror}") from None
    for each in STORAGES.values():
        if head.startswith(each.magic):
            return each
    by_suffix = {each.suffix: each for each in STORAGES.values()}
    return by_suffix.get(compression.original(path).suffix, STORAGES[DEFAULT_ID])


def _named(folder: Path, asked: Storage | None) -> Files:
    """Return what metadata.yaml names."""
    metadata = MetadataIo().read_metadata(str(folder))
    storage = storage_of(metadata.storage_identifier)
    if asked not in (None, storage):
        raise BagError(
            f"'{folder}' is stored as {storage.id}: write storage_id='{storage.id}', or '' to "
            'have it found out'
        )
    base = folder
    if metadata.version < _FIRST_WITH_NAMES_INSIDE:
        base = folder.parent if folder.name not in ('', '..') else folder.resolve().parent
    paths = [base / name for name in metadata.relative_file_paths]
    return Files(storage, paths) if paths else _lying_about(folder, storage)


def _lying_about(folder: Path, asked: Storage | None) -> Files:
    """Return what is in a folder without a metadata.yaml that names it."""
    found = {}
    for storage in STORAGES.values():
        ends = (f'*{storage.suffix}{compression.SUFFIX}', f'*{storage.suffix}')
        files = {compression.original(path): path for end in ends for path in folder.glob(end)}
        # behind file 9 comes file 10
        paths = [files[name] for name in sorted(files, key=lambda file: (len(file.name), file))]
        if paths:
            found[storage.id] = Files(storage, paths)
    if asked and asked.id in found:
        return found[asked.id]
    suffixes = ' or '.join(each.suffix for each in ([asked] if asked else STORAGES.values()))
    if asked or not found:
        others = ', '.join(found)
        reason = f": its files are stored as {others}, write storage_id='{others}'" * bool(others)
        raise BagError(f"'{folder}' holds no file of a bag that ends with {suffixes}{reason}")
    if len(found) > 1:
        raise BagError(
            f"'{folder}' holds files that are stored as {' and as '.join(found)}, and no "
            f'{FILE_NAME} that says which are the bag: name one of them'
        )
    return next(iter(found.values()))


def _inside(file: Path, bag: Path) -> str:
    return str(file.relative_to(bag)) if file.is_relative_to(bag) and file != bag else str(file)


def _told(contents: list[Contents]) -> BagMetadata:
    """Return what the last file tells; what it does not, as where it was killed, those before."""
    bag = contents[-1].told
    for before in reversed(contents[:-1]):
        bag.custom_data = bag.custom_data or before.told.custom_data
        bag.ros_distro = bag.ros_distro or before.told.ros_distro
        bag.compression_format = bag.compression_format or before.told.compression_format
        bag.compression_mode = bag.compression_mode or before.told.compression_mode
    return bag


def _topics(contents: Iterable[Contents]) -> list[TopicInformation]:
    """Return the topics of all files by their names, each with all its messages."""
    found: dict[str, TopicInformation] = {}
    for file in contents:
        for each in file.topics:
            if each.topic_metadata.name in found:
                found[each.topic_metadata.name].message_count += each.message_count
            else:
                found[each.topic_metadata.name] = each
    return [found[name] for name in sorted(found)]
