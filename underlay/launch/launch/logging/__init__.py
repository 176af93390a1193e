# Copyright 2026 The Husky Playpen Lab authors
# SPDX-License-Identifier: Apache-2.0
"""Logging of the launch itself and of what processes print."""

from __future__ import annotations

from collections.abc import Callable, Iterable, Mapping
import logging
import os
from pathlib import Path
import tempfile
from typing import Any, Literal
import warnings

from . import handlers
from .log_folder import logging_directory as _get_logging_directory
from .log_folder import make_unique_log_dir as _make_unique_log_dir
from .log_folder import renew_latest_log_dir as _renew_latest_log_dir

__all__ = [
    'get_logger',
    'get_output_loggers',
    'handlers',
    'launch_config',
    'log_launch_config',
    'reset',
]

_DEFAULT_SCREEN_FORMAT = '[{levelname}] [{name}]: {message}'
_WITH_TIME = '{created:.7f} [{levelname}] [{name}]: {message}'
_OUTPUT_ON_SCREEN = logging.Formatter('{message}', style='{')
_OUTPUT_IN_FILE = logging.Formatter('{created:.7f} {message}', style='{')

_Style = Literal['%', '{', '$']
_Destinations = str | Iterable[str]
OutputConfig = str | Mapping[str, _Destinations]


def _formatter(
    wanted: str | None, style: _Style | None, aliases: Mapping[str, str], variable: str
) -> logging.Formatter | None:
    """Return the formatter of a format or an alias; the environment variable wins."""
    override = os.environ.get(variable)
    if override:
        return logging.Formatter(override.encode('latin1').decode('unicode_escape'), style='{')
    if wanted is None:
        return None
    if wanted in aliases:
        if style is not None:
            raise ValueError(f'Cannot set a custom format style for the "{wanted}" format.')
        return logging.Formatter(aliases[wanted], style='{')
    return logging.Formatter(wanted, style=style or '{')


class LaunchConfig:
    """How and where a launch logs; ``launch_config`` is the only one."""

    def __init__(self) -> None:
        self.reset()

    def reset(self) -> None:
        self._log_dir: str | None = None
        self.file_handlers: dict[str, logging.Handler] = {}
        self.screen_handler: handlers.ScreenHandler | None = None
        self.screen_formatter: logging.Formatter | None = None
        self.file_formatter: logging.Formatter | None = None
        self.log_file_name = 'launch.log'
        self.log_handler_factory: Callable[..., logging.Handler] = handlers.FileHandler
        logging.root.setLevel(logging.INFO)
        self.set_screen_format('default')
        self.set_log_format('default')

    @property
    def level(self) -> int:
        return logging.root.getEffectiveLevel()

    @level.setter
    def level(self, new_level: int) -> None:
        logging.root.setLevel(new_level)

    @property
    def log_dir(self) -> str:
        """The folder of the log files, made when first asked for."""
        if self._log_dir is None:
            self._log_dir = _new_log_dir()
        return self._log_dir

    @log_dir.setter
    def log_dir(self, new_log_dir: str | None) -> None:
        if new_log_dir is not None and not Path(new_log_dir).is_dir():
            raise ValueError(f'{new_log_dir} is not a directory')
        self._log_dir = new_log_dir

    def set_screen_format(
        self, screen_format: str | None, *, screen_style: _Style | None = None
    ) -> None:
        """Set the format of the screen: 'default', 'default_with_timestamp' or one of logging."""
        aliases = {'default': _DEFAULT_SCREEN_FORMAT, 'default_with_timestamp': _WITH_TIME}
        self.screen_formatter = _formatter(
            screen_format, screen_style, aliases, 'OVERRIDE_LAUNCH_SCREEN_FORMAT'
        )
        if self.screen_handler is not None:
            self.screen_handler.setFormatter(self.screen_formatter)

    def set_log_format(self, log_format: str | None, *, log_style: _Style | None = None) -> None:
        """Set the format of the log files: 'default' or one of logging."""
        self.file_formatter = _formatter(
            log_format, log_style, {'default': _WITH_TIME}, 'OVERRIDE_LAUNCH_LOG_FORMAT'
        )
        for handler in self.file_handlers.values():
            handler.setFormatter(self.file_formatter)

    def get_screen_handler(self) -> handlers.ScreenHandler:
        if self.screen_handler is None:
            self.screen_handler = handlers.ScreenHandler()
            self.screen_handler.setFormatter(self.screen_formatter)
        return self.screen_handler

    def get_log_file_path(self, file_name: str = 'launch.log') -> str:
        return str(Path(self.log_dir) / file_name)

    def get_log_file_handler(self, file_name: str = 'launch.log') -> logging.Handler:
        """Return the handler of a log file, always the same one."""
        if file_name not in self.file_handlers:
            path = self.get_log_file_path(file_name)
            handler = self.log_handler_factory(path, encoding='utf-8')
            handler.setFormatter(self.file_formatter)
            self.file_handlers[file_name] = handler
        return self.file_handlers[file_name]


launch_config = LaunchConfig()


def _new_log_dir() -> str:
    """Make a folder for logs, in the temporary folder where the proper one cannot be written."""
    base = _get_logging_directory()
    try:
        log_dir = _make_unique_log_dir(base_path=base)
    except OSError as error:
        log_dir = _make_unique_log_dir(base_path=str(Path(tempfile.gettempdir()) / 'ros-log'))
        warnings.warn(
            f'cannot write logs below {base} ({error.strerror}): they go to {log_dir}; set '
            'ROS_LOG_DIR to a folder you may write',
            stacklevel=3,
        )
        return log_dir
    try:
        if not _renew_latest_log_dir(log_dir=log_dir):
            warnings.warn("'latest' beside the log directory is no link: it stays", stacklevel=3)
    except OSError as error:
        warnings.warn(f'Cannot create a symlink to latest log directory: {error}', stacklevel=3)
    return log_dir


def log_launch_config(*, logger: logging.Logger = logging.root) -> None:
    """Tell where the log files are and from which level on is logged."""
    if launch_config.file_handlers:
        logger.info(f'All log files can be found below {launch_config.log_dir}')
    level = logging.getLevelName(logging.root.getEffectiveLevel())
    logger.info(f'Default logging verbosity is set to {level}')


_handlers_of: dict[logging.Logger, set[logging.Handler]] = {}


def _add(logger: logging.Logger, handler: logging.Handler) -> None:
    _handlers_of.setdefault(logger, set()).add(handler)
    logger.addHandler(handler)


def get_logger(name: str | None = None) -> logging.Logger:
    """Return a logger that writes to the screen and the main log file of the launch."""
    logger = logging.getLogger(name)
    if logger is not logging.root:
        logger.propagate = False  # 'launch' would log what 'launch.user' has logged once more
    _add(logger, launch_config.get_screen_handler())
    _add(logger, launch_config.get_log_file_handler(launch_config.log_file_name))
    return logger


_NAMED_CONFIGS: dict[str, dict[str, set[str]]] = {
    'screen': {'both': {'screen'}},
    'log': {'both': {'log'}, 'stderr': {'screen'}},
    'both': {'both': {'log', 'screen'}},
    'own_log': {'both': {'own_log'}, 'stdout': {'own_log'}, 'stderr': {'own_log'}},
    'full': {
        'both': {'screen', 'log', 'own_log'},
        'stdout': {'own_log'},
        'stderr': {'own_log'},
    },
}


def _normalize_output_configuration(config: Any) -> dict[str, set[str]]:
    """Return where both streams, and each for itself, go.

    :raises ValueError: a stream or a destination that does not exist.
    """
    normalized: dict[str, set[str]] = {'both': set(), 'stdout': set(), 'stderr': set()}
    if isinstance(config, str):
        if config not in _NAMED_CONFIGS:
            raise ValueError(
                f"output '{config}' is not a valid standard output config: use one of "
                f'{", ".join(_NAMED_CONFIGS)}'
            )
        normalized.update(_NAMED_CONFIGS[config])
        return normalized
    if not isinstance(config, Mapping):
        raise ValueError(f'output {config!r} is neither a name nor a dictionary of streams')
    for source, destinations in config.items():
        names = {destinations} if isinstance(destinations, str) else set(destinations)
        if source not in normalized:
            raise ValueError(f"'{source}' is not a valid output source: stdout, stderr or both")
        unknown = names - {'screen', 'log', 'own_log'}
        if unknown:
            raise ValueError(
                f'{", ".join(sorted(unknown))} is not a valid output destination: screen, log or '
                'own_log'
            )
        normalized[source] = names
    return normalized


def _format_for(
    logger: logging.Logger, handler: logging.Handler, formatter: logging.Formatter
) -> None:
    if isinstance(handler, handlers.FormatPerLogger):
        handler.setFormatterFor(logger, formatter)
    _add(logger, handler)


def get_output_loggers(
    process_name: str, output_config: OutputConfig
) -> tuple[logging.Logger, logging.Logger]:
    """Return the loggers of what a process writes to stdout and stderr.

    :param output_config: 'screen', 'log', 'both', 'own_log', 'full', or a dictionary from
        'stdout', 'stderr' and 'both' to sets of 'screen', 'log' and 'own_log'.
    """
    config = _normalize_output_configuration(output_config)
    loggers = []
    for source in ('stdout', 'stderr'):
        logger = logging.getLogger(f'{process_name}-{source}')
        logger.setLevel(logging.INFO)
        logger.propagate = False
        destinations = config['both'] | config[source]
        if 'screen' in destinations:
            _format_for(logger, launch_config.get_screen_handler(), _OUTPUT_ON_SCREEN)
        if 'log' in destinations:
            main = launch_config.get_log_file_handler(launch_config.log_file_name)
            _format_for(logger, main, _OUTPUT_IN_FILE)
        if 'own_log' in config[source]:
            own = launch_config.get_log_file_handler(f'{process_name}-{source}.log')
            _format_for(logger, own, _OUTPUT_ON_SCREEN)
        if 'own_log' in config['both']:
            own = launch_config.get_log_file_handler(f'{process_name}.log')
            _format_for(logger, own, _OUTPUT_ON_SCREEN)
        loggers.append(logger)
    return loggers[0], loggers[1]


def reset() -> None:
    """Forget every handler, level and setting, as a test wants between two launches."""
    for logger, known in _handlers_of.items():
        logger.setLevel(logging.NOTSET)
        for handler in known:
            logger.removeHandler(handler)
            handler.close()
    for handler in launch_config.file_handlers.values():
        handler.close()
    _handlers_of.clear()
    launch_config.reset()
