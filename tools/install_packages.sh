# shellcheck shell=bash
# Installs the Debian packages that are missing. Sourced by run.sh, test.sh and tools/check.sh.

# To build and run the program.
run_packages=(
  g++ cmake ninja-build ccache pkg-config
  libexpected-dev libboost-dev nlohmann-json3-dev libyaml-cpp-dev libcli11-dev libfmt-dev libzstd-dev libpng-dev libpugixml-dev
)
# To compare with Ipopt in `chicane bench`, on top of those.
bench_packages=(libeigen3-dev coinor-libipopt-dev liblapack-dev libblas-dev)
# For `chicane ros`, on top of the first.
ros_packages=(cyclonedds-dev)
# For chicane-lab, the program of many runs, logs and reports, on top of the first.
lab_packages=(libeigen3-dev libsqlite3-dev)
# For `chicane tune`, on top of those.
tune_packages=(libnlopt-dev)
# For the Python module, on top of the first.
python_packages=(python3 python3-dev python3-venv python3-pip python3-numpy pybind11-dev)
# To make packages of all that the program can do, on top of the first.
package_packages=(dpkg-dev "${lab_packages[@]}" "${tune_packages[@]}" "${ros_packages[@]}" "${python_packages[@]}")
# To build and run the tests, on top of the first.
test_packages=("${bench_packages[@]}" "${package_packages[@]}" libgtest-dev libgmock-dev libfastcdr-dev locales python3-pandas python3-numpydoc mypy groff fish parallel libglpk-dev)
# For a page that drives without a program, on top of the first: 1 GB.
page_packages=(emscripten)
# For the documentation as a site.
docs_packages=(mkdocs mkdocs-material libjs-katex)
# For the slow tests, on top of all of those.
slow_test_packages=(jupyter-nbconvert python3-ipykernel python3-matplotlib python3-torch openmpi-bin slurm-wlm munge mmdebstrap lintian libfastrtps-dev cyclonedds-tools "${page_packages[@]}")
# To run tools/check.sh, on top of those.
check_packages=(clang-format clang-tidy)

packages_changed=no
say() { printf '%s\n' "$*" >&2; }

# Prints those of the given packages that are not installed.
missing_packages() {
  local package
  for package in "$@"; do
    dpkg-query -W -f='${db:Status-Status}\n' "$package" 2>/dev/null | grep -qx installed || printf '%s\n' "$package"
  done
}

# install_packages PACKAGE...: returns 0 when nothing was missing or everything is installed now, 3 when it cannot be.
install_packages() {
  local wanted=("$@") missing as_root=()
  if ! command -v dpkg-query >/dev/null; then
    say "chicane: not a Debian system; these have to be there under the names they have here: ${wanted[*]}"
    return 0
  fi
  mapfile -t missing < <(missing_packages "${wanted[@]}")
  [ ${#missing[@]} -eq 0 ] && return 0

  if [ "$(id -u)" -ne 0 ]; then
    if ! command -v sudo >/dev/null || { [ ! -t 0 ] && ! sudo -n true 2>/dev/null; }; then
      say "chicane: some packages are missing, and installing them needs root. Please run:"
      say "  apt-get install --no-install-recommends ${missing[*]}"
      return 3
    fi
    as_root=(sudo)
  fi
  say "chicane: installing ${missing[*]}"
  local apt=("${as_root[@]}" env DEBIAN_FRONTEND=noninteractive apt-get -q -y -o DPkg::Lock::Timeout=600)
  "${apt[@]}" update </dev/null >&2 || say "chicane: the package lists could not be renewed; going on with the old ones"
  if ! "${apt[@]}" install --no-install-recommends "${missing[@]}" </dev/null >&2; then
    say "chicane: the packages above could not be installed"
    return 3
  fi
  packages_changed=yes
}

# Node and npm from any source will do; Debian's where there is none.
node_packages() {
  command -v node >/dev/null && command -v npm >/dev/null || printf '%s\n' nodejs npm
}

# Any Chromium or Chrome will do for the tests of the dashboard; where there is none, Debian's without windows, which
# takes a tenth less processor time.
browser_packages() {
  local name
  for name in chromium-headless-shell chromium google-chrome; do command -v $name >/dev/null && return; done
  if grep -qx ID=debian /etc/os-release 2>/dev/null; then echo chromium-headless-shell; else echo chromium; fi
}
