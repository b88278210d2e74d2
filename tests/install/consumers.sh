#!/usr/bin/env bash
# Builds and runs programs against an installation: one with CMake and with pkg-config, and of the installed examples a controller, a car
# and a road of one's own.
#   consumers.sh SOURCE_FOLDER PREFIX WORK_FOLDER COMPILER BUILD_FOLDER
set -euo pipefail
source=$1 prefix=$2 work=$3 compiler=$4 build=$5
# configured FOLDER NAME: the project in FOLDER, in "$work/NAME".
configured() {
  rm -rf "${work:?}/$2"
  cmake -G Ninja -S "$1" -B "$work/$2" -DCMAKE_PREFIX_PATH="$prefix" -DCMAKE_CXX_COMPILER="$compiler" >/dev/null
}
configured "$source" consumer
cmake --build "$work/consumer" >/dev/null
"$work/consumer/consumer"
# Programs outside the installation find its data, by what CMake told their compiler.
unset CHICANE_DATA_DIR
configured "$(dirname "$(find "$prefix" -name 01_drive_a_lap.cpp)")" examples
for example in 03_your_own_controller 06_your_own_car_and_road; do
  cmake --build "$work/examples" --target "$example" >/dev/null
  (cd / && "$work/examples/$example")
done

PKG_CONFIG_PATH=$(dirname "$(find "$prefix" -name chicane.pc)")
export PKG_CONFIG_PATH
flags=$(pkg-config --cflags --libs chicane)
if grep -qF "$build/" <<<"$flags"; then [[ $prefix == "$build"/* ]] || { echo "chicane.pc points into the build: $flags"; exit 1; }; fi
# shellcheck disable=SC2086
"$compiler" "$source/main.cpp" -o "$work/pkg_config_consumer" $flags
"$work/pkg_config_consumer"
[ -f "$(pkg-config --variable=datadir chicane)/presets/default.yaml" ] || { echo "chicane.pc: no presets/default.yaml in datadir"; exit 1; }
