#!/usr/bin/env python3
# SPDX-License-Identifier: MIT
"""Writes tests/data/tracks: one road in the kinds of file in which other programs keep theirs. `--check` compares instead.

The road is a stadium, counter-clockwise: two straights of 60 m, two half circles of 20 m radius, 6 m wide. Files of model cars have
it at a tenth of that. tests/survey/foreign_tracks_test.cpp says what each has to become.
"""
import argparse
import json
import math
import pathlib
import random
import sys

HERE = pathlib.Path(__file__).resolve().parent / "tracks"
STRAIGHT, RADIUS, HALF = 60.0, 20.0, 3.0
LENGTH = 2 * STRAIGHT + 2 * math.pi * RADIUS


def at(s, d=0.0):
    """Place and heading at arc length s, d to the left."""
    s %= LENGTH
    bend = math.pi * RADIUS
    if s < STRAIGHT:
        x, y, psi = s, 0.0, 0.0
    elif s < STRAIGHT + bend:
        psi = (s - STRAIGHT) / RADIUS
        x, y = STRAIGHT + RADIUS * math.sin(psi), RADIUS - RADIUS * math.cos(psi)
    elif s < 2 * STRAIGHT + bend:
        x, y, psi = STRAIGHT - (s - STRAIGHT - bend), 2 * RADIUS, math.pi
    else:
        psi = math.pi + (s - 2 * STRAIGHT - bend) / RADIUS
        x, y = RADIUS * math.sin(psi), RADIUS - RADIUS * math.cos(psi)
    return x - d * math.sin(psi), y + d * math.cos(psi), psi


def ring(count, d=0.0, scale=1.0, noise=0.0, seed=1):
    chance = random.Random(seed)
    for i in range(count):
        x, y, psi = at(LENGTH * i / count, d)
        yield scale * (x + chance.gauss(0, noise)), scale * (y + chance.gauss(0, noise)), psi


def lines(*rows):
    return "\n".join(rows) + "\n"


def latlon(x, y, latitude=48.2, longitude=11.6):
    """Degrees of a place x east and y north of 48.2 N 11.6 E, on the sphere that fits the ellipsoid there."""
    s = math.sin(math.radians(latitude))
    w = 1 - 6.69437999014e-3 * s * s
    meridian, normal = 6378137 * (1 - 6.69437999014e-3) / w**1.5, 6378137 / math.sqrt(w)
    return latitude + math.degrees(y / meridian), longitude + math.degrees(x / (normal * math.cos(math.radians(latitude))))


def tables():
    yield "f1tenth_centerline.csv", lines("# x_m, y_m, w_tr_right_m, w_tr_left_m", *(f"{x:.4f}, {y:.4f}, 0.300, 0.300" for x, y, _ in ring(120, scale=0.1)))
    yield "f1tenth_raceline.csv", lines(
        "# 7daf4d34-0000-4000-8000-000000000000", "# 603fd3", "# s_m; x_m; y_m; psi_rad; kappa_radpm; vx_mps; ax_mps2",
        *(f"{0.1 * LENGTH * i / 120:.7f}; {x:.7f}; {y:.7f}; {psi - math.pi / 2:.7f}; 0.0; 5.0; 0.0" for i, (x, y, psi) in enumerate(ring(120, scale=0.1))))
    yield "tum_centre_line.csv", lines("# x_m,y_m,w_tr_right_m,w_tr_left_m", *(f"{x:.6f},{y:.6f},2.500,3.500" for x, y, _ in ring(60, d=-0.5)))
    first = next(ring(100))
    yield "tum_race_line.csv", lines(
        "# s_m; x_m; y_m; psi_rad; kappa_radpm; vx_mps; ax_mps2",
        *(f"{LENGTH * i / 100:.4f}; {x:.4f}; {y:.4f}; {psi - math.pi / 2:.4f}; 0; 20; 0" for i, (x, y, psi) in enumerate(ring(100))),
        f"{LENGTH:.4f}; {first[0]:.4f}; {first[1]:.4f}; {-math.pi / 2:.4f}; 0; 20; 0")
    yield "gym_waypoints.csv", lines(*(f"{x:.4f},{y:.4f},5.0,{psi:.4f}" for x, y, psi in ring(120, scale=0.1)))
    yield "matlab_writematrix.txt", lines("% x_m y_m", *(f"{x:.6e} {y:.6e}" for x, y, _ in ring(100)))
    yield "matlab_writetable.csv", lines('"x","y","width"', *(f"{x:.5f},{y:.5f},6" for x, y, _ in ring(100)))
    decimal = lines("X_m;Y_m;W_tr_right_m;W_tr_left_m", *(f"{x:.3f};{y:.3f};3,0;3,0".replace(".", ",") for x, y, _ in ring(100)))
    yield "decimal_commas.csv", "\ufeff" + decimal.replace("\n", "\r\n")
    back = [(x, y) for x, y, _ in ring(100)][::-1]
    yield "clockwise.csv", lines("x\ty", *(f"{x:.4f}\t{y:.4f}" for x, y in [*back, back[0]]))
    yield "utm.csv", lines("easting,northing,width_left,width_right", *(f"{691000 + x:.3f},{5336000 + y:.3f},3,3" for x, y, _ in ring(100)))
    yield "autoware.csv", lines("x,y,z,yaw,velocity,change_flag", *(f"{x:.4f},{y:.4f},18.3,{psi:.4f},8.0,0" for x, y, psi in ring(120)))


def forzaeth():
    points = [{"id": i, "s_m": round(0.1 * LENGTH * i / 120, 4), "d_m": 0.0, "x_m": round(x, 4), "y_m": round(y, 4), "d_right": 0.3, "d_left": 0.3,
               "psi_rad": round(psi, 4), "kappa_radpm": 0.0, "vx_mps": 5.0, "ax_mps2": 0.0} for i, (x, y, psi) in enumerate(ring(120, scale=0.1))]
    head = {"seq": 0, "stamp": {"secs": 0, "nsecs": 0}, "frame_id": ""}
    return json.dumps({"map_info_str": {"data": "IQP estimated lap time: 5.1s"}, "est_lap_time": {"data": 5.1}, "centerline_markers": {"markers": []},
                       "centerline_waypoints": {"header": head, "wpnts": points}, "global_traj_wpnts_iqp": {"header": head, "wpnts": points[:5]}})


def cones():
    """Every 4 m; two blue ones and a yellow one are missing, the first two on each side are orange."""
    count = round(LENGTH / 4)
    for i in range(count):
        for side, d in (("blue", HALF), ("yellow", -HALF)):
            if (side, i) in (("blue", 20), ("blue", 21), ("yellow", 40)):
                continue
            x, y, _ = at(LENGTH * (i + (0.5 if side == "yellow" else 0.0)) / count, d)
            yield ("big_orange" if i == 0 else side), round(x, 3), round(y, 3)


def cone_files():
    mixed = sorted(cones(), key=lambda cone: math.sin(1000 * cone[1] + cone[2]))
    yield "cones.csv", lines("tag,x,y,direction,x_variance,y_variance,xy_covariance", *(f"{tag},{x},{y},0,0.01,0.01,0" for tag, x, y in mixed), "car_start,0,0,0,0,0,0")
    text = "cones_left:\n" + "".join(f"- [{x}, {y}]\n" for tag, x, y in cones() if tag == "blue")
    text += "cones_right:\n" + "".join(f"- [{x}, {y}]\n" for tag, x, y in cones() if tag == "yellow")
    text += "cones_orange: []\ncones_orange_big:\n" + "".join(f"- [{x}, {y}]\n" for tag, x, y in cones() if tag == "big_orange")
    yield "fssim.yaml", text + "starting_pose_front_wing: [0.0, 0.0, 0.0]\ntk_device:\n- [3.0, 4.5]\n"
    model = {"blue": "blue_cone", "yellow": "yellow_cone", "big_orange": "big_cone_orange"}
    includes = "".join(f"<include><uri>model://eufs_tracks/models/{model[tag]}</uri><pose>{x} {y} 0 0 0 0</pose><name>cone_{i}</name></include>\n" for i, (tag, x, y) in enumerate(mixed))
    yield "cones.sdf", f"<?xml version='1.0'?>\n<sdf version='1.6'><world name='w'><include><uri>model://ground_plane</uri></include>\n{includes}</world></sdf>\n"
    yield "one_side.csv", lines("x,y,color", *(f"{x},{y},blue" for tag, x, y in cones() if tag == "blue"))


def geography():
    chance = random.Random(4)
    fixes = []
    for i in range(3 * 80):
        x, y, _ = at(LENGTH * i / 80)
        fixes.append(latlon(x + chance.gauss(0, 0.3), y + chance.gauss(0, 0.3)))
    points = "".join(f'<trkpt lat="{a:.7f}" lon="{o:.7f}"><ele>512.3</ele><time>2024-05-01T10:00:00Z</time></trkpt>\n' for a, o in fixes)
    yield "three_laps.gpx", f'<?xml version="1.0" encoding="UTF-8"?>\n<gpx version="1.1" creator="x" xmlns="http://www.topografix.com/GPX/1/1"><trk><trkseg>\n{points}</trkseg></trk></gpx>\n'
    places = [latlon(x, y) for x, y, _ in ring(100)]
    closed = [*places, places[0]]
    text = " ".join(f"{o:.8f},{a:.8f},0" for a, o in closed)
    yield "course.kml", ('<?xml version="1.0" encoding="UTF-8"?>\n<kml xmlns="http://www.opengis.net/kml/2.2"><Document><Placemark><Point><coordinates>11.6,48.2</coordinates>'
                         f"</Point></Placemark><Placemark><LineString><coordinates>\n{text}\n</coordinates></LineString></Placemark></Document></kml>\n")
    nodes = "".join(f'<node id="{i + 1}" lat="{a:.8f}" lon="{o:.8f}"/>\n' for i, (a, o) in enumerate(places))

    def way(number, ids, *tags):
        return f'<way id="{number}">' + "".join(f'<nd ref="{i}"/>' for i in ids) + "".join(f'<tag k="{k}" v="{v}"/>' for k, v in tags) + "</way>\n"

    ways = way(1, range(1, 61), ("highway", "raceway"), ("width", "6 m"), ("oneway", "yes")) + way(2, [*range(60, 101), 1], ("highway", "raceway"))
    ways += way(3, [5, 30], ("highway", "service"))
    yield "course.osm", f'<?xml version="1.0"?>\n<osm version="0.6">\n{nodes}{ways}</osm>\n'
    shape = {"type": "LineString", "coordinates": [[round(o, 8), round(a, 8)] for a, o in closed]}
    yield "course.geojson", json.dumps({"type": "FeatureCollection", "features": [{"type": "Feature", "properties": {"width": 6}, "geometry": shape}]})


def networks():
    def road(number, nxt, pieces):
        plan, s = "", 0.0
        for x, y, hdg, length, shape in pieces:
            plan += f'<geometry s="{s}" x="{x:.9f}" y="{y:.9f}" hdg="{hdg:.9f}" length="{length:.9f}">{shape}</geometry>\n'
            s += length
        lane = '<lane id="{}" type="{}" level="false"><width sOffset="0" a="{}" b="0" c="0" d="0"/></lane>'
        lanes = ('<laneSection s="0"><left>' + lane.format(2, "shoulder", 1.5) + lane.format(1, "driving", 3) + '</left><center><lane id="0" type="none"/></center><right>'
                 + lane.format(-1, "driving", 3) + lane.format(-2, "sidewalk", 2) + "</right></laneSection>")
        link = f'<link><predecessor elementType="road" elementId="{nxt}" contactPoint="end"/><successor elementType="road" elementId="{nxt}" contactPoint="start"/></link>'
        return f'<road name="" length="{s:.9f}" id="{number}" junction="-1">{link}<planView>\n{plan}</planView><lanes>{lanes}</lanes></road>\n'

    bend = math.pi * RADIUS
    # The second half circle is a parametric curve of two pieces, as editors write them.
    halves = []
    for k in range(2):
        x, y, psi = at(2 * STRAIGHT + bend + k * bend / 2)
        h = 4 / 3 * math.tan(math.pi / 8) * RADIUS  # of a Bezier curve for a quarter circle, as a polynomial
        p = [(0, 0), (h, 0), (RADIUS, RADIUS - h), (RADIUS, RADIUS)]
        b, c, d = ([3 * (p[1][i] - p[0][i]) for i in (0, 1)], [3 * (p[0][i] - 2 * p[1][i] + p[2][i]) for i in (0, 1)], [p[3][i] - 3 * p[2][i] + 3 * p[1][i] - p[0][i] for i in (0, 1)])
        halves.append((x, y, psi, bend / 2, f'<paramPoly3 pRange="normalized" aU="0" bU="{b[0]}" cU="{c[0]}" dU="{d[0]}" aV="0" bV="{b[1]}" cV="{c[1]}" dV="{d[1]}"/>'))
    first = road(1, 2, [(*at(0), STRAIGHT, "<line/>"), (*at(STRAIGHT), bend, f'<arc curvature="{1 / RADIUS}"/>')])
    second = road(2, 1, [(*at(STRAIGHT + bend), STRAIGHT, "<line/>"), *halves])
    yield "course.xodr", f'<?xml version="1.0"?>\n<OpenDRIVE><header revMajor="1" revMinor="6"/>\n{first}{second}</OpenDRIVE>\n'


def open_map():
    """A bent corridor without a way round, its far end not seen."""
    rows = ["." * 120] * 60
    cells = [[205] * 120 for _ in rows]
    for y in range(10, 50):
        for x in range(10, 110):
            inside = (y < 30 or x > 80) and x > 10
            edge = y in (10, 49) or x in (10, 109) or (y == 30 and x <= 80) or (x == 80 and y >= 30)
            cells[y][x] = 0 if edge else 254 if inside else 205
    for y in range(48, 50):
        for x in range(81, 109):
            cells[y][x] = 205
    body = lines("P2", "# a corridor", "120 60", "255", *(" ".join(map(str, row)) for row in cells[::-1]))
    yield "no_loop.pgm", body
    yield "no_loop.yaml", "image: no_loop.pgm\nresolution: 0.05\norigin: [-1, -1, 0]\nnegate: 0\noccupied_thresh: 0.65\nfree_thresh: 0.25\n"


def main():
    parser = argparse.ArgumentParser(description=__doc__)
    parser.add_argument("--check", action="store_true", help="compare with the files, write nothing")
    check = parser.parse_args().check
    files = [*tables(), ("global_waypoints.json", forzaeth()), *cone_files(), *geography(), *networks(), *open_map()]
    for name, text in files:
        if not check:
            HERE.mkdir(parents=True, exist_ok=True)
            (HERE / name).write_bytes(text.encode())
        elif (HERE / name).read_bytes() != text.encode():
            sys.exit(f"{HERE / name} is not what tests/data/make_foreign_tracks.py makes")


if __name__ == "__main__":
    main()
