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
    (( $+functions[compdef] )) || { autoload -U +X compinit && compinit -i }
    # An argcomplete of the system's may speak bash alone; for the rest see bashrc.
    (( $+functions[complete] )) || { autoload -U +X bashcompinit && bashcompinit }
    (( ! $+commands[register-python-argcomplete] )) || eval "$(register-python-argcomplete ros2 colcon)"
    local colcon_cd=$VIRTUAL_ENV/share/colcon_cd/function/colcon_cd.sh
    [[ ! -f $colcon_cd ]] || source $colcon_cd
}
precmd_functions+=(enter_lab)

if [[ -f ${ZDOTDIR:-$HOME}/.zshenv ]]; then source ${ZDOTDIR:-$HOME}/.zshenv; fi
