#!/usr/bin/env bash
# Runs a step of the build and notes its processor time in .processor_times of the build folder, for tools/build_times.py.
# Compilers and linkers are started through it (CMakePresets.json), in front of ccache.
#
#   tools/note_time.sh ccache c++ ... -o FILE     the file named by -o
#   tools/note_time.sh -o FILE cmake -P ...       any other step
#
# A line: seconds of user and system, tab, "run" or "cached" (ccache had the answer), tab, FILE.
[ "${1:-}" != --help ] || { sed -n '2,/^[^#]/s/^# \{0,1\}//p' "$0"; exit 0; }
file='' previous=''
for word in "$@"; do
  [ "$previous" = -o ] && file=$word
  previous=$word
done
[ "$1" = -o ] && shift 2
stats=.processor_times.$$
TIMEFORMAT='%U %S'
exec 3>&1 4>&2
# Without these, ccache keeps nothing that was compiled with precompiled headers.
export CCACHE_SLOPPINESS=pch_defines,time_macros
spent=$( { time CCACHE_STATSLOG=$PWD/$stats "$@" >&3 2>&4; } 2>&1 )
result=$?
kind=run
if [ -f "$stats" ]; then
  grep -q '_cache_hit$' "$stats" && kind=cached
  rm -f "$stats"
fi
printf '%s\t%s\t%s\n' "${spent//,/.}" "$kind" "$file" >>.processor_times
exit "$result"
