#!/bin/sh
# Chromium (its path in CHROMIUM) at niceness 5, or at the caller's if that is more: at the priority to which root's
# Chromium raises itself, the program's searches beside a run would stand still for minutes on a busy machine.
niceness=$(nice)
calm="nice -n $((niceness < 5 ? 5 - niceness : 0))"
lowered="setpriv --bounding-set -sys_nice --inh-caps -sys_nice"
if $lowered true 2>/dev/null; then calm="$lowered $calm"; fi
# The pages behind Chromium's own address bar take a second of processor time in each window, and nobody sees them.
for word; do
  shift
  case $word in --disable-features=*) word="$word,WebUIOmniboxPopup,WebUIOmniboxAimPopup,WebUIOmniboxFullPopup" ;; esac
  set -- "$@" "$word"
done
# shellcheck disable=SC2086  # two commands and their words
exec $calm "${CHROMIUM:-/usr/bin/chromium}" "$@"
