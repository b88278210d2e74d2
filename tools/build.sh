# shellcheck shell=bash
# Configures and builds build/release. Sourced by run.sh and test.sh, after install_packages.sh.

# As many compilers as cores, but no more than memory holds: the largest file takes 2 GB.
build_jobs() {
  local cores memory
  cores=$(nproc)
  memory=$(awk '/^MemAvailable/ { print int($2 / 2000000) }' /proc/meminfo 2>/dev/null)
  [ "${memory:-0}" -ge 1 ] || memory=1
  echo $((cores < memory ? cores : memory))
}

# is_configured ROOT NAME=VALUE...: build/release belongs to this folder and has these options.
is_configured() {
  local root=$1 cache=$1/build/release/CMakeCache.txt option
  shift
  [ -f "$root/build/release/build.ninja" ] && grep -qxF "CMAKE_HOME_DIRECTORY:INTERNAL=$root" "$cache" || return 1
  for option in "$@"; do
    grep -qx "${option%%=*}:[A-Z]*=${option#*=}" "$cache" || return 1
  done
}

# cached ROOT NAME: the value of an option of build/release; nothing when it has none.
cached() { sed -n "s/^$2:[A-Z]*=//p" "$1/build/release/CMakeCache.txt"; }

# is_of_lab ROOT COMMAND: chicane-lab does it, by its row in the table of commands.
is_of_lab() { grep -qzE "\{\"$2\",[^}]*in_lab" "$1/apps/chicane/commands.hpp"; }

# build_release ROOT TARGET [NAME=VALUE...]: prints nothing when there is nothing to do; all output goes to stderr.
build_release() {
  local root=$1 target=$2 build=$1/build/release fresh=() quiet=()
  shift 2
  if [ "$packages_changed" = yes ] || ! is_configured "$root" "$@"; then
    say "chicane: configuring build/release"
    mkdir -p "$build"
    is_configured "$root" || fresh=(--fresh)  # a build folder that was moved here still points to where it came from
    (cd "$root" && cmake --preset release "${fresh[@]}" "${@/#/-D}") >"$build/configure.log" 2>&1 || {
      cat "$build/configure.log" >&2
      return 1
    }
  fi
  if ninja -C "$build" -n "$target" 2>/dev/null | grep -q 'no work to do'; then
    quiet=(--quiet)
  else
    say "chicane: building $target in build/release"
  fi
  ninja -C "$build" -j "$(build_jobs)" "${quiet[@]}" "$target" </dev/null >&2
}

# processor_seconds NAME: sets that variable to the processor time, user and system, of all that this shell has started and waited for
# [s]. Not to be called in $(...), a shell of its own that has started nothing.
processor_seconds() {
  local file
  file=$(mktemp)
  times >"$file"
  printf -v "$1" %s "$(awk 'NR == 2 { split($1, u, "[ms]"); split($2, s, "[ms]"); printf "%.1f", 60 * (u[1] + s[1]) + u[2] + s[2] }' "$file")"
  rm -f "$file"
}

kilobytes() { printf '%s kB' $(($(wc -c) / 1000)); }
