#!/bin/sh
# Runs the stock socket.io-client against a server: run.sh BUILD_FOLDER SERVER_PROGRAM. 77 = skipped.
set -eu
source_folder=$(cd "$(dirname "$0")" && pwd)
build_folder=$1
server=$2

for tool in node npm; do
  if ! command -v "$tool" >/dev/null 2>&1; then
    echo "skipped: $tool is not installed"
    exit 77
  fi
done

cp "$source_folder/package.json" "$source_folder/package-lock.json" "$source_folder/.npmrc" \
   "$source_folder/socket_io_client.mjs" "$build_folder/"
cd "$build_folder"
if ! cmp -s package-lock.json node_modules/.installed-lock.json; then
  if ! npm ci --ignore-scripts --no-audit --no-fund --loglevel=error; then
    echo "skipped: socket.io-client cannot be installed (offline?)"
    exit 77
  fi
  cp package-lock.json node_modules/.installed-lock.json
fi
exec node socket_io_client.mjs "$server"
