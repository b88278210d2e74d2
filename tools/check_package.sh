#!/usr/bin/env bash
# Installs the packages in a bare Debian (mmdebstrap's minbase), drives with them with and without /proc, builds programs with the library,
# upgrades from an older version, and purges them. Prints times and bytes. Needs mmdebstrap and the network; about four minutes.
#   tools/check_package.sh [FOLDER]     FOLDER has the packages: build/release/packages, made by ./run.sh package
# Exit code 77 where mmdebstrap is not installed. Root is not needed where user namespaces are allowed.
set -euo pipefail
source "$(dirname "${BASH_SOURCE[0]}")/usage.sh"
root=$(cd "$(dirname "${BASH_SOURCE[0]}")/.." && pwd -P)
fail() { printf 'check_package: %s\n' "$*" >&2; exit 1; }
say() { printf '%-58s %s\n' "$1" "$2"; }

# timed WORDS COMMAND...: runs it; prints its output where it fails, else the seconds that it took.
timed() {
  local words=$1 from=$EPOCHREALTIME
  "${@:2}" >"$log" 2>&1 || { cat "$log"; fail "$words: failed"; }
  say "$words" "$(awk "BEGIN { printf \"%.1f s\", $EPOCHREALTIME - $from }")"
}

# What follows runs in mmdebstrap's namespace, with the bare system in $bare.
in_bare() { env -i PATH=/usr/sbin:/usr/bin:/sbin:/bin HOME=/root LC_ALL=C.UTF-8 DEBIAN_FRONTEND=noninteractive chroot "$bare" "$@"; }
apt() { in_bare apt-get -q -y --no-install-recommends "$@"; }
traces() { (cd "$bare" && find . -xdev \( -path ./proc -o -path ./sys -o -path ./check -o -path ./var/log \) -prune -o -iname '*chicane*' -print); }

# older_package: the same package as if it were of version 0.1, with a track that the present one does not have.
older_package() {
  dpkg-deb -R "$bare"/check/chicane_*.deb "$bare/check/older"
  sed -i 's/^Version: .*/Version: 0.1.0-1/' "$bare/check/older/DEBIAN/control"
  echo '# gone' >"$bare/check/older/usr/share/chicane/tracks/gone.csv"
  rm "$bare/check/older/DEBIAN/md5sums"
  dpkg-deb --root-owner-group -b "$bare/check/older" "$bare/check/older.deb" >/dev/null
}

check_tarball() {
  tar -C "$bare/check" -xf "$bare"/check/chicane-*-linux-*.tar.zst
  timed "tarball: unpacked, nothing installed, one lap" in_bare sh -c '/check/chicane-*-linux-*/bin/chicane drive --fast --laps 1'
}

check_program() {
  older_package
  timed "apt install of an older version" apt install /check/older.deb
  in_bare chicane list tracks | grep -q '^gone' || fail "the older version is not there"
  timed "upgrade" apt install "${deb[chicane]}"
  ! in_bare chicane list tracks | grep -q '^gone' || fail "the upgrade has left a file of the older version"
  timed "purge" apt purge chicane
  timed "apt install ./chicane_*.deb, dependencies are there" apt install "${deb[chicane]}"
  timed "purge with dependencies" apt purge --auto-remove chicane
  in_bare apt-get clean
  timed "apt install ./chicane_*.deb in a bare system" apt install "${deb[chicane]}"
  say "  downloaded" "$(sed -n 's/^Need to get \(.*\) of archives.*/\1/p' "$log")"
  say "  packages" "$(sed -n 's/^\([0-9]*\) upgraded, \([0-9]*\) newly installed.*/\2/p' "$log")"
  say "  bytes of the package" "$(stat -c %s "$bare${deb[chicane]}")"
  timed "chicane drive --fast --laps 1" in_bare chicane drive --fast --laps 1
  in_bare chicane manual | cmp - <(gzip -dc "$bare/usr/share/man/man1/chicane.1.gz") || fail "the manual page is not the program's"
}

check_library() {
  timed "apt install ./libchicane-dev_*.deb with a compiler" apt install "${deb[libchicane-dev]}" "${deb[chicane-doc]}" g++ pkg-config cmake make
  timed "the first example by pkg-config" in_bare sh -c \
    'cd /check && g++ /usr/share/doc/chicane/examples/01_drive_a_lap.cpp -o lap $(pkg-config --cflags --libs chicane)'
  timed "  drives a lap" in_bare sh -c 'cd / && /check/lap'
  timed "a controller and a car of one's own by CMake" in_bare sh -c 'cmake -S /usr/share/doc/chicane/examples -B /check/built &&
    cmake --build /check/built --target 03_your_own_controller 06_your_own_car_and_road'
  timed "  the controller drives a lap" in_bare sh -c 'cd / && /check/built/03_your_own_controller'
  timed "  the car is driven a lap" in_bare sh -c 'cd / && /check/built/06_your_own_car_and_road'
}

check_ros() {
  [ -n "${deb[chicane-ros]:-}" ] || return 0
  ! in_bare chicane ros --domain 77 >"$log" 2>&1 || fail "chicane ros without its package: got success"
  grep -q 'apt install ./chicane-ros_' "$log" || fail "chicane ros without its package does not say how to install it: $(cat "$log")"
  timed "apt install ./chicane-ros_*.deb" apt install "${deb[chicane-ros]}"
  say "  packages" "$(sed -n 's/^\([0-9]*\) upgraded, \([0-9]*\) newly installed.*/\2/p' "$log")"
  say "  bytes of the package" "$(stat -c %s "$bare${deb[chicane-ros]}")"
  timed "  a lap by chicane ros and chicane ros --simulate" in_bare sh -c \
    'chicane ros --domain 77 --track oval --port 0 & chicane ros --domain 77 --simulate --track oval --laps 1; code=$?; kill $!; exit $code'
}

check_python() {
  [ -n "${deb[python3-chicane]:-}" ] || return 0
  timed "apt install ./python3-chicane_*.deb" apt install "${deb[python3-chicane]}"
  timed "  a lap from Python" in_bare sh -c \
    'cd / && python3 -c "import chicane; run = chicane.drive(laps=1); assert run[\"laps_completed\"] == 1"'
}

check_without_proc() {
  umount -l "$bare/proc" 2>/dev/null || true
  [ ! -e "$bare/proc/self" ] || fail "the bare system still has /proc"
  timed "without /proc: chicane drive --fast --laps 1" in_bare chicane drive --fast --laps 1
  timed "without /proc: the first example" in_bare sh -c 'cd / && /check/lap'
  [ -z "${deb[chicane-ros]:-}" ] || timed "without /proc: chicane ros starts" in_bare sh -c \
    'chicane ros --interface none-such; test $? = 3'
}

check_purge() {
  timed "purge of all packages" apt purge "${!deb[@]}"
  local left
  left=$(traces)
  [ -z "$left" ] || fail "purge has left $left"
  ! in_bare dpkg -l '*chicane*' 2>/dev/null | grep -E '^[a-z]c' || fail "purge has left settings"
}

if [ "${1:-}" = --in ]; then
  bare=$2 log=$2/check.log
  declare -A deb
  mkdir "$bare/check"
  cp "$3"/*.deb "$3"/chicane-*.tar.zst "$bare/check"
  for package in chicane libchicane-dev chicane-doc chicane-ros python3-chicane; do  # the last two where they were built
    file=$(cd "$3" && echo "${package}"_*.deb)
    [ ! -e "$3/$file" ] || deb[$package]=/check/$file
  done
  for package in chicane libchicane-dev chicane-doc; do [ -n "${deb[$package]:-}" ] || fail "$3: there is no package $package"; done
  [ -e "$bare/proc/self/exe" ] || fail "the bare system has no /proc to begin with"
  check_tarball
  check_program
  check_ros
  check_library
  check_python
  check_without_proc
  check_purge
  mount -t proc proc "$bare/proc" 2>/dev/null || true  # as mmdebstrap left it
  exit 0
fi

packages=$(cd "${1:-$root/build/release/packages}" && pwd -P) || fail "no packages there: ./run.sh package makes them"
if command -v lintian >/dev/null; then
  said=$(lintian --fail-on error,warning "$packages"/*.deb 2>&1) || fail "lintian: $said"
  say "lintian" "no errors, no warnings"
fi
command -v mmdebstrap >/dev/null || { echo "check_package: mmdebstrap is not installed"; exit 77; }
suite=$(. /etc/os-release && echo "${VERSION_CODENAME:-bookworm}")
printf -v hook '%q --in "$1" %q' "$root/tools/check_package.sh" "$packages"
result=0
mirror=(${CHICANE_DEBIAN_MIRROR:+"$CHICANE_DEBIAN_MIRROR"})  # none: Debian's own
mmdebstrap --quiet --variant=minbase --customize-hook="$hook" "$suite" /dev/null "${mirror[@]}" || result=$?
[ "$result" -eq 0 ] || fail "mmdebstrap ended with $result"
