# Copyright 2026 The Husky Playpen Lab authors
# SPDX-License-Identifier: Apache-2.0
"""The services by which a player and a recorder of bags are controlled."""

from __future__ import annotations

from collections.abc import Callable
from typing import Any

from ros2cli.node.direct import CommandNode
from rosbag2_interfaces.srv import (
    Burst,
    GetRate,
    IsPaused,
    Pause,
    Play,
    PlayNext,
    Resume,
    Seek,
    SetRate,
    Snapshot,
    SplitBagfile,
    Stop,
    TogglePaused,
)

from ros2bag.playback import Playback
from ros2bag.recorder import Recorder


def control_player(node: CommandNode, playback: Playback) -> None:
    _create(node, Pause, 'pause', lambda _: playback.pause())
    _create(node, Resume, 'resume', lambda _: playback.resume())
    _create(node, TogglePaused, 'toggle_paused', lambda _: playback.toggle_paused())
    _create(node, IsPaused, 'is_paused', lambda _: playback.is_paused, 'paused')
    _create(node, GetRate, 'get_rate', lambda _: playback.rate, 'rate')
    _create(node, SetRate, 'set_rate', lambda asked: playback.set_rate(asked.rate), 'success')
    _create(node, PlayNext, 'play_next', lambda _: playback.play_next(), 'success')
    _create(node, Play, 'play', lambda _: playback.play_again(), 'success')
    _create(node, Stop, 'stop', lambda _: playback.stop())
    _create(node, Seek, 'seek', lambda asked: playback.seek(_ns(asked.time)), 'success')
    _create(
        node, Burst, 'burst', lambda asked: playback.burst(asked.num_messages), 'actually_burst'
    )


def control_recorder(node: CommandNode, recorder: Recorder) -> None:
    _create(node, Pause, 'pause', lambda _: recorder.pause())
    _create(node, Resume, 'resume', lambda _: recorder.resume())
    _create(node, IsPaused, 'is_paused', lambda _: recorder.is_paused, 'paused')
    if recorder.takes_snapshots:
        _create(node, Snapshot, 'snapshot', lambda _: recorder.snapshot(), 'success')
    _create(node, SplitBagfile, 'split_bagfile', lambda _: recorder.split())


def _ns(time: Any) -> int:
    return int(time.sec) * 10**9 + int(time.nanosec)


def _create(
    node: CommandNode, kind: Any, name: str, act: Callable[[Any], Any], field: str = ''
) -> None:
    """Create a service that answers with what is done, in a field where it has one."""

    def on_request(request: Any, response: Any) -> Any:
        answer = act(request)
        if field:
            setattr(response, field, answer)
        return response

    node.node.create_service(kind, f'~/{name}', on_request)
