# Copyright 2026 The Husky Playpen Lab authors
# SPDX-License-Identifier: Apache-2.0
# shellcheck shell=sh
# Read by the bash or zsh of `./lab shell` after your own settings. These may set anew what the lab has
# set, instead of adding to it, or activate another environment; LAB_... is what it was.
export VIRTUAL_ENV="$LAB_VIRTUAL_ENV"
for lab_name in PATH AMENT_PREFIX_PATH LD_LIBRARY_PATH PYTHONPATH; do
    eval "lab_was=\${LAB_$lab_name:-} lab_now=\${$lab_name:-}"
    case ":$lab_now:" in
        *":$lab_was:"*) ;;
        *) [ -z "$lab_was" ] || export "$lab_name=$lab_was${lab_now:+:$lab_now}" ;;
    esac
    unset "LAB_$lab_name"
done
[ "${PATH%%:*}" = "$VIRTUAL_ENV/bin" ] || export PATH="$VIRTUAL_ENV/bin:$PATH"
unset lab_name lab_was lab_now LAB_VIRTUAL_ENV
[ "$HUSKY_LAB_ROS" != pip ] || unset RMW_IMPLEMENTATION # as in enter_venv of ./lab
PS1="(lab) $PS1"
