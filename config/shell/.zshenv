# Copyright 2026 The Husky Playpen Lab authors
# SPDX-License-Identifier: Apache-2.0
# Read by the zsh of `./lab shell`, as ZDOTDIR is this folder: your own settings, all of them, then, before
# the first prompt, the lab's programs and tab completion.
lab_shell=$ZDOTDIR
if [[ -n $LAB_ZDOTDIR ]]; then ZDOTDIR=$LAB_ZDOTDIR; else unset ZDOTDIR; fi
unset LAB_ZDOTDIR

enter_lab() {
    emulate -L zsh
    precmd_functions=(${precmd_functions:#enter_lab})
    source $lab_shell/lab.sh
    unset lab_shell
    [[ $HUSKY_LAB_ROS == pip ]] || return 0
    (( $+functions[compdef] )) || { autoload -U +X compinit && compinit -i }
    eval "$(register-python-argcomplete ros2 colcon)"
    source $VIRTUAL_ENV/share/colcon_cd/function/colcon_cd.sh
}
precmd_functions+=(enter_lab)

if [[ -f ${ZDOTDIR:-$HOME}/.zshenv ]]; then source ${ZDOTDIR:-$HOME}/.zshenv; fi
