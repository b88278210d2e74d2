#!/usr/bin/env python3
# SPDX-License-Identifier: MIT
"""Imports real public files of many kinds, and says of each whether the road is right or the refusal is.

    tools/corpus.py CHICANE [--from FOLDER] [--cache FOLDER] [--only WORD] [--all]

Fetches the commits named below from GitHub into --cache (0.5 GB; docs/tracks.md); --from takes clones called OWNER+NAME there instead.
What cannot be had is skipped with a line. A row is right where the file was imported, its length within 0.5 % of the file's own
(the polyline of its points; of OpenDRIVE the length it states) and no point further from the line than its noise (six times
`noise of X m`, at least a hundredth of the road's width), or where it was refused by a sentence that its row allows.
Prints what is wrong (--all: every file), then a table by kind. Exit code 1 where one is wrong."""
import argparse
import collections
import fnmatch
import json
import math
import re
import subprocess
import sys
import tempfile
from pathlib import Path

import usage

usage.print_if_asked(__doc__)

NO_ROAD = "open between|loop|road ends|narrow|image|cells|no road|walls|free"
ODR = "junction|jump|kink|lane|edge of the road|crosses itself|width|road|record"
LINES = "points|line|crosses|track|loop|apart|places|closed|XML|xml|latitude|longitude|coordinates|element"
# kind, repository, commit, files (of its tree), what a refusal may be about
SOURCES = (
    ("GeoJSON circuit", "bacinger/f1-circuits", "4c9c9aaae234172c52b7edac1d5d2a42e897eed8", "circuits/*.geojson", ""),
    ("GeoJSON collection", "bacinger/f1-circuits", "4c9c9aaae234172c52b7edac1d5d2a42e897eed8", "*championships/*.geojson", LINES),
    ("TUM table", "TUMFTM/racetrack-database", "e59595d1f3573b30d1ded6a08984935b957688e0", "tracks/*.csv", ""),
    ("TUM race line", "TUMFTM/racetrack-database", "e59595d1f3573b30d1ded6a08984935b957688e0", "racelines/*.csv", ""),
    ("TUM table", "TUMFTM/global_racetrajectory_optimization", "a9995e2f5407f22eb7fb9dceac2b71a35276bb41", "inputs/tracks/*.csv", ""),
    ("F1TENTH centre line", "f1tenth/f1tenth_racetracks", "b95c4eff766f6367d66b310ea20cd2c9563712c0", "*_centerline.csv", ""),
    ("F1TENTH race line", "f1tenth/f1tenth_racetracks", "b95c4eff766f6367d66b310ea20cd2c9563712c0", "*_raceline.csv", ""),
    ("F1TENTH race line", "f1tenth/f1tenth_gym", "4fdb9c7e6fb7c701290f4dc18377d07c1681724f", "examples/*.csv", ""),
    ("occupancy map", "f1tenth/f1tenth_racetracks", "b95c4eff766f6367d66b310ea20cd2c9563712c0", "*_map.yaml", NO_ROAD),
    ("occupancy map", "f1tenth/f1tenth_gym", "4fdb9c7e6fb7c701290f4dc18377d07c1681724f", "gym/*/maps/*.yaml", NO_ROAD),
    ("occupancy map", "CPS-TUWien/racing_dreamer", "398970bf2b4bf167cf53c0d0b0128a1b63d3377d", "docs/maps/maps/*.yaml", NO_ROAD),
    ("occupancy map", "ForzaETH/race_stack", "abb40902856947137a89a58d7a03bd2dd7526913", "*/maps/*map.yaml", NO_ROAD),
    ("nav2 map", "ROBOTIS-GIT/turtlebot3", "da785b7201d317e6e2a662e41bb3d3fd50ebd503", "*/map/*.yaml", NO_ROAD),
    ("ForzaETH waypoints", "ForzaETH/race_stack", "abb40902856947137a89a58d7a03bd2dd7526913", "*global_waypoints.json", ""),
    ("cones, FSSIM", "AMZ-Driverless/fssim", "cf652d8d3f1e13031dad3fb75eb3d4e6fbaaeff4", "*tracks_yaml/*.yaml", "crosses|narrow|cones"),
    ("cones, Gazebo", "AMZ-Driverless/fssim", "cf652d8d3f1e13031dad3fb75eb3d4e6fbaaeff4", "*models/track/*.sdf", "crosses|narrow|cones"),
    ("cones, Gazebo", "eufsa/eufs_sim", "dc98716a67a9466a8a51b7a7c3e1d6c469a15d63", "eufs_description/models/*.sdf", "crosses|narrow|cones"),
    ("cones, FSDS", "FS-Driverless/Formula-Student-Driverless-Simulator", "59f03fae8b963c6791eb11270d2e75aa038fff20", "maps/*.csv", ""),
    ("OpenDRIVE", "esmini/esmini", "77028d83e6d402de52f7187e5384d1b1c02b7d1f", "*.xodr", ODR),
    ("OpenDRIVE", "pageldev/libOpenDRIVE", "c3a5c8c8a3a16483f6a8ae9efb6fcb096f7ce2fb", "tests/*.xodr", ODR),
    ("OpenDRIVE", "CommonRoad/commonroad-scenario-designer", "e3baf5cbe9f761980e64c1c63529e5bf9f6219d5", "*.xodr", ODR),
    ("CommonRoad", "CommonRoad/commonroad-io", "8275861a448dd16cf0786357f0c7cf8762926838", "t*.xml", "CommonRoad"),
    ("CommonRoad", "CommonRoad/commonroad-raceline-planner", "7d29eae13a08445a2ca9f59d2d3003560ba1e96b", "*.xml", "CommonRoad"),
    ("CommonRoad", "CommonRoad/commonroad-scenario-designer", "e3baf5cbe9f761980e64c1c63529e5bf9f6219d5", "*test_maps/*.xml", "CommonRoad"),
    ("Lanelet2", "fzi-forschungszentrum-informatik/Lanelet2", "ae39c8d673264afac2339c4f0252df53a7ba82dd", "*.osm", "lanelet|crosses"),
    ("Lanelet2", "autowarefoundation/autoware_lanelet2_extension", "5b1cb2391055c4c661ff4f79c094889d1a1d95aa", "*.osm", "lanelet"),
    ("Lanelet2", "CommonRoad/commonroad-scenario-designer", "e3baf5cbe9f761980e64c1c63529e5bf9f6219d5", "*/lanelet2/*.osm", "lanelet"),
    ("OpenStreetMap", "CommonRoad/commonroad-scenario-designer", "e3baf5cbe9f761980e64c1c63529e5bf9f6219d5", "*/osm/*.osm", LINES + "|way"),
    ("GPX", "tkrajina/gpxpy", "017d9961ee9aa86ccdbf5bb50a4e2341d5c42f4b", "test_files/*.gpx", LINES),
    ("GPX", "placemark/togeojson", "b99baa6e74fc528648353d081411db56fe84283c", "test/data/*.gpx", LINES),
    ("KML", "placemark/togeojson", "b99baa6e74fc528648353d081411db56fe84283c", "test/data/*.kml", LINES),
    ("MPCC", "alexliniger/MPCC", "bd331621ba47ae3326711922a863bdb1cdf2d2ea", "*track.json", "MPCC"),
)


def git(folder, *words):
    return subprocess.run(["git", "-C", str(folder), *words], capture_output=True)


def tree_of(repository, commit, options):
    """A git folder with that commit; None where it cannot be had."""
    folder = Path(getattr(options, "from") or options.cache) / repository.replace("/", "+")
    has_commit = folder.exists() and git(folder, "cat-file", "-e", f"{commit}^{{tree}}").returncode == 0
    if not has_commit and not getattr(options, "from"):
        folder.mkdir(parents=True, exist_ok=True)
        git(folder, "init", "-q")
        has_commit = git(folder, "fetch", "-q", "--depth", "1", f"https://github.com/{repository}", commit).returncode == 0
    return folder if has_commit else None


def places_of(text, name):
    """The file's own points [m]; empty where they are not read here."""
    if name.endswith(".geojson"):
        lines = [each["geometry"]["coordinates"] for each in json.loads(text)["features"] if each["geometry"]["type"] == "LineString"]
        line = max(lines, key=len)
        middle = math.radians(sum(place[1] for place in line) / len(line))
        return [(111319.49 * place[0] * math.cos(middle) * (1 + 0.00335 * math.sin(middle)**2), 111132.95 * place[1] * (1 - 0.00505 * math.cos(2 * middle)))
                for place in line]
    if not name.endswith(".csv"):
        return []
    rows = [re.split(r"[,;\s]+", line.strip().lstrip("# ")) for line in text.splitlines() if line.strip()]
    heads = [row for row in rows if "x_m" in row]
    x, y = (heads[-1].index("x_m"), heads[-1].index("y_m")) if heads else (0, 1)
    return [(float(row[x]), float(row[y])) for row in rows if re.fullmatch(r"[-+\d.eE]+", row[0]) and len(row) > y]


def length_of(text, name, is_closed):
    """[m]; not-a-number where the file does not say."""
    if name.endswith(".xodr"):                       # lanes on both sides, as the middle of one side is another line
        is_even = text.count("<road ") == 1 and re.search(r'lane id="1"', text)
        return sum(map(float, re.findall(r'<geometry[^>]* length="([^"]+)"', text))) if is_even else math.nan
    places = places_of(text, name)
    return sum(math.dist(a, b) for a, b in zip(places, places[1:] + places[:is_closed])) if len(places) > 2 else math.nan


def judge(program, file, text, allowed):
    """What came out, and what is wrong with it."""
    done = subprocess.run([program, "import", str(file), "--json"], capture_output=True, text=True, timeout=300)
    last = (done.stderr.strip().splitlines() or [""])[-1].replace(str(file.parent) + "/", "")
    if done.returncode != 0:
        is_right = done.returncode == 2 and re.search(r"got .*[,;] expected ", last) and re.search(f"git-LFS|{allowed}" if allowed else "git-LFS", last)
        return f"refused: {last}", "" if is_right else f"exit code {done.returncode}"
    road = json.loads(done.stdout)
    noise = [float(each) for each in re.findall(r"noise of ([\d.]+) m", " ".join(road["notices"]))]
    own, most = length_of(text, file.name, road["is_closed"]), max(6 * max(noise, default=0.1), 0.01 * road["widest_m"])
    if abs(road["length_m"] / own - 1) > 0.005:
        return "imported", f"{road['length_m']:.2f} m long, the file says {own:.2f} m"
    return "imported", f"a point {road['max_m']:.2f} m from the line, noise {noise}" if road["max_m"] > most else ""


def main():
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("chicane")
    parser.add_argument("--from", default="")
    parser.add_argument("--cache", default=str(Path.home() / ".cache/chicane/corpus"))
    parser.add_argument("--only", default="")
    parser.add_argument("--all", action="store_true")
    options = parser.parse_args()
    tally = collections.defaultdict(lambda: [0, 0, 0])
    for kind, repository, commit, files, allowed in SOURCES:
        if options.only not in f"{kind} {repository}":
            continue
        folder = tree_of(repository, commit, options)
        if folder is None:
            print(f"skipped: {kind} of {repository}: {commit[:8]} cannot be had", flush=True)
            continue
        for name in git(folder, "ls-tree", "-r", "--name-only", commit).stdout.decode().splitlines():
            if not fnmatch.fnmatch(name, files):
                continue
            with tempfile.TemporaryDirectory() as place:
                file = Path(place) / Path(name).name
                content = git(folder, "show", f"{commit}:{name}")
                if content.returncode != 0:
                    print(f"skipped: {repository}/{name}: its content cannot be had", flush=True)
                    continue
                file.write_bytes(content.stdout)
                text = file.read_text(encoding="utf-8", errors="replace")
                for image in re.findall(r"^image: *['\"]?([^'\"\n]+?)['\"]? *$", text, re.M):
                    shown = git(folder, "show", f"{commit}:{Path(name).parent / image}")
                    if shown.returncode == 0:
                        (Path(place) / image).write_bytes(shown.stdout)
                outcome, wrong = judge(options.chicane, file, text, allowed)
            row = tally[kind]
            row[0] += outcome == "imported" and not wrong
            row[1] += outcome != "imported" and not wrong
            row[2] += bool(wrong)
            if wrong or options.all:
                print(f"{'WRONG' if wrong else 'right'}: {kind}: {repository}/{name}: {outcome}{'; ' + wrong if wrong else ''}", flush=True)
    print("\n| kind | imported | refused | wrong |\n|---|--:|--:|--:|")
    for kind, row in [*tally.items(), ("all", [sum(column) for column in zip(*tally.values())])]:
        print(f"| {kind} | {row[0]} | {row[1]} | {row[2]} |")
    return 1 if any(row[2] for row in tally.values()) else 0


if __name__ == "__main__":
    sys.exit(main())
