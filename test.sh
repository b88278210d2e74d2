#!/usr/bin/env bash
# Installs what is missing, builds, and runs the tests.
#
#   ./test.sh                 all but the slow ones
#   ./test.sh --all           all
#   ./test.sh -L solver       further arguments go to ctest: one module, `-R name`, `--rerun-failed`
set -euo pipefail
root=$(cd "$(dirname "${BASH_SOURCE[0]}")" && pwd -P)
source "$root/tools/install_packages.sh"
source "$root/tools/build.sh"

selection=(-LE slow) simd=native slow=OFF two_sizes=ON slow_packages=()
if [ "${1:-}" = --all ]; then
  selection=() simd=all slow=ON two_sizes=OFF slow_packages=("${slow_test_packages[@]}")
  shift
fi

mapfile -t others < <(node_packages; browser_packages)
install_packages "${run_packages[@]}" "${test_packages[@]}" "${slow_packages[@]}" "${others[@]}"
build_release "$root" all "CHICANE_SIMD=$simd" CHICANE_BUILD_TESTS=ON CHICANE_BUILD_EXAMPLES=ON CHICANE_PYTHON=ON "CHICANE_SLOW_TESTS=$slow" "CHICANE_PYTHON_TWO_SIZES=$two_sizes"
processor_seconds built
say "chicane: ctest ${selection[*]} $*"
log=$root/build/release/test.log
export CHICANE_TEST_TIMES=$root/build/release/test_times.txt
rm -f "$CHICANE_TEST_TIMES"
result=0
# One test more than there are cores: many wait for a clock, a socket or a page.
ctest --test-dir "$root/build/release" -j $(($(nproc) + 1)) --output-on-failure --no-tests=error --no-label-summary \
  --output-log "$log" "${selection[@]}" "$@" || result=$?
grep -E '^[0-9]+% tests passed' "$log" || true  # again, below the list of what was skipped
processor_seconds all
"$root/tools/build_times.py" --count 5 || true
echo 'processor seconds of the dearest tests (all: build/release/test_times.txt):'
awk '{ used = $1 + $2; $1 = $2 = ""; printf "%8.1f %s\n", used, $0 }' "$CHICANE_TEST_TIMES" | sort -n | tail -40 || true
awk "BEGIN { printf \"processor time: %.0f s to configure and build, %.0f s for the tests\n\", $built, $all - $built }"
printf 'size: program %s, page %s compressed\n' "$(kilobytes <"$root/build/release/apps/chicane/chicane")" \
  "$(cat "$root"/build/release/web/dist/assets/* 2>/dev/null | gzip -9 | kilobytes)"
"$root/tools/code_lines.py" || true
"$root/tools/check_pages.py" || true
# What failed, again, below all else.
[ "$result" -eq 0 ] || grep -E -A 12 '^ *not ok |: Failure$|AssertionError|ERROR:' "$log" | tail -80 || true
exit "$result"
