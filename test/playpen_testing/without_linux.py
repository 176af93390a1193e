# Copyright 2026 The Husky Playpen Lab authors
# SPDX-License-Identifier: Apache-2.0
"""
Take from a Python what only Linux has, before anything of ours is imported.

Python imports this file where it lies on PYTHONPATH under the name `sitecustomize`. Taken are the
name of the system, `/proc` and `/dev/shm`, `sched_getaffinity`, `prctl`, sockets with abstract
names, EGL and OSMesa. What this Python itself is made for stays, and so do psutil, which reads
/proc, and compiled code.
"""

import builtins
from collections.abc import Callable
import ctypes
import ctypes.util
import glob
import io
import os
import pathlib
from pathlib import Path
import socket
import sys
import sysconfig
from types import BuiltinFunctionType
from typing import Any
import urllib.request  # noqa: F401  on macOS it needs a module of that system, as ctypes.util does

import psutil

FOLDERS = ('/proc', '/dev/shm')
SEEN_VARIABLE = 'WITHOUT_LINUX_SEEN'  # a folder in which every program leaves its name


def _refusing(function: Callable[..., Any]) -> Callable[..., Any]:
    def call(path: Any = '.', *more: Any, **named: Any) -> Any:
        asker = sys._getframe(1).f_globals.get('__name__', '')
        if isinstance(path, (str, bytes, os.PathLike)) and not asker.startswith(psutil.__name__):
            name = os.fsdecode(path)
            if any(name == folder or name.startswith(f'{folder}/') for folder in FOLDERS):
                raise FileNotFoundError(2, 'No such file or directory', name)
        return function(path, *more, **named)

    return call


class _Library(ctypes.CDLL):
    def __getattr__(self, name: str) -> Any:
        if name == 'prctl':
            raise AttributeError(name)
        return super().__getattr__(name)


class _Socket(socket.socket):
    def bind(self, address: Any, /) -> None:
        if isinstance(address, (str, bytes)) and address[:1] in ('\0', b'\0'):
            raise FileNotFoundError(2, 'No such file or directory', address)
        super().bind(address)


def take_away() -> None:
    names = ('open', 'stat', 'lstat', 'scandir', 'listdir', 'readlink', 'access')
    refusing = {each: _refusing(each) for each in (io.open, *(getattr(os, n) for n in names))}
    builtins.open = io.open = refusing[io.open]  # type: ignore[assignment]
    for name in names:
        setattr(os, name, refusing[getattr(os, name)])
    # Some classes keep the functions: those of pathlib in Python 3.10, of glob from 3.13 on.
    for kept in (each for module in (glob, pathlib) for each in vars(module).values()):
        for name, value in [*vars(kept).items()] if isinstance(kept, type) else ():
            function = getattr(value, '__func__', value)
            if isinstance(function, BuiltinFunctionType) and function in refusing:
                setattr(kept, name, staticmethod(refusing[function]))
    del os.sched_getaffinity
    ctypes.CDLL = _Library  # type: ignore[misc]
    socket.socket = _Socket  # type: ignore[misc]
    for name in ('mujoco.egl', 'mujoco.osmesa'):
        sys.modules[name] = None  # type: ignore[assignment]  # to import it is an ImportError
    sysconfig.get_config_vars()  # once, from a module with the name of the system
    sys.platform = 'darwin'


if __name__ == 'sitecustomize':
    take_away()
    if folder := os.environ.get(SEEN_VARIABLE):
        Path(folder, f'{os.getpid()}').write_text(' '.join(sys.orig_argv), encoding='utf-8')
