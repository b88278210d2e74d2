#!/usr/bin/env bash
# Installs a build to a folder and moves the folder, as the other tests here expect it.
#   install.sh BUILD_FOLDER WORK_FOLDER
set -euo pipefail
build=$1 work=$2
rm -rf "$work"/{first,moved}
cmake --install "$build" --prefix "$work/first" >/dev/null
mv "$work/first" "$work/moved"
