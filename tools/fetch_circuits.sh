#!/bin/bash
# SPDX-License-Identifier: MIT
# Fetches public tracks, which are not part of the source, into the folder `circuits`: seven circuits of TUMFTM (LGPL-3, track geometry by
# OpenStreetMap contributors, ODbL) and the waypoints of Udacity's course (MIT). Tests, `chicane claims` and studies/plans/racing-circuits.yaml
# use them where they are. Files that are there already are kept; each is checked by its SHA-256.
#
#   tools/fetch_circuits.sh [FOLDER]
set -euo pipefail
case "${1:-}" in -h | --help) sed -n '3,7s/^# \{0,1\}//p' "$0"; exit 0 ;; esac
folder=${1:-$(dirname "$0")/../circuits}
github=https://raw.githubusercontent.com
database=$github/TUMFTM/racetrack-database/master/tracks
mkdir -p "$folder"
failed=0
while read -r sum url; do
  file=$folder/$(basename "$url")
  if [ ! -e "$file" ]; then
    curl --fail --silent --show-error --location --max-time 60 --output "$file.part" "$url" || { failed=1; continue; }
    mv "$file.part" "$file"
  fi
  echo "$sum  $file" | sha256sum --check --quiet || { echo "$file: got other bytes than expected; delete it to fetch it again" >&2; failed=1; }
done <<LIST
a33b772c3cd93d2cbe9bc3da8a06b789dbf4a5e3783c99011afd91100a5f8f37 $github/udacity/CarND-MPC-Project/master/lake_track_waypoints.csv
4254dc23f263bbe6c85c67e48d9a466e4f710da03f1370dff3fdc378de705471 $database/IMS.csv
4b5993986e67950df1b89efa03a4df02127f07b7213985917f0bad27ad3d48b6 $database/Monza.csv
8857d3c362ad2923c1f93c8d257498f50459770b9021adcc7969b71085c31d9a $database/Norisring.csv
9fea2a9daa25311bb251be416140b6c55cb2e53bb4f69c28f512fbfce25a3f87 $database/Nuerburgring.csv
27c51454e81780a75c353d3e6c9f73dbbcd1e82139782e95bd722ade19736e39 $database/Silverstone.csv
952673dfa772427be8a9013b8c1cb5ff5935f85c0c21d2a223adb04c6d640c8a $database/Spa.csv
a680e8e94cde7c3e91abaf2b1613c45a9d490e798d8b171dc80619c56a35c5c2 $github/TUMFTM/global_racetrajectory_optimization/master/inputs/tracks/berlin_2018.csv
LIST
exit $failed
