#!/usr/bin/env bash
# Writes a folder with the dashboard as a page that needs no program: simulator and controller in it as WebAssembly. `./run.sh page`
# installs what it needs (Debian's emscripten: about 1 GB) and calls this.
#
#   tools/build_page.sh FOLDER     writes FOLDER/index.html
set -euo pipefail
source "$(dirname "${BASH_SOURCE[0]}")/usage.sh"
root=$(cd "$(dirname "${BASH_SOURCE[0]}")/.." && pwd -P)
mkdir -p "${1:?the folder to write}"
folder=$(realpath "$1")
build=$root/build/page
source "$root/tools/build.sh"

mkdir -p "$build"
# Debian's emscripten has its JavaScript libraries where only Debian's Node looks for them.
export NODE_PATH=/usr/share/nodejs${NODE_PATH:+:$NODE_PATH}
[ -f "$build/build.ninja" ] || emcmake cmake -S "$root/apps/page" -B "$build" -G Ninja -DCMAKE_BUILD_TYPE=Release \
  -DCMAKE_CXX_COMPILER_LAUNCHER=ccache >&2
ninja -C "$build" -j "$(build_jobs)" >&2

cd "$root/web"
cmake "-DFOLDER=$PWD" -DNPM=npm -P "$root/cmake/NpmCi.cmake" >&2
CHICANE_PAGE=1 node node_modules/vite/bin/vite.js build --outDir "$build/dist" --emptyOutDir --logLevel warn >&2
node "$root/tools/join_page.mjs" "$build/dist" "$build/page.js" "$folder/index.html"
