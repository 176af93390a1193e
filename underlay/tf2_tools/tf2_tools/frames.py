# Copyright 2026 The Husky Playpen Lab authors
# SPDX-License-Identifier: Apache-2.0
"""The frames that a buffer knows, and upstream's picture of them for Graphviz."""

from __future__ import annotations

from dataclasses import dataclass

import yaml


@dataclass(frozen=True)
class Frame:
    """A frame that has a parent; times in seconds."""

    name: str
    parent: str
    broadcaster: str
    rate_hz: float
    most_recent_sec: float
    oldest_sec: float
    buffer_length_sec: float

    @property
    def is_static(self) -> bool:
        return self.most_recent_sec == self.oldest_sec == 0.0


def read_frames(frame_yaml: str) -> list[Frame]:
    """Read what a buffer, or the service `tf2_frames`, says of its frames."""
    # Every value is read as text: a frame may be named no, or 007.
    known: dict[str, dict[str, str]] = yaml.load(frame_yaml, Loader=yaml.BaseLoader) or {}
    return [
        Frame(
            name,
            frame['parent'],
            frame['broadcaster'],
            float(frame['rate']),
            float(frame['most_recent_transform']),
            float(frame['oldest_transform']),
            float(frame['buffer_length']),
        )
        for name, frame in known.items()
    ]


def generate_dot(frames: list[Frame], recorded_sec: float) -> str:
    """Return the picture as upstream writes it into its .gv file."""
    if not frames:
        return 'digraph G { "No tf data received" }'
    roots = [frame.parent for frame in frames if frame.parent not in {f.name for f in frames}]
    lines = ['digraph G {', *map(_arrow, frames), 'edge [style=invis];']
    lines += [
        ' subgraph cluster_legend { style=bold; color=black; label ="view_frames Result";',
        f'"Recorded at time: {recorded_sec}"[ shape=plaintext ] ;',
        f'}}->{_quoted(roots[-1])};' if roots else '}',  # a loop has no root
        '}',
    ]
    return '\n'.join(lines)


def _arrow(frame: Frame) -> str:
    return (
        f'{_quoted(frame.parent)} -> {_quoted(frame.name)}[label=" '
        f'Broadcaster: {frame.broadcaster}\\n'
        f'Average rate: {frame.rate_hz}\\n'
        f'Buffer length: {frame.buffer_length_sec}\\n'
        f'Most recent transform: {frame.most_recent_sec}\\n'
        f'Oldest transform: {frame.oldest_sec}\\n"];'
    )


def _quoted(name: str) -> str:
    escaped = name.replace('\\', '\\\\').replace('"', '\\"')
    return f'"{escaped}"'
