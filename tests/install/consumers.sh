#!/usr/bin/env bash
# Builds and runs programs against an installation: two with CMake, one with pkg-config. Configures the installed examples.
#   consumers.sh SOURCE_FOLDER PREFIX WORK_FOLDER COMPILER BUILD_FOLDER
set -euo pipefail
source=$1 prefix=$2 work=$3 compiler=$4 build=$5
rm -rf "$work/consumer" "$work/own_controller.mcap" "$work/own_plant.mcap"
cmake -G Ninja -S "$source" -B "$work/consumer" -DCMAKE_PREFIX_PATH="$prefix" -DCMAKE_CXX_COMPILER="$compiler" >/dev/null
cmake --build "$work/consumer" >/dev/null
# Programs outside the installation find its data, by what CMake and pkg-config told their compiler.
unset CHICANE_DATA_DIR
(cd / && "$work/consumer/own_controller" "$work/own_controller.mcap")
(cd / && "$work/consumer/own_plant" "$work/own_plant.mcap")

PKG_CONFIG_PATH=$(dirname "$(find "$prefix" -name chicane.pc)")
export PKG_CONFIG_PATH
flags=$(pkg-config --cflags --libs chicane)
if grep -qF "$build/" <<<"$flags"; then [[ $prefix == "$build"/* ]] || { echo "chicane.pc points into the build: $flags"; exit 1; }; fi
# shellcheck disable=SC2086
"$compiler" "$source/main.cpp" -o "$work/pkg_config_consumer" $flags
"$work/pkg_config_consumer"
[ -f "$(pkg-config --variable=datadir chicane)/presets/default.yaml" ] || { echo "chicane.pc: no presets/default.yaml in datadir"; exit 1; }

examples=$(dirname "$(find "$prefix" -name 01_drive_a_lap.cpp)")
rm -rf "$work/examples"
cmake -G Ninja -S "$examples" -B "$work/examples" -DCMAKE_PREFIX_PATH="$prefix" -DCMAKE_CXX_COMPILER="$compiler" >/dev/null
