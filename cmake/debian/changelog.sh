#!/bin/sh
# Prints the changelog of the packages, dated by the commit that they are made of, so that the same commit makes the same package.
#   changelog.sh VERSION MAINTAINER
set -eu
epoch=${SOURCE_DATE_EPOCH:-$(git -C "$(dirname "$0")" log -1 --format=%ct 2>/dev/null || date +%s)}
cat <<END
chicane ($1) unstable; urgency=medium

  * What changed is listed in changelog.gz.

 -- $2  $(LC_ALL=C date -u -R -d "@$epoch")
END
