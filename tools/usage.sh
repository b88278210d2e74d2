# shellcheck shell=bash
# Sourced first by the programs of this folder, with their arguments: prints the comment at their top and ends them, where the first
# argument is --help or -h.
case "${1:-}" in
  -h | --help) sed -n '/^#!/d; /^# SPDX/d; /^#/!q; s/^# \{0,1\}//p' "${BASH_SOURCE[1]}"; exit 0 ;;
esac
