# Copyright 2026 The Husky Playpen Lab authors
# SPDX-License-Identifier: Apache-2.0
# Read by the fish of `./lab shell` after your own settings: what lab.sh is for bash and zsh.
set -gx VIRTUAL_ENV $LAB_VIRTUAL_ENV
for name in PATH AMENT_PREFIX_PATH LD_LIBRARY_PATH PYTHONPATH
    set -l was LAB_$name
    if test -n "$$was"; and not string match -q -- "*:$$was:*" ":$$name:"
        set -gx --path $name $$was $$name
    end
    set -e $was
end
test $PATH[1] = $VIRTUAL_ENV/bin; or set -gx PATH $VIRTUAL_ENV/bin $PATH
set -e LAB_VIRTUAL_ENV
if test $HUSKY_LAB_ROS = pip
    set -e RMW_IMPLEMENTATION
end
if type -q register-python-argcomplete  # see bashrc
    register-python-argcomplete --shell fish ros2 colcon | source
end
functions -c fish_prompt lab_fish_prompt
function fish_prompt
    set -l yours (lab_fish_prompt)  # first of all, for it may show the last status
    printf '(lab) %s' (string join \n -- $yours | string collect)
end
