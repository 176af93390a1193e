# Copyright 2026 The Husky Playpen Lab authors
# SPDX-License-Identifier: Apache-2.0
# shellcheck shell=bash
# Tab completion of ros2, for those who type; a script does not pay the tenth of a second.
if [[ $- == *i* ]] && command -v register-python-argcomplete >/dev/null; then
    eval "$(register-python-argcomplete ros2)"
fi
