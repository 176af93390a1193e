# Copyright 2026 The Husky Playpen Lab authors
# SPDX-License-Identifier: Apache-2.0
"""
The services of simulation_interfaces.

No wheel has the package, so plain classes with its fields and constants stand in for the
generated ones; what they steer is the real node.
"""

from collections.abc import Callable, Iterator
from pathlib import Path
import sys
from types import SimpleNamespace
from typing import Any

from husky_sim.ros.node import SimulatorNode
from husky_sim.ros.simulation_services import add_simulation_services
import pytest
from rclpy.context import Context
from rclpy.parameter import Parameter

OK, UNSUPPORTED, INCORRECT_STATE, FAILED = 1, 0, 3, 4
STOPPED, PLAYING, PAUSED, QUITTING = 0, 1, 2, 3


class Result(SimpleNamespace):
    RESULT_FEATURE_UNSUPPORTED, RESULT_OK = 0, 1
    RESULT_NOT_FOUND, RESULT_INCORRECT_STATE, RESULT_OPERATION_FAILED = 2, 3, 4


class SimulationState(SimpleNamespace):
    STATE_STOPPED, STATE_PLAYING, STATE_PAUSED, STATE_QUITTING = 0, 1, 2, 3


class SimulatorFeatures(SimpleNamespace):
    SIMULATION_RESET = 20
    SIMULATION_STATE_GETTING, SIMULATION_STATE_SETTING, SIMULATION_STATE_PAUSE = 24, 25, 26
    STEP_SIMULATION_SINGLE, STEP_SIMULATION_MULTIPLE = 31, 32


def service(**constants: dict[str, int]) -> SimpleNamespace:
    """Make a service type, with the constants of its request and its response."""
    parts = {part: type(part, (SimpleNamespace,), constants.get(part, {})) for part in PARTS}
    return SimpleNamespace(**parts)


PARTS = ('Request', 'Response')
SERVICES = SimpleNamespace(
    GetSimulatorFeatures=service(),
    GetSimulationState=service(),
    SetSimulationState=service(
        Response={
            'ALREADY_IN_TARGET_STATE': 101,
            'STATE_TRANSITION_ERROR': 102,
            'INCORRECT_TRANSITION': 103,
        }
    ),
    ResetSimulation=service(
        Request={'SCOPE_DEFAULT': 0, 'SCOPE_TIME': 1, 'SCOPE_STATE': 2, 'SCOPE_SPAWNED': 4}
    ),
    StepSimulation=service(),
)
MESSAGES = SimpleNamespace(
    Result=Result, SimulationState=SimulationState, SimulatorFeatures=SimulatorFeatures
)
Call = Callable[..., Any]


class Recorder:
    """Takes services as a node does, and calls them."""

    def __init__(self) -> None:
        self.offered: dict[str, tuple[Any, Callable[[Any, Any], Any]]] = {}

    def create_service(self, kind: Any, name: str, callback: Callable[[Any, Any], Any]) -> None:
        self.offered[name] = kind, callback

    def call(self, name: str, **request: Any) -> Any:
        kind, callback = self.offered[f'~/{name}']
        return callback(kind.Request(**request), kind.Response())


@pytest.fixture
def simulator(domain_id: int, worlds: Path) -> Iterator[SimulatorNode]:
    context = Context()
    context.init(domain_id=domain_id)
    world = Parameter('world', value=str(worlds / 'empty.xml'))
    node = SimulatorNode(context=context, parameter_overrides=[world])
    yield node
    node.destroy_node()
    context.try_shutdown()


@pytest.fixture
def call(simulator: SimulatorNode, monkeypatch: pytest.MonkeyPatch) -> Call:
    package = SimpleNamespace(msg=MESSAGES, srv=SERVICES)
    monkeypatch.setitem(sys.modules, 'simulation_interfaces', package)
    recorder = Recorder()
    assert add_simulation_services(recorder, simulator)
    return recorder.call


def set_state(call: Call, target: int) -> int:
    return int(call('set_simulation_state', state=SimulationState(state=target)).result.result)


def state(call: Call) -> int:
    answer = call('get_simulation_state')
    assert answer.result.result == OK
    return int(answer.state.state)


def test_without_the_package_there_are_no_such_services(monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setitem(sys.modules, 'simulation_interfaces', None)
    recorder = Recorder()
    assert not add_simulation_services(recorder, SimpleNamespace())  # type: ignore[arg-type]
    assert recorder.offered == {}


def test_the_features_are_those_that_there_are(call: Call) -> None:
    features = call('get_simulator_features').features
    assert features.features == [20, 24, 25, 26, 31, 32]
    assert '0.02 s' in features.custom_info


def test_playing_pausing_and_stopping(simulator: SimulatorNode, call: Call) -> None:
    assert state(call) == PLAYING
    assert set_state(call, PLAYING) == 101, 'already in the target state'
    simulator.advance()
    assert set_state(call, PAUSED) == OK
    assert (state(call), simulator.paused) == (PAUSED, True)
    assert simulator.simulation.periods == 1, 'a pause resets nothing'
    assert set_state(call, STOPPED) == OK
    assert (state(call), simulator.paused) == (STOPPED, True)
    assert simulator.simulation.periods == 0, 'a stop is a pause and a reset'
    assert set_state(call, STOPPED) == 101
    assert set_state(call, PLAYING) == OK
    assert (state(call), simulator.paused) == (PLAYING, False)


def test_a_state_that_cannot_be_reached_is_refused(call: Call) -> None:
    assert set_state(call, QUITTING) == UNSUPPORTED
    answer = call('set_simulation_state', state=SimulationState(state=9))
    assert answer.result.result == 103
    assert answer.result.error_message.startswith('state=9: ')
    assert state(call) == PLAYING


def test_steps_are_control_periods_of_a_paused_run(simulator: SimulatorNode, call: Call) -> None:
    answer = call('step_simulation', steps=1)
    assert answer.result.result == INCORRECT_STATE
    assert 'needs a paused simulation' in answer.result.error_message
    set_state(call, PAUSED)
    assert call('step_simulation', steps=5).result.result == OK
    assert simulator.simulation.time_sec == 0.1
    for steps in (0, 2**64 - 1):
        assert call('step_simulation', steps=steps).result.result == FAILED
    set_state(call, STOPPED)
    assert call('step_simulation', steps=1).result.result == INCORRECT_STATE
    assert simulator.simulation.periods == 0


@pytest.mark.parametrize(
    ('scope', 'result'), [(0, OK), (255, OK), (3, OK), (1, UNSUPPORTED), (4, UNSUPPORTED)]
)
def test_a_reset_puts_back_time_and_state_together(
    simulator: SimulatorNode, call: Call, scope: int, result: int
) -> None:
    simulator.advance()
    assert call('reset_simulation', scope=scope).result.result == result
    assert simulator.simulation.periods == (0 if result == OK else 1)
