#!/usr/bin/env bash
# Installs a build to a folder, moves the folder, and builds and runs a program against it with CMake and with pkg-config.
#   install_test.sh BUILD_FOLDER WORK_FOLDER COMPILER
set -euo pipefail
build=$1 work=$2 compiler=$3
consumer=$(cd "$(dirname "${BASH_SOURCE[0]}")" && pwd)/consumer

rm -rf "$work"/{first,moved,cmake}
cmake --install "$build" --prefix "$work/first" >/dev/null
mv "$work/first" "$work/moved"
prefix=$work/moved
[ -f "$prefix/share/chicane/presets/default.yaml" ] || { echo "presets/default.yaml is not installed"; exit 1; }

cmake -G Ninja -S "$consumer" -B "$work/cmake" -DCMAKE_PREFIX_PATH="$prefix" -DCMAKE_CXX_COMPILER="$compiler" >/dev/null
cmake --build "$work/cmake" >/dev/null
"$work/cmake/consumer"

config=$(dirname "$(find "$prefix" -name chicane.pc)")
flags=$(PKG_CONFIG_PATH=$config pkg-config --cflags --libs chicane)
if grep -qF "$build/" <<<"$flags"; then [[ $prefix == "$build"/* ]] || { echo "chicane.pc points into the build: $flags"; exit 1; }; fi
# shellcheck disable=SC2086
"$compiler" "$consumer/main.cpp" -o "$work/pkg_config_consumer" $flags
"$work/pkg_config_consumer"
