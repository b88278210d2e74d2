#!/usr/bin/env bash
# All checks that a change must pass. Each part also runs alone: tools/check.sh tidy
#
#   format   clang-format has nothing to change
#   web      Biome finds nothing to format or to fix in the dashboard and its tests
#   layers   includes between modules, rules of tools/check_sources.py, a test for each public header
#   tidy     clang-tidy: names, function lengths, bug patterns
#   release  ./test.sh --all: every test, with the dashboard's, the installed package's and the documents'
#   dev      Debug with assertions, public headers compile alone
#   clang    the other compiler (where it is installed)
#   asan     address and undefined behaviour sanitizers
#   tsan     thread sanitizer
#   bits     the builds above compute the same laps, bit for bit
set -uo pipefail
source "$(dirname "${BASH_SOURCE[0]}")/usage.sh"
cd "$(dirname "${BASH_SOURCE[0]}")/.." || exit
source tools/install_packages.sh

check_format() { tools/check_format.sh; }
check_web() { tools/check_web.sh; }
check_layers() { tools/check_layers.py && tools/check_sources.py; }
check_tidy() {
  cmake --preset dev >/dev/null &&
    find src apps -name '*.cpp' -print0 | xargs -0 -n 1 -P "$(nproc)" clang-tidy --quiet -p build/dev
}
check_release() { ./test.sh --all; }
check_preset() { cmake --workflow --preset "$1"; }
check_dev() { check_preset dev; }
check_clang() { command -v clang++ >/dev/null || { say "clang++ is not installed: not checked"; return 0; }; check_preset clang; }
check_asan() { check_preset asan; }
check_tsan() { check_preset tsan; }

# The state_hash of a few laps for each build, on one line.
hashes() {
  local run
  for run in '--car udacity' '--car road-car' '--preset weighted' 'noisy-sensor'; do
    # shellcheck disable=SC2086
    "build/$1/apps/chicane/chicane" drive --fast --laps 1 --json $run 2>/dev/null | grep -o '"state_hash": "[0-9a-f]*"'
  done | tr '\n' ' '
}
check_bits() {
  local build wanted
  wanted=$(hashes release)
  for build in dev clang asan; do
    [ -x "build/$build/apps/chicane/chicane" ] || continue
    [ "$(hashes $build)" = "$wanted" ] || { say "build/$build drives other bits than build/release"; return 1; }
  done
  say "$wanted"
}

parts=("$@")
for part in "${parts[@]}"; do
  declare -F "check_$part" >/dev/null || { say "tools/check.sh: got $part, expected parts of those at the top of this file"; exit 2; }
done
[ $# -gt 0 ] || parts=(format web layers tidy release dev clang asan tsan bits)
mapfile -t others < <(node_packages; browser_packages)
install_packages "${run_packages[@]}" "${test_packages[@]}" "${check_packages[@]}" "${others[@]}" || exit 3
failed=()
for part in "${parts[@]}"; do
  say "== $part"
  "check_$part" || failed+=("$part")
done
[ ${#failed[@]} -eq 0 ] || { say "failed: ${failed[*]}"; exit 1; }
say "passed: ${parts[*]}"
