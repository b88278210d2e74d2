#!/usr/bin/env bash
# Makes the packages, checks what is in them, and drives a lap with the program of one that is unpacked to a temporary folder; with
# CHICANE_SLOW_TESTS the archive for any system, too.
#   contents.sh BUILD_FOLDER PACKAGES_FOLDER CPACK
set -euo pipefail
build=$1 packages=$2 cpack=$3
fail() { echo "$1"; exit 1; }
work=$(mktemp -d)
trap 'rm -rf "$work"' EXIT
unset CHICANE_DATA_DIR

# Uncompressed, which saves most of the time, in a folder of their own; of a build for tests, which may lack an instruction set that this
# machine has not.
rm -rf "$packages"
generators=(-G DEB)
if [ -n "${CHICANE_SLOW_TESTS:-}" ]; then generators=(); fi
(cd "$build" && "$cpack" "${generators[@]}" -B "$work/cpack" -D CPACK_OUTPUT_FILE_PREFIX="$packages" -D CPACK_DEBIAN_COMPRESSION_TYPE=none \
  -D CPACK_CHICANE_SIMD=all) >"$work/log" 2>&1 ||
  { cat "$work/log"; exit 1; }

# expect PACKAGE PATH...: is in that package.
expect() {
  local package=$1 deb path
  deb=$(echo "$packages/$package"_*.deb)
  dpkg-deb --contents "$deb" | awk '{ print $6 }' >"$work/$package"
  for path in "${@:2}" "usr/share/doc/$package/"{copyright,changelog.gz,changelog.Debian.gz}; do
    grep -qE "^\./$path$" "$work/$package" || fail "$package: no $path"
  done
  strange=$(grep -vE '^\./(usr/((bin|include|lib|libexec|share)/.*)?)?$' "$work/$package") && fail "$package: got $strange, expected files in /usr alone"
  owners=$(dpkg-deb --contents "$deb" | awk '{ print $2 }' | sort -u)
  [ "$owners" = root/root ] || fail "$package: got the owners $owners, expected root/root"
}
library='usr/lib/[a-z0-9_]+-linux-gnu'
expect chicane usr/bin/chicane usr/libexec/chicane/chicane-lab usr/share/chicane/{tracks/lakeside.csv,cars/udacity.yaml,presets/default.yaml,scenarios/first-lap.yaml} \
  usr/share/man/man1/chicane.1.gz usr/share/bash-completion/completions/chicane.bash usr/share/zsh/vendor-completions/_chicane \
  usr/share/fish/vendor_completions.d/chicane.fish usr/share/applications/chicane.desktop usr/share/icons/hicolor/scalable/apps/chicane.svg \
  usr/lib/systemd/system/chicane-serve@.service
expect libchicane-dev usr/include/chicane/protocol/library.hpp "$library"/{libchicane_controller.a,cmake/chicane/chicaneConfig.cmake} \
  "$library"/pkgconfig/{chicane,chicane-solver}.pc
expect chicane-doc usr/share/doc/chicane/{README.md,docs/tutorial.md,examples/01_drive_a_lap.cpp}
packages_made=(chicane libchicane-dev chicane-doc)
has() { [ -e "$(echo "$packages/$1"_*.deb)" ]; }
if has chicane-ros; then
  expect chicane-ros usr/libexec/chicane/chicane-ros usr/lib/systemd/system/chicane-ros@.service
  packages_made+=(chicane-ros)
fi
if has python3-chicane; then
  expect python3-chicane usr/lib/python3/dist-packages/chicane/{__init__.py,_chicane.pyi,py.typed,_chicane.cpython-.*.so}
  packages_made+=(python3-chicane)
fi
both=$(cd "$work" && sort "${packages_made[@]}" | uniq -d | grep -v '/$') && fail "in two packages: $both"

depends() { dpkg-deb -f "$packages/$1"_*.deb Depends; }
# needs PACKAGE WORD...: its dependencies name them.
needs() {
  local word
  for word in "${@:2}"; do [[ $(depends "$1") == *"$word"* ]] || fail "$1 does not depend on $word: $(depends "$1")"; done
}
needs chicane libc6 libfmt9 libyaml-cpp libpng16 libpugixml1v5 libsqlite3-0
[[ $(depends chicane) != *ddsc* ]] || fail "chicane depends on DDS, which only chicane-ros needs: $(depends chicane)"
version=$(dpkg-deb -f "$packages"/chicane_*.deb Version)
needs libchicane-dev "chicane (= $version)" libexpected-dev libyaml-cpp-dev libpng-dev libpugixml-dev libsqlite3-dev
if has chicane-ros; then needs chicane-ros "chicane (= $version)" libddsc0debian libc6; fi
if has python3-chicane; then needs python3-chicane "chicane (= $version)" "python3 (>= 3" "python3 (<< 3" python3-numpy libc6; fi

cd /
dpkg-deb -x "$packages"/chicane_*.deb "$work/root"
program=$work/root/usr/bin/chicane
"$program" drive --fast --laps 1
cmp <(gzip -dc "$work/root/usr/share/man/man1/chicane.1.gz") <("$program" manual) || fail "the manual page is not the program's"
for name in baseline avx2 avx512; do
  code=0
  said=$(CHICANE_SIMD=$name "$program" drive --fast --laps 1 --json 2>&1) || code=$?
  [[ $code = 0 || $said == *"$name"* ]] || fail "CHICANE_SIMD=$name: exit code $code: $said"
done

[ -n "${CHICANE_SLOW_TESTS:-}" ] || exit 0
tar -C "$work" -xf "$packages"/chicane-*-linux-*.tar.zst
unpacked=$(echo "$work"/chicane-*-linux-*)/bin/chicane
"$unpacked" drive --fast --laps 1 >/dev/null
for file in "$unpacked" "$(dirname "$unpacked")"/../libexec/chicane/*; do
  [ -x "$file" ] || continue  # without DDS there is none
  if libraries=$(ldd "$file" | grep '=>' | grep -v "$work" | grep -vE '^\s*lib(c|m)\.so|vdso'); then
    fail "the unpacked program $file takes from the system: $libraries"
  fi
done
if has chicane-ros; then
  code=0
  said=$("$unpacked" ros --interface none-such 2>&1) || code=$?
  [[ $code = 3 && $said == *none-such* ]] || fail "chicane ros of the tarball: got exit code $code and $said, expected 3 and the interface"
fi
