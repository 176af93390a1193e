# Copyright 2026 The Husky Playpen Lab authors
# SPDX-License-Identifier: Apache-2.0
"""What can be wrong with a lookup.

    TransformException
    ├── ConnectivityException     the frames are in trees that nothing connects
    ├── LookupException           there is no such frame, or the tree has a loop
    ├── ExtrapolationException    the frames are there, but not at that time
    ├── InvalidArgumentException  the name of a frame that cannot be one
    └── TimeoutException          a server of transforms has not answered

They name `tf2` as their module, as those in C++ do: a traceback reads the same.
"""


class TransformException(Exception):  # noqa: N818 - upstream's name
    __module__ = 'tf2'


class ConnectivityException(TransformException):
    __module__ = 'tf2'


class LookupException(TransformException):
    __module__ = 'tf2'


class ExtrapolationException(TransformException):
    __module__ = 'tf2'


class InvalidArgumentException(TransformException):
    __module__ = 'tf2'


class TimeoutException(TransformException):
    __module__ = 'tf2'
