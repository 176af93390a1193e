# Copyright 2026 The Husky Playpen Lab authors
# SPDX-License-Identifier: Apache-2.0
# Read by the bash of `./lab shell`: your own settings, then the lab's programs and tab completion.
# shellcheck shell=bash disable=SC1090
if [[ -f ~/.bashrc ]]; then source ~/.bashrc; fi
PATH=$VIRTUAL_ENV/bin:$PATH
if [[ $HUSKY_LAB_ROS == pip ]]; then
    eval "$(register-python-argcomplete ros2 colcon)"
    source "$VIRTUAL_ENV/share/colcon_cd/function/colcon_cd.sh"
fi
PS1="(lab) $PS1"
