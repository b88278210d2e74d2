#!/usr/bin/env bash
# Checks that JavaScript, TypeScript and style sheets are formatted, and that the linter finds nothing (Biome, biome.jsonc);
# --fix formats them and applies the linter's safe fixes. Installs Biome where it is missing (Node.js and npm).
#
#   tools/check_web.sh [--fix]
set -euo pipefail
source "$(dirname "${BASH_SOURCE[0]}")/usage.sh"
cd "$(dirname "${BASH_SOURCE[0]}")/.."
cmake "-DFOLDER=$PWD/tools/web_style" -DNPM=npm -P cmake/NpmCi.cmake

mode=()
if [ "${1:-}" = --fix ]; then mode=(--write); fi
exec tools/web_style/node_modules/@biomejs/cli-*/biome check --error-on-warnings "${mode[@]}" .
