# Copyright 2026 The Husky Playpen Lab authors
# SPDX-License-Identifier: Apache-2.0
"""Messages of several topics brought together by their stamps, kept, and passed on.

As in Jazzy, `DeltaFilter` is in `message_filters.delta_filter` and `InputAligner` in
`message_filters.input_aligner`, and a cache spells `getLastestTime`. What Python of Jazzy lacks is
not here: `TimeSequencer`, `getLatestTime`, `queue_offset` and `sync_arrival_time` came later,
`LatestTime` and `ApproximateEpsilonTime` are in C++ alone.
"""

from message_filters.cache import Cache
from message_filters.chain import Chain
from message_filters.simple_filter import SimpleFilter
from message_filters.subscriber import Subscriber
from message_filters.synchronizers import ApproximateTimeSynchronizer, TimeSynchronizer

__all__ = [
    'ApproximateTimeSynchronizer',
    'Cache',
    'Chain',
    'SimpleFilter',
    'Subscriber',
    'TimeSynchronizer',
]
