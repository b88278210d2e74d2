#!/usr/bin/env bash
# Makes the packages, checks what is in them, and drives a lap with the program of one that is unpacked to a temporary folder.
#   contents.sh BUILD_FOLDER PACKAGES_FOLDER CPACK
set -euo pipefail
build=$1 packages=$2 cpack=$3
fail() { echo "$1"; exit 1; }
work=$(mktemp -d)
trap 'rm -rf "$work"' EXIT
unset CHICANE_DATA_DIR

# Uncompressed, which saves most of the time, in a folder of their own.
rm -rf "$packages"
(cd "$build" && "$cpack" -B "$work/cpack" -D CPACK_OUTPUT_FILE_PREFIX="$packages" -D CPACK_DEBIAN_COMPRESSION_TYPE=none) >"$work/log" 2>&1 ||
  { cat "$work/log"; exit 1; }

# expect PACKAGE PATH...: is in that package.
expect() {
  local package=$1 deb path
  deb=$(echo "$packages/$package"_*.deb)
  dpkg-deb --contents "$deb" | awk '{ print $6 }' >"$work/$package"
  for path in "${@:2}" "usr/share/doc/$package/"{copyright,changelog.gz,changelog.Debian.gz}; do
    grep -qE "^\./$path$" "$work/$package" || fail "$package: no $path"
  done
  strange=$(grep -vE '^\./(usr/((bin|include|lib|share)/.*)?)?$' "$work/$package") && fail "$package: got $strange, expected files in /usr alone"
  owners=$(dpkg-deb --contents "$deb" | awk '{ print $2 }' | sort -u)
  [ "$owners" = root/root ] || fail "$package: got the owners $owners, expected root/root"
}
library='usr/lib/[a-z0-9_]+-linux-gnu'
expect chicane usr/bin/chicane usr/share/chicane/{tracks/lakeside.csv,cars/udacity.yaml,presets/default.yaml,scenarios/first-lap.yaml} \
  usr/share/man/man1/chicane.1.gz usr/share/bash-completion/completions/chicane.bash usr/share/zsh/vendor-completions/_chicane \
  usr/share/fish/vendor_completions.d/chicane.fish usr/share/applications/chicane.desktop usr/share/icons/hicolor/scalable/apps/chicane.svg \
  usr/lib/systemd/system/chicane-serve@.service usr/lib/systemd/system/chicane-ros@.service
expect libchicane-dev usr/include/chicane/protocol/library.hpp "$library"/{libchicane_controller.a,cmake/chicane/chicaneConfig.cmake} \
  "$library"/pkgconfig/{chicane,chicane-solver}.pc
expect chicane-doc usr/share/doc/chicane/{README.md,docs/tutorial.md,examples/01_drive_a_lap.cpp}
both=$(sort "$work"/{chicane,libchicane-dev,chicane-doc} | uniq -d | grep -v '/$') && fail "in two packages: $both"

depends() { dpkg-deb -f "$packages/$1"_*.deb Depends; }
for library in libc6 libfmt9 libyaml-cpp libddsc0debian; do [[ $(depends chicane) == *"$library"* ]] || fail "chicane does not depend on $library: $(depends chicane)"; done
version=$(dpkg-deb -f "$packages"/chicane_*.deb Version)
for package in "chicane (= $version)" libexpected-dev libyaml-cpp-dev; do
  [[ $(depends libchicane-dev) == *"$package"* ]] || fail "libchicane-dev does not depend on $package: $(depends libchicane-dev)"
done

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

tar -C "$work" -xf "$packages"/chicane-*-linux-*.tar.zst
unpacked=$(echo "$work"/chicane-*-linux-*)/bin/chicane
"$unpacked" drive --fast --laps 1 >/dev/null
if libraries=$(ldd "$unpacked" | grep '=>' | grep -v "$work" | grep -vE '^\s*lib(c|m)\.so|vdso'); then
  fail "the unpacked program takes from the system: $libraries"
fi
