# Copyright 2026 The Husky Playpen Lab authors
# SPDX-License-Identifier: Apache-2.0
"""
The services that control a run: ~/reset, ~/pause and ~/step.

Where the package simulation_interfaces is installed, its state services do the same, for tools
that control any simulator in this way: ~/get_simulator_features, ~/get_simulation_state,
~/set_simulation_state, ~/reset_simulation and ~/step_simulation. Result codes are those of
Result.msg and SetSimulationState.srv, release 1.0.
"""

from typing import Any, Protocol

from rclpy.node import Node
from std_srvs.srv import Empty, SetBool, Trigger

from husky_sim.config import CONTROL_PERIOD_SEC

MOST_STEPS = 3000
"""A minute of simulated time: signals wait until the steps of one call are made."""

_FEATURES = (
    'SIMULATION_RESET',
    'SIMULATION_STATE_GETTING',
    'SIMULATION_STATE_SETTING',
    'SIMULATION_STATE_PAUSE',
    'STEP_SIMULATION_SINGLE',
    'STEP_SIMULATION_MULTIPLE',
)


class Run(Protocol):
    """What services control; `at_start`: no time has passed since the start or a reset."""

    @property
    def paused(self) -> bool: ...

    @property
    def at_start(self) -> bool: ...

    @property
    def time_sec(self) -> float: ...

    def pause(self, paused: bool) -> None: ...

    def advance(self) -> None: ...

    def reset(self) -> None: ...


class ControlServices:
    """Offers the services of one run under its node."""

    def __init__(self, node: Node, run: Run) -> None:
        self._run = run
        node.create_service(Empty, '~/reset', self._on_reset)
        node.create_service(SetBool, '~/pause', self._on_pause)
        node.create_service(Trigger, '~/step', self._on_step)

    def _on_reset(self, _: Empty.Request, response: Empty.Response) -> Empty.Response:
        self._run.reset()
        return response

    def _on_pause(self, request: SetBool.Request, response: SetBool.Response) -> SetBool.Response:
        self._run.pause(request.data)
        response.success = True
        response.message = f'{"paused" if request.data else "going on"} at {self._now()}'
        return response

    def _on_step(self, _: Trigger.Request, response: Trigger.Response) -> Trigger.Response:
        response.success = self._run.paused
        if self._run.paused:
            self._run.advance()
            response.message = f'stepped to {self._now()}'
        else:
            response.message = 'a step needs a paused simulation; call ~/pause with true first'
        return response

    def _now(self) -> str:
        return f'{self._run.time_sec:.2f} s of simulated time'


def add_simulation_services(node: Any, run: Run) -> bool:
    """Create the services under the node; tell whether simulation_interfaces is there."""
    try:
        from simulation_interfaces import msg, srv
    except ImportError:
        return False
    SimulationServices(node, run, msg, srv)
    return True


class SimulationServices:
    """Translates between the services and a run."""

    def __init__(self, node: Any, run: Run, messages: Any, services: Any) -> None:
        self._run = run
        self._result = messages.Result
        self._state = messages.SimulationState
        self._features = messages.SimulatorFeatures
        self._reset = services.ResetSimulation.Request
        self._transition = services.SetSimulationState.Response
        self._stopped = False
        for kind, name, callback in (
            (services.GetSimulatorFeatures, 'get_simulator_features', self._on_features),
            (services.GetSimulationState, 'get_simulation_state', self._on_get_state),
            (services.SetSimulationState, 'set_simulation_state', self._on_set_state),
            (services.ResetSimulation, 'reset_simulation', self._on_reset),
            (services.StepSimulation, 'step_simulation', self._on_step),
        ):
            node.create_service(kind, f'~/{name}', callback)

    def state(self) -> int:
        """Return a state of SimulationState: stopped is paused at the start."""
        if not self._run.paused:
            self._stopped = False
            return int(self._state.STATE_PLAYING)
        self._stopped = self._stopped and self._run.at_start
        return int(self._state.STATE_STOPPED if self._stopped else self._state.STATE_PAUSED)

    def _answer(self, response: Any, code: int, message: str = '') -> Any:
        response.result = self._result(result=code, error_message=message)
        return response

    def _on_features(self, _: Any, response: Any) -> Any:
        response.features = self._features(
            features=[getattr(self._features, name) for name in _FEATURES],
            custom_info=f'husky_sim: one step is a control period of {CONTROL_PERIOD_SEC:g} s',
        )
        return response

    def _on_get_state(self, _: Any, response: Any) -> Any:
        response.state = self._state(state=self.state())
        return self._answer(response, self._result.RESULT_OK)

    def _on_set_state(self, request: Any, response: Any) -> Any:
        target = request.state.state
        if target == self.state():
            return self._answer(response, self._transition.ALREADY_IN_TARGET_STATE)
        if target == self._state.STATE_QUITTING:
            return self._answer(
                response,
                self._result.RESULT_FEATURE_UNSUPPORTED,
                'the simulator ends with its process; send that a SIGINT (Ctrl-C)',
            )
        known = (self._state.STATE_PLAYING, self._state.STATE_PAUSED, self._state.STATE_STOPPED)
        if target not in known:
            return self._answer(
                response,
                self._transition.INCORRECT_TRANSITION,
                f'state={target}: stopped (0), playing (1) and paused (2) are allowed',
            )
        self._run.pause(target != self._state.STATE_PLAYING)
        self._stopped = target == self._state.STATE_STOPPED
        if self._stopped:
            self._run.reset()
        return self._answer(response, self._result.RESULT_OK)

    def _on_reset(self, request: Any, response: Any) -> Any:
        both = self._reset.SCOPE_TIME | self._reset.SCOPE_STATE
        if request.scope != self._reset.SCOPE_DEFAULT and request.scope & both != both:
            return self._answer(
                response,
                self._result.RESULT_FEATURE_UNSUPPORTED,
                f'scope={request.scope}: time and state are reset together; use 0 (everything)',
            )
        self._run.reset()
        return self._answer(response, self._result.RESULT_OK)

    def _on_step(self, request: Any, response: Any) -> Any:
        if self.state() != self._state.STATE_PAUSED:
            return self._answer(
                response,
                self._result.RESULT_INCORRECT_STATE,
                'a step needs a paused simulation; call ~/set_simulation_state with 2 first',
            )
        if not 1 <= request.steps <= MOST_STEPS:
            return self._answer(
                response,
                self._result.RESULT_OPERATION_FAILED,
                f'steps={request.steps}: 1 to {MOST_STEPS} are allowed; call again for more',
            )
        for _ in range(request.steps):
            self._run.advance()
        return self._answer(response, self._result.RESULT_OK)
