# Copyright 2026 The Husky Playpen Lab authors
# SPDX-License-Identifier: Apache-2.0
# Tab completion of ros2, for those who type; a script does not pay the tenth of a second.
if [[ -o interactive ]] && command -v register-python-argcomplete >/dev/null; then
    (( $+functions[compdef] )) || { autoload -U +X compinit && compinit; }
    eval "$(register-python-argcomplete ros2)"
fi
