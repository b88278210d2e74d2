#!/usr/bin/env bash
# Checks that every C++ file is formatted by .clang-format; --fix formats them. Exit code 77 without clang-format.
set -euo pipefail
cd "$(dirname "${BASH_SOURCE[0]}")/.."
command -v clang-format >/dev/null || { echo "clang-format is not installed: not checked"; exit 77; }

mode=(--dry-run -Werror)
if [ "${1:-}" = --fix ]; then mode=(-i); fi
find src apps tests examples bench \( -name '*.hpp' -o -name '*.cpp' \) -print0 | xargs -0 -r clang-format "${mode[@]}"
