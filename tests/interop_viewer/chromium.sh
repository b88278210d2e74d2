#!/bin/sh
# Chromium (its path in CHROMIUM) at a low priority: at that of root's Chromium, which raises it, the program's searches
# beside a run would stand still for minutes on a busy machine.
calm="nice -n 5"
lowered="setpriv --bounding-set -sys_nice --inh-caps -sys_nice"
if $lowered true 2>/dev/null; then calm="$lowered $calm"; fi
# shellcheck disable=SC2086  # two commands and their words
exec $calm "${CHROMIUM:-/usr/bin/chromium}" "$@"
