# Copyright 2026 The Husky Playpen Lab authors
# SPDX-License-Identifier: Apache-2.0
"""
The simulated Husky as an environment of Gymnasium; to import this registers it.

Gymnasium calls modules by themselves, too: `gymnasium.make('husky_gym:HuskyPlaypen-v0')`.
"""

try:
    import gymnasium
except ModuleNotFoundError as error:
    raise ModuleNotFoundError(
        f'{error}: the set-up of the lab leaves it out; in its folder, `./lab exec pip install '
        '-c requirements/constraints.txt -r requirements/gym.in` installs it',
        name=error.name,
    ) from None

gymnasium.register(id='HuskyPlaypen-v0', entry_point='husky_gym.environment:HuskyPlaypen')
