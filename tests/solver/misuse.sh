#!/usr/bin/env bash
# Compiles each case of misuse.cpp: case 0 has to pass, the others have to fail with the message that stands behind them, early and in
# few lines. Then misuse_problems.cpp: once as it is, and once with all its mistakes, each of which has to be an error that says what
# stands behind it, in at most three lines; two errors a mistake.
#   misuse.sh COMPILER SOURCE_FOLDER             each third case of misuse.cpp; with CHICANE_SLOW_TESTS all
set -uo pipefail
compiler=$1 source=$2
here=$(dirname "$0")
# Lines up to the end of the first message: how it came about (5), a standard header's name (3), the message and its note (8).
most_lines=18
failures=0
# g++ reads the solver's headers once for all cases.
headers=$(mktemp -d) && trap 'rm -rf "$headers"' EXIT
precompiled=()
if ! "$compiler" --version | grep -q clang; then
  for name in problem hard_constraints; do
    echo "#include \"chicane/solver/$name.hpp\"" >"$headers/$name.hpp"
    "$compiler" -std=c++20 -Wno-psabi -I"$source/src" -x c++-header "$headers/$name.hpp" || exit 1
  done
  precompiled=(-include "$headers/problem.hpp")
fi
fail() { echo "case $case: $1"; failures=1; }
stride=3
if [ -n "${CHICANE_SLOW_TESTS:-}" ]; then stride=1; fi
cases=$(grep -c 'CASE == ' "$here/misuse.cpp")
for ((case = 0; case < cases; case += stride)); do
  expected=$(sed -n "s/^#.*CASE == $case  *\/\/ expect: //p" "$here/misuse.cpp")
  LC_ALL=C said=$("$compiler" -std=c++20 -fsyntax-only -Wno-psabi "${precompiled[@]}" -DCASE="$case" -I"$source/src" "$here/misuse.cpp" 2>&1)
  code=$?
  if ((case == 0)); then
    [ $code -eq 0 ] || fail "$said"
    continue
  fi
  [ $code -eq 1 ] || fail "compiler ended with $code"
  [ -n "$expected" ] || fail "says not what to expect"
  line=$(grep -nF -- "$expected" <<<"$said" | head -1 | cut -d: -f1)
  if [ -z "$line" ]; then
    fail "expected \"$expected\" in: $said"
  elif ((case <= 12 && line > most_lines)); then
    fail "expected \"$expected\" in the first $most_lines lines, got it in line $line of: $said"
  fi
  if ((case <= 12)) && (($(grep -cvE '^(In file included| +from) ' <<<"$said") > 60)); then fail "said too much: $said"; fi
done

case=problems
[ ${#precompiled[@]} -eq 0 ] || precompiled=(-include "$headers/hard_constraints.hpp")
limit=() && "$compiler" --version | grep -q clang && limit=(-ferror-limit=0)
compile() { LC_ALL=C "$compiler" "${limit[@]}" -std=c++20 -fsyntax-only -Wno-psabi "${precompiled[@]}" "$@" -I"$source/src" "$here/misuse_problems.cpp" 2>&1; }
said=$(compile) || fail "well-formed problems are refused: $said"
said=$(compile -DMISUSE) && fail "mistakes are accepted"
mistakes=0
while IFS=: read -r line text; do
  ((++mistakes))
  expected=${text#*// expect: }
  # The errors of this line: messages whose instantiation began there.
  if grep -q "In instantiation of" <<<"$said"; then  # g++: that comes first
    error=$(awk -v here="misuse_problems.cpp:$((line + 1)):" 'index($0, here) && /required from here/ {on = 1} on && /error:/ {print; exit}' <<<"$said")
  else
    error=$(grep -F "error:" <<<"$said" | grep -F -- "$expected" | head -1)
  fi
  grep -qF -- "$expected" <<<"$error" || fail "line $line: expected \"$expected\", got: $error"
  [ -z "${VERBOSE:-}" ] || grep -F -A2 -m1 -- "$error" <<<"$said"
done < <(grep -n '// expect: ' "$here/misuse_problems.cpp")
((mistakes >= 12)) || fail "only $mistakes mistakes"
errors=$(grep -c 'error: ' <<<"$said")
((errors <= 2 * mistakes)) || fail "$errors errors for $mistakes mistakes"
exit $failures
