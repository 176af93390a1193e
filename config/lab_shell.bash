# Copyright 2026 The Husky Playpen Lab authors
# SPDX-License-Identifier: Apache-2.0
# Read by the bash of `./lab shell`: your own settings, then the lab's programs and tab completion.
# shellcheck shell=bash disable=SC1090
declare -A lab_paths=(
    [AMENT_PREFIX_PATH]=${AMENT_PREFIX_PATH:-} [LD_LIBRARY_PATH]=${LD_LIBRARY_PATH:-} [PYTHONPATH]=${PYTHONPATH:-}
)
if [[ -f ~/.bashrc ]]; then source ~/.bashrc; fi
PATH=$VIRTUAL_ENV/bin:$PATH
# Your settings may set these anew instead of adding to them, as many do for CUDA.
for lab_name in "${!lab_paths[@]}"; do
    if [[ -n ${lab_paths[$lab_name]} && :${!lab_name:-}: != *":${lab_paths[$lab_name]}:"* ]]; then
        export "$lab_name=${lab_paths[$lab_name]}${!lab_name:+:${!lab_name}}"
    fi
done
unset lab_paths lab_name
if [[ $HUSKY_LAB_ROS == pip ]]; then
    unset RMW_IMPLEMENTATION  # as in enter_venv of ./lab
    eval "$(register-python-argcomplete ros2 colcon)"
    source "$VIRTUAL_ENV/share/colcon_cd/function/colcon_cd.sh"
fi
PS1="(lab) $PS1"
