#!/usr/bin/env bash
# Checks that every C++ file is formatted by .clang-format; --fix formats them. Other versions of clang-format give other results: exit
# code 77 (skipped) without the one of Debian 12.
#
#   tools/check_format.sh [--fix]
set -euo pipefail
source "$(dirname "${BASH_SOURCE[0]}")/usage.sh"
cd "$(dirname "${BASH_SOURCE[0]}")/.."
clang-format --version 2>/dev/null | grep -q 'version 14\.' || { echo "clang-format 14 is not installed: not checked"; exit 77; }

mode=(--dry-run -Werror)
if [ "${1:-}" = --fix ]; then mode=(-i); fi
find src apps python tests examples bench studies \( -name '*.hpp' -o -name '*.cpp' \) -print0 | xargs -0 -r clang-format "${mode[@]}"
