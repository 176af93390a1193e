# Copyright 2026 The Husky Playpen Lab authors
# SPDX-License-Identifier: Apache-2.0
"""The scenes of a recorded run."""

from husky_course.record import COLUMNS, read_record, Record
from husky_sim.recording import PlayedRun
from husky_sim.scene_topic import Scene, TRACK
from husky_sim.world import World


def load_run(path: str) -> Record:
    """
    Read a record, or the one in a report's folder, from the first command on.

    :raises RecordRefused: if there is none, or it is not one of ours.
    """
    return read_record(path).since_first_command()


class RunScenes:
    """
    Makes the scenes of a run.

    :raises RecordRefused: if the world lacks something that was pushed.
    """

    def __init__(self, run: Record, world: World) -> None:
        self._run = run
        self._played = PlayedRun(run, world)
        first = COLUMNS.index(TRACK[0])
        self._track = run.rows[:, :, first : first + len(TRACK)]

    def scene(self, first: int, last: int, *, paused: bool) -> Scene:
        """Return the scene at entry `last`, with the track from entry `first` on."""
        rows = slice(first, last + 1)
        return Scene(
            paused=paused,
            qpos=self._played.qpos(last),
            time_sec=self._run.time_sec[rows],
            track=self._track[rows],
        )
