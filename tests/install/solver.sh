#!/usr/bin/env bash
# Builds and runs a program that uses the solver alone, and has a problem of its own compiled for each instruction set: with CMake, with
# pkg-config. Then asks for components that are not there.
#   solver.sh SOURCE_FOLDER PREFIX WORK_FOLDER COMPILER
set -euo pipefail
source=$1 prefix=$2 work=$3 compiler=$4
fail() { echo "$1"; exit 1; }

rm -rf "$work"/{solver,solver_pc,components}
cmake -G Ninja -S "$source" -B "$work/solver" -DCMAKE_PREFIX_PATH="$prefix" -DCMAKE_CXX_COMPILER="$compiler" \
  -DCMAKE_BUILD_TYPE=Debug >/dev/null # a third of the compiler's time
cmake --build "$work/solver" >/dev/null
"$work/solver/solver_consumer"
ctest --test-dir "$work/solver" --no-tests=error --output-on-failure >"$work/solver/test.log" || { cat "$work/solver/test.log"; exit 1; }

PKG_CONFIG_PATH=$(dirname "$(find "$prefix" -name chicane-solver.pc)")
export PKG_CONFIG_PATH
# By hand for the last instruction set; the others' objects are there already.
mkdir "$work/solver_pc"
read -ra flags <<<"$(pkg-config --cflags chicane-solver) $(pkg-config --variable=cflags_float chicane-solver)"
read -ra sets <<<"$(pkg-config --variable=instruction_sets chicane-solver)"
objects=()
for set in "${sets[@]}"; do
  objects+=("$work/solver/CMakeFiles/solver_consumer_puck_solver_$set.dir/puck_solver.cpp.o")
done
read -ra set_flags <<<"$(pkg-config --variable="cflags_${sets[-1]}" chicane-solver)"
"$compiler" "${flags[@]}" "${set_flags[@]}" -Wno-psabi -c "$source/puck_solver.cpp" -o "$work/solver_pc/last.o"
objects[-1]=$work/solver_pc/last.o
read -ra libs <<<"$(pkg-config --libs chicane-solver)"
"$compiler" "${flags[@]}" "$source/main.cpp" "${objects[@]}" -o "$work/solver_pc/consumer" "${libs[@]}"
"$work/solver_pc/consumer"
for word in $(pkg-config --libs --print-requires chicane-solver); do
  case $word in
    -L* | -lchicane_base | -lchicane_solver) ;;
    *) fail "chicane-solver.pc needs $word" ;;
  esac
done

# components WORDS OPTION...: what find_package(chicane WORDS) says.
mkdir "$work/components"
components() {
  printf 'cmake_minimum_required(VERSION 3.25)\nproject(components LANGUAGES CXX)\nfind_package(chicane 0.3 REQUIRED %s)\n' \
    "$1" >"$work/components/CMakeLists.txt"
  rm -rf "$work/components/build"
  cmake -G Ninja -S "$work/components" -B "$work/components/build" -DCMAKE_PREFIX_PATH="$prefix" \
    -DCMAKE_CXX_COMPILER="$compiler" "${@:2}" 2>&1 | tr -s '\n ' ' '
}
expect() { [[ $2 == *"$1"* ]] || fail "expected \"$1\" in: $2"; }
expect "got the component solvr, expected one of base," "$(components "COMPONENTS solver solvr")"
expect "Configuring done" "$(components "COMPONENTS solver OPTIONAL_COMPONENTS solvr")"
expect "component protocol needs yaml-cpp, which was not found" \
  "$(components "COMPONENTS protocol" -DCMAKE_DISABLE_FIND_PACKAGE_yaml-cpp=ON)"
expect "component protocol needs yaml-cpp, which was not found" "$(components "" -DCMAKE_DISABLE_FIND_PACKAGE_yaml-cpp=ON)"
