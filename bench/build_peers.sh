#!/usr/bin/env bash
# Builds fatrop, HPIPM and BLASFEO, other solvers that `chicane bench` and chicane-robustness compare with.
#
#   bench/build_peers.sh FOLDER [TARGET]
#
# FOLDER holds their sources: FOLDER/blasfeo, FOLDER/hpipm, FOLDER/fatrop (clones of github.com/giaf/blasfeo, giaf/hpipm and
# meco-group/fatrop). They are installed in FOLDER/install. TARGET is BLASFEO's name of the processor; X64_INTEL_HASWELL, which
# is left out, means AVX2. Then
#
#   cmake -DCHICANE_PEERS=FOLDER/install build/release
set -euo pipefail
[ $# -ge 1 ] || { sed -n '2,10s/^# \?//p' "${BASH_SOURCE[0]}" >&2; exit 2; }
folder=$(cd "$1" && pwd) target=${2:-X64_INTEL_HASWELL}
for name in blasfeo hpipm fatrop; do
  [ -f "$folder/$name/CMakeLists.txt" ] || { echo "build_peers.sh: got no sources of $name in $folder/$name" >&2; exit 3; }
done

# build NAME OPTION...
build() {
  local name=$1
  shift
  cmake -S "$folder/$name" -B "$folder/build/$name" -DCMAKE_BUILD_TYPE=Release -DCMAKE_POSITION_INDEPENDENT_CODE=ON \
    -DCMAKE_INSTALL_PREFIX="$folder/install" -DCMAKE_PREFIX_PATH="$folder/install" "$@"
  cmake --build "$folder/build/$name" --target install --parallel
}
flags=-march=native
[ "$target" = X64_INTEL_HASWELL ] && flags=-march=haswell
build blasfeo -DTARGET="$target" -DBLASFEO_EXAMPLES=OFF -DBUILD_SHARED_LIBS=OFF
build hpipm -DTARGET=AVX -DBLASFEO_PATH="$folder/install" -DHPIPM_TESTING=OFF -DBUILD_SHARED_LIBS=OFF
build fatrop -DBUILD_TESTS=OFF -DBUILD_EXAMPLES=OFF -DBUILD_WITH_C_INTERFACE=OFF -DWITH_BUILD_BLASFEO=OFF -DCMAKE_CXX_FLAGS="$flags"
