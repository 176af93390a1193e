# Copyright 2026 The Husky Playpen Lab authors
# SPDX-License-Identifier: Apache-2.0
"""A hostile client of the live page: it finds nothing, and STOP works all the while."""

from copy import deepcopy
import math
from pathlib import Path
import random
from typing import Any

import msgspec
from playpen_testing.listener import Listener
from playpen_testing.page_client import CAMERA, PageClient
from playpen_testing.processes import Process, Processes
from playpen_testing.spinning import SpunNodes
from playpen_testing.waiting import wait_until
import pytest
from std_msgs.msg import Bool
import viser

MESSAGES, TABS = 10_000, 25
LAST = 'Save and drive it'  # of the controls

# None clicks on a button, as only True does: what that does is no attack.
VALUES: list[Any] = [
    *(False, None, 0, 1, -1, 0.5, 2**63, -(2**63), 1e-320, math.nan, math.inf),
    *('', 'zzz', '(new)', '../../etc/passwd', '/etc/passwd\0', 'x' * 500, '\u202e', '<b>', '½×'),
    *([], {}, [[]], {'value': 1}, b'\x00', [1] * 100, {'__class__': 'x'}),
]
PROPERTIES = (
    *('value', 'options', 'min', 'max', 'label', 'visible', 'disabled', 'order', 'props'),
    *('update_cb', 'sync_cb', 'uuid', 'gui_api', 'removed', '_impl', '__class__', '__dict__'),
)
KINDS = [each.__name__ for each in viser._messages.Message.get_subclasses()]
FIELDS = (*('uuid', 'updates', 'name', 'frequency', 'phase', 'position', 'event_type'), *CAMERA)


class Forger:
    """
    Makes messages, the same of the same seed.

    :param controls: as viser has described them, by label.
    """

    def __init__(self, controls: dict[str, dict[str, Any]], seed: int) -> None:
        self._uuids = [control['uuid'] for control in controls.values()]
        self._random = random.Random(seed)

    def message(self) -> bytes:
        """Return a message: a forged value, a forged property, an unknown one, or garbage."""
        makers = (self._value, self._value, self._property, self._unknown, self._garbage)
        return self._random.choice(makers)()

    def _value(self) -> bytes:
        return self._update({'value': self._random.choice(VALUES)})

    def _property(self) -> bytes:
        names = self._random.sample(PROPERTIES, 2)
        return self._update({name: self._random.choice(VALUES) for name in names})

    def _update(self, updates: dict[str, Any]) -> bytes:
        uuid = self._random.choice(self._uuids)
        return msgspec.msgpack.encode(
            {'type': 'GuiUpdateMessage', 'uuid': uuid, 'updates': updates}
        )

    def _unknown(self) -> bytes:
        fields = {name: self._random.choice(VALUES) for name in self._random.sample(FIELDS, 4)}
        return msgspec.msgpack.encode({**CAMERA, **fields, 'type': self._random.choice(KINDS)})

    def _garbage(self) -> bytes:
        whole = msgspec.msgpack.encode(CAMERA)
        cut = self._random.randrange(len(whole))
        return whole[:cut] + self._random.randbytes(self._random.randrange(40))


@pytest.fixture
def view(processes: Processes, tmp_path: Path) -> Process:
    (tmp_path / 'waypoints').mkdir()
    processes.start('ros2', 'run', 'husky_sim', 'husky_sim')
    started = processes.start(
        *('ros2', 'run', 'husky_view', 'view', '--ros-args', '-p', 'viewer_port:=18980'),
        *('-p', f'waypoints_folder:={tmp_path / "waypoints"}'),
    )
    started.wait_for_text('look at http://')
    return started


@pytest.mark.timeout(180)
def test_ten_thousand_forged_messages_find_nothing(
    view: Process, nodes: SpunNodes, tmp_path: Path
) -> None:
    listener = nodes.start(Listener, {'e_stop': Bool})
    wait_until(
        lambda: listener.count_publishers('e_stop') > 0,
        timeout_sec=20.0,
        what='the page on e_stop',
    )
    address = view.output.split('look at ')[1].split()[0]
    with PageClient(address) as honest:
        honest.control(LAST)
        before = properties(honest)
        assert before.keys() >= {'STOP', 'Time', 'Speed', 'Open', 'Save as', LAST}
        for seed in range(TABS):
            with PageClient(address) as hostile:
                forger = Forger(honest.controls, seed)
                for _ in range(MESSAGES // TABS):
                    hostile.send(forger.message())
        honest.set('STOP', True)
        assert listener.latest('e_stop').data, 'STOP did not act'
        honest.control('Release the stop')
        honest.set('Release the stop', True)  # as one whose page still shows STOP
        while honest.control('Release the stop')['props']['disabled']:
            honest.read()
        honest.set('Release the stop', True)
        honest.control('STOP')
        heard = listener.heard['e_stop']
        wait_until(lambda: not heard[-1].data, timeout_sec=10.0, what='a release')
        assert all(each.data for each in heard[:-1]), 'a second click on STOP released it'
        with PageClient(address) as later:
            later.control(LAST)
            assert properties(later) == before
            while values(later) != values(honest):  # it has not read everything yet
                honest.read()
    assert view.returncode is None
    # From its address on: before, it may wait for a simulator that comes late, and say so.
    (place,) = [number for number, line in enumerate(view.lines) if address in line]
    assert view.lines[place + 1 :] == ['the page is open']
    assert [file.name for file in tmp_path.rglob('*.yaml')] == []


def values(page: PageClient) -> dict[str, Any]:
    """Return what was set, and by whomever."""
    return {label: control['props'].get('value') for label, control in page.controls.items()}


def properties(page: PageClient) -> dict[str, dict[str, Any]]:
    """Return now what only the server may set; values are there to be set by a page."""
    return {
        label: {
            name: deepcopy(value) for name, value in control['props'].items() if name != 'value'
        }
        for label, control in page.controls.items()
    }
