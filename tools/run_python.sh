#!/usr/bin/env bash
# Installs the Python module in an environment of its own, build/python/environment, and starts Python in it: a prompt with chicane
# imported as ch, in IPython where that is there, or whatever the arguments say.
#
#   tools/run_python.sh [ARGUMENT...]     of Python; ./run.sh python calls this
set -euo pipefail
source "$(dirname "${BASH_SOURCE[0]}")/usage.sh"
root=$(cd "$(dirname "${BASH_SOURCE[0]}")/.." && pwd -P)
environment=$root/build/python/environment
[ -x "$environment/bin/python" ] || /usr/bin/python3 -m venv --system-site-packages --without-pip "$environment"
wheel=$(mktemp -d)
trap 'rm -rf "$wheel"' EXIT
log=$root/build/python/build.log
(cd "$wheel" && PYTHONPATH=$root/python/backend "$environment/bin/python" -c 'import chicane_build; chicane_build.build_wheel(".")') \
  >"$log" 2>&1 || { tail -30 "$log" >&2; exit 1; }
packages=$("$environment/bin/python" -c 'import sysconfig; print(sysconfig.get_path("platlib"))')
rm -rf "$packages/chicane" "$packages"/chicane-*.dist-info
"$environment/bin/python" -m zipfile -e "$wheel"/chicane-*.whl "$packages"
if [ $# -gt 0 ]; then
  "$environment/bin/python" "$@"
elif "$environment/bin/python" -c 'import IPython' 2>/dev/null; then
  "$environment/bin/python" -m IPython -i -c 'import chicane as ch'
else
  "$environment/bin/python" -i -c 'import chicane as ch; print("chicane", ch.__version__, "is imported as ch: help(ch)")'
fi
