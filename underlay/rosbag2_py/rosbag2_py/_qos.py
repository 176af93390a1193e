# Copyright 2026 The Husky Playpen Lab authors
# SPDX-License-Identifier: Apache-2.0
"""Qualities of service as a bag keeps them, under the names of rclcpp and rmw."""

from __future__ import annotations

import copy
import enum
from typing import Any, TypeVar

from rosbag2_py._fields import whole
from rosbag2_py.errors import BagError

P = TypeVar('P', bound='_Policy')
_SEC = 10**9


class _Policy(enum.Enum):
    """A policy, which is a number in bags before version 9 and a word since."""

    def __int__(self) -> int:
        return int(self.value)

    __index__ = __int__

    @property
    def word(self) -> str:
        return self.name.removeprefix(f'{self.prefix()}_').lower()

    @classmethod
    def prefix(cls) -> str:
        return cls.__name__.removesuffix('_policy_t').replace('rmw_qos', 'rmw_qos_policy').upper()

    @classmethod
    def of(cls: type[P], value: Any) -> P:
        for each in cls:
            if value in (each.value, each.word):
                return each
        return cls[f'{cls.prefix()}_UNKNOWN']


class rmw_qos_history_policy_t(_Policy):  # noqa: N801
    """How many messages are kept."""

    RMW_QOS_POLICY_HISTORY_SYSTEM_DEFAULT = 0
    RMW_QOS_POLICY_HISTORY_KEEP_LAST = 1
    RMW_QOS_POLICY_HISTORY_KEEP_ALL = 2
    RMW_QOS_POLICY_HISTORY_UNKNOWN = 3


class rmw_qos_reliability_policy_t(_Policy):  # noqa: N801
    """Whether what is lost is sent again."""

    RMW_QOS_POLICY_RELIABILITY_SYSTEM_DEFAULT = 0
    RMW_QOS_POLICY_RELIABILITY_RELIABLE = 1
    RMW_QOS_POLICY_RELIABILITY_BEST_EFFORT = 2
    RMW_QOS_POLICY_RELIABILITY_UNKNOWN = 3


class rmw_qos_durability_policy_t(_Policy):  # noqa: N801
    """Whether who comes later still gets what was sent."""

    RMW_QOS_POLICY_DURABILITY_SYSTEM_DEFAULT = 0
    RMW_QOS_POLICY_DURABILITY_TRANSIENT_LOCAL = 1
    RMW_QOS_POLICY_DURABILITY_VOLATILE = 2
    RMW_QOS_POLICY_DURABILITY_UNKNOWN = 3


class rmw_qos_liveliness_policy_t(_Policy):  # noqa: N801
    """How a publisher shows that it lives."""

    RMW_QOS_POLICY_LIVELINESS_SYSTEM_DEFAULT = 0
    RMW_QOS_POLICY_LIVELINESS_AUTOMATIC = 1
    RMW_QOS_POLICY_LIVELINESS_MANUAL_BY_TOPIC = 3
    RMW_QOS_POLICY_LIVELINESS_UNKNOWN = 4


_POLICIES: dict[str, type[_Policy]] = {
    'history': rmw_qos_history_policy_t,
    'reliability': rmw_qos_reliability_policy_t,
    'durability': rmw_qos_durability_policy_t,
    'liveliness': rmw_qos_liveliness_policy_t,
}
_DURATIONS = ('deadline', 'lifespan', 'liveliness_lease_duration')


class Duration:
    """rclcpp's duration, for the qualities of service alone."""

    def __init__(self, seconds: int, nanoseconds: int) -> None:
        self._seconds = whole(32, signed=True)(seconds)
        self._nanoseconds = whole(32)(nanoseconds)


class QoS:
    """rclcpp's qualities of service; each method changes one of them and can be chained."""

    def __init__(self, history_depth: int) -> None:
        self._values: dict[str, Any] = {
            'history': rmw_qos_history_policy_t.RMW_QOS_POLICY_HISTORY_KEEP_LAST,
            'depth': whole(64)(history_depth),
            'reliability': rmw_qos_reliability_policy_t.RMW_QOS_POLICY_RELIABILITY_RELIABLE,
            'durability': rmw_qos_durability_policy_t.RMW_QOS_POLICY_DURABILITY_VOLATILE,
            'deadline': 0,
            'lifespan': 0,
            'liveliness': rmw_qos_liveliness_policy_t.RMW_QOS_POLICY_LIVELINESS_SYSTEM_DEFAULT,
            'liveliness_lease_duration': 0,
            'avoid_ros_namespace_conventions': False,
        }

    def _with(self, **changes: Any) -> QoS:
        for name, value in changes.items():
            kind = _POLICIES.get(name, Duration if name in _DURATIONS else object)
            if not isinstance(value, kind):
                raise TypeError(f'QoS.{name}({value!r}): it takes a {kind.__name__}')
            if isinstance(value, Duration):
                self._values[name] = value._seconds * _SEC + value._nanoseconds
            else:
                self._values[name] = value
        changed = copy.copy(self)
        changed._values = dict(self._values)
        return changed

    def keep_last(self, depth: int) -> QoS:
        keep = rmw_qos_history_policy_t.RMW_QOS_POLICY_HISTORY_KEEP_LAST
        return self._with(history=keep, depth=whole(64)(depth))

    def keep_all(self) -> QoS:
        keep = rmw_qos_history_policy_t.RMW_QOS_POLICY_HISTORY_KEEP_ALL
        return self._with(history=keep, depth=0)

    def reliable(self) -> QoS:
        return self.reliability(rmw_qos_reliability_policy_t.of('reliable'))

    def best_effort(self) -> QoS:
        return self.reliability(rmw_qos_reliability_policy_t.of('best_effort'))

    def durability_volatile(self) -> QoS:
        return self.durability(rmw_qos_durability_policy_t.of('volatile'))

    def transient_local(self) -> QoS:
        return self.durability(rmw_qos_durability_policy_t.of('transient_local'))

    def history(self, policy: rmw_qos_history_policy_t) -> QoS:
        return self._with(history=policy)

    def reliability(self, policy: rmw_qos_reliability_policy_t) -> QoS:
        return self._with(reliability=policy)

    def durability(self, policy: rmw_qos_durability_policy_t) -> QoS:
        return self._with(durability=policy)

    def liveliness(self, policy: rmw_qos_liveliness_policy_t) -> QoS:
        return self._with(liveliness=policy)

    def deadline(self, deadline: Duration) -> QoS:
        return self._with(deadline=deadline)

    def lifespan(self, lifespan: Duration) -> QoS:
        return self._with(lifespan=lifespan)

    def liveliness_lease_duration(self, duration: Duration) -> QoS:
        return self._with(liveliness_lease_duration=duration)

    def avoid_ros_namespace_conventions(self, avoid: bool) -> QoS:
        return self._with(avoid_ros_namespace_conventions=bool(avoid))


def to_dicts(profiles: list[QoS]) -> list[dict[str, Any]]:
    """Return what version 9 of metadata.yaml has for some qualities of service."""
    found = []
    for profile in profiles:
        values = dict(profile._values)
        for name in _POLICIES:
            values[name] = values[name].word
        for name in _DURATIONS:
            values[name] = dict(zip(('sec', 'nsec'), divmod(values[name], _SEC), strict=True))
        found.append(values)
    return found


def from_dicts(content: Any) -> list[QoS]:
    """Read what a metadata.yaml of any version has for some qualities of service.

    :raises KeyError, TypeError, ValueError: it is none of them.
    """
    profiles = []
    for values in content or []:
        profile = QoS(int(values['depth']))
        for name, kind in _POLICIES.items():
            profile._values[name] = kind.of(values[name])
        for name in _DURATIONS:
            profile._values[name] = values[name]['sec'] * _SEC + values[name]['nsec']
        avoid = bool(values['avoid_ros_namespace_conventions'])
        profile._values['avoid_ros_namespace_conventions'] = avoid
        profiles.append(profile)
    return profiles


def to_rclcpp_qos_vector(serialized: str, version: int) -> list[QoS]:
    """Read the qualities of service that a file or an old metadata.yaml has as a text."""
    import yaml

    del version  # The text shows by itself whether it has numbers or words.
    try:
        return from_dicts(yaml.safe_load(serialized))
    except (yaml.YAMLError, KeyError, TypeError, ValueError, RecursionError) as error:
        why = ' '.join(str(error).split())
        raise BagError(f'no list of qualities of service: {serialized!r}: {why}') from None


def profiles_or_none(serialized: str) -> list[QoS]:
    """Read what a file has, or nothing of it: the defaults suit every subscription."""
    try:
        return to_rclcpp_qos_vector(serialized, 9)
    except BagError:
        return []


def convert_rclcpp_qos_to_rclpy_qos(qos: QoS) -> Any:
    """Return an rclpy.qos.QoSProfile, as publishers and subscriptions take it."""
    from rclpy.duration import Duration as RclpyDuration
    from rclpy.qos import QoSProfile

    values = dict(qos._values)
    for name in _POLICIES:
        values[name] = values[name].value
    for name in _DURATIONS:
        values[name] = RclpyDuration(nanoseconds=values[name])
    return QoSProfile(**values)
