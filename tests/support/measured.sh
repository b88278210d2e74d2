#!/usr/bin/env bash
# Runs a test and appends a line with its processor seconds, user and system, and its name to the file CHICANE_TEST_TIMES; ctest knows
# waiting time only.
#
#   measured.sh NAME COMMAND [ARGUMENT...]     NAME -: the program and the first of its arguments
[ -n "${CHICANE_TEST_TIMES:-}" ] || exec "${@:2}"
name=$1
shift
[ "$name" != - ] || name="${1##*/} ${2:-}"
TIMEFORMAT="%U %S $name"
{ time "$@" 2>&3; } 3>&2 2>>"$CHICANE_TEST_TIMES"
