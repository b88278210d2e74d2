#!/usr/bin/env bash
# From a clone to a car on the screen: installs what is missing, builds, and runs the program.
#
#   ./run.sh                                      drive until Ctrl-C, with the dashboard at http://localhost:4567/
#   ./run.sh --laps 1                             options alone mean `drive`
#   ./run.sh drive --fast --laps 2 --json         any command of `chicane`; stdout carries its results only
#   ./run.sh bench                                builds the benchmark, too, with Ipopt to compare with
#   ./run.sh sweep studies/plans/NAME.yaml        builds the program of many runs, logs and reports, too; `tune` installs NLopt
#   ./run.sh ros --car f1tenth                    a ROS 2 node; installs Cyclone DDS, too (docs/ros.md)
#   ./run.sh package [--page]                     makes Debian packages and a tarball in build/release/packages (docs/packages.md)
#   ./run.sh python [ARGUMENT...]                 Python with `import chicane` (docs/python.md): a prompt, or a script and its arguments
#   ./run.sh docs                                 writes the documentation as a site, build/docs/index.html
#   ./run.sh page --out DIR                       writes a page that drives without a program, in the browser alone (WebAssembly)
set -euo pipefail
root=$(cd "$(dirname "${BASH_SOURCE[0]}")" && pwd -P)
source "$root/tools/install_packages.sh"
source "$root/tools/build.sh"

if [ "${1:-}" = page ] && [[ " $* " != *' -h '* && " $* " != *' --help '* ]]; then
  [ "${2:-}" = --out ] && [ -n "${3:-}" ] && [ $# -eq 3 ] || { say "usage: ./run.sh page --out DIR"; exit 2; }
  mapfile -t node < <(node_packages)
  install_packages "${run_packages[@]}" "${page_packages[@]}" "${node[@]}"
  exec "$root/tools/build_page.sh" "$3"
fi

if [ "${1:-}" = package ] && { [ $# -eq 1 ] || { [ $# -eq 2 ] && [ "$2" = --page ]; }; }; then
  mapfile -t node < <(node_packages)
  install_packages "${run_packages[@]}" "${package_packages[@]}" "${node[@]}"
  options=(CHICANE_SIMD=all CHICANE_PYTHON=ON CHICANE_PYTHON_TWO_SIZES=OFF)
  is_configured "$root" || options+=(CHICANE_BUILD_TESTS=OFF CHICANE_BUILD_EXAMPLES=OFF)
  build_release "$root" chicane_installed "${options[@]}"
  (cd "$root/build/release" && rm -rf packages && cpack >cpack.log 2>&1) || { cat "$root/build/release/cpack.log" >&2; exit 3; }
  # The page that needs no program, beside the tarball: asked for, because emscripten is 1 GB.
  if [ "${2:-}" = --page ]; then
    install_packages "${page_packages[@]}"
    version=$(sed -n 's/^CMAKE_PROJECT_VERSION:[A-Z]*=//p' "$root/build/release/CMakeCache.txt")
    page=$root/build/release/packages/chicane-$version-page
    "$root/tools/build_page.sh" "$page"
    cp "$root/LICENSE" "$page"
    tar -C "$root/build/release/packages" --sort=name --owner=0 --group=0 -cf "$page.tar.zst" --zstd "chicane-$version-page"
    rm -r "$page"
  fi
  printf '%s\n' "$root"/build/release/packages/*
  exit 0
fi

if [ "${1:-}" = docs ] && [ $# -eq 1 ]; then
  install_packages "${docs_packages[@]}"
  mkdocs build --quiet --config-file "$root/mkdocs.yml"
  cp -r /usr/share/javascript/katex "$root/build/docs/katex"
  echo 'renderMathInElement(document.body)' >"$root/build/docs/katex/start.js"
  say "chicane: $root/build/docs/index.html"
  exit 0
fi

if [ "${1:-}" = python ]; then
  mapfile -t node < <(node_packages)
  install_packages "${run_packages[@]}" "${python_packages[@]}" python3-pandas "${node[@]}"
  exec "$root/tools/run_python.sh" "${@:2}"
fi

target=chicane_app
extra=()
case " $* " in
  *' -h '* | *' --help '*) ;;
  ' bench '*) target=chicane_bench extra=("${bench_packages[@]}") ;;
  ' ros '*) target=chicane_ros_app extra=("${ros_packages[@]}") ;;
  ' tune '*) extra=("${tune_packages[@]}") ;;&
  ' video '*) extra=(ffmpeg) ;;&
  *) if is_of_lab "$root" "${1:-}"; then target=chicane_lab extra+=("${lab_packages[@]}"); fi ;;
esac
mapfile -t node < <(node_packages)
install_packages "${run_packages[@]}" "${extra[@]}" "${node[@]}"
# The first build is no larger than this machine and this command need; an instruction set that is asked for is added.
options=() simd=all
if is_configured "$root"; then
  simd=$(cached "$root" CHICANE_SIMD)
else
  simd=native options=(CHICANE_BUILD_TESTS=OFF CHICANE_BUILD_EXAMPLES=OFF CHICANE_SIMD=native)
fi
case "${CHICANE_SIMD:-}:;${simd:-all};" in
  :* | *';all;' | "${CHICANE_SIMD:-}:"*";${CHICANE_SIMD:-};"*) ;;
  baseline:* | avx2:* | avx512:* | neon:*) options+=("CHICANE_SIMD=$simd;$CHICANE_SIMD") ;;
esac
build_release "$root" "$target" "${options[@]}"

case "${1:-}" in
  -h | --help | --version) ;;
  '' | -*) set -- drive "$@" ;;
esac
CHICANE_COMMAND=$0 exec "$root/build/release/apps/chicane/chicane" "$@"
