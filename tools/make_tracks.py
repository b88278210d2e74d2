#!/usr/bin/env python3
# SPDX-License-Identifier: MIT
"""Makes the shipped tracks, data/tracks/*.csv, from curvature profiles: straights, arcs and clothoids between them.

    tools/make_tracks.py            writes the files
    tools/make_tracks.py --check    fails when a file differs from what this program makes

A profile is a list of (length_m, curvature_1pm) for stretches of constant curvature with the length of the linear
transition before each. It is closed numerically: Newton's method on a few lengths until the end meets the start, in
place and direction (docs/tracks.md). Needs Python 3.9, nothing else.
"""

import argparse
import bisect
import math
import pathlib
import random
import sys

TRACKS = pathlib.Path(__file__).resolve().parent.parent / "data/tracks"
STEP = 0.1  # of the integration along the line [m]


class Profile:
    """Curvature over arc length: transition of t metres to curvature k, then s metres with it; cyclic."""

    def __init__(self, pieces):
        self.pieces = [list(piece) for piece in pieces]  # [transition, length, curvature]

    def corners(self):
        """Knots (s, curvature) of the piecewise linear profile over one lap."""
        s, knots = 0.0, [(0.0, self.pieces[-1][2])]
        for transition, length, curvature in self.pieces:
            knots.append((s + transition, curvature))
            s += transition + length
            knots.append((s, curvature))
        return knots

    def length(self):
        return sum(transition + length for transition, length, _ in self.pieces)

    def turn(self):
        knots = self.corners()
        return sum(0.5 * (a[1] + b[1]) * (b[0] - a[0]) for a, b in zip(knots, knots[1:]))

    def integrate(self):
        """Rows (s, x, y, heading, curvature) every STEP, one lap."""
        knots = self.corners()
        starts = [s for s, _ in knots]
        headings = [0.0]
        for (s0, k0), (s1, k1) in zip(knots, knots[1:]):
            headings.append(headings[-1] + 0.5 * (k0 + k1) * (s1 - s0))

        def state(s):
            i = max(min(bisect.bisect_right(starts, s) - 1, len(knots) - 2), 0)
            (s0, k0), (s1, k1) = knots[i], knots[i + 1]
            t = s - s0
            slope = (k1 - k0) / (s1 - s0) if s1 > s0 else 0.0
            return headings[i] + t * (k0 + 0.5 * slope * t), k0 + slope * t

        count = max(1, round(self.length() / STEP))
        step = self.length() / count
        rows, x, y = [], 0.0, 0.0
        for i in range(count + 1):
            heading, curvature = state(i * step)
            rows.append((i * step, x, y, heading, curvature))
            middle, _ = state((i + 0.5) * step)
            after, _ = state((i + 1) * step)
            x += step / 6.0 * (math.cos(heading) + 4.0 * math.cos(middle) + math.cos(after))
            y += step / 6.0 * (math.sin(heading) + 4.0 * math.sin(middle) + math.sin(after))
        return rows

    def close(self, free, length=None):
        """Newton's method on the lengths of the pieces in `free`, one for each condition: the place of the end, its
        direction (when three or more are free), and the length of the lap (when given)."""

        def gap_of():
            end = self.integrate()[-1]
            turning = [100.0 * (self.turn() - 2.0 * math.pi)] if len(free) > 2 else []
            return [end[1], end[2]] + turning + ([self.length() - length] if length else [])

        for _ in range(40):
            gap = gap_of()
            if max(abs(g) for g in gap) < 1e-9:
                return self
            columns = []
            for piece in free:
                self.pieces[piece][1] += 0.01
                columns.append([(b - a) / 0.01 for a, b in zip(gap, gap_of())])
                self.pieces[piece][1] -= 0.01
            matrix = [[column[row] for column in columns] + [-gap[row]] for row in range(len(gap))]
            for piece, change in zip(free, solve(matrix)):
                self.pieces[piece][1] += max(-20.0, min(20.0, change))
        raise SystemExit(f"does not close: {gap}, lengths {[p[1] for p in self.pieces]}")


def solve(rows):
    """Gaussian elimination with pivoting of a square system in augmented rows."""
    n = len(rows)
    for i in range(n):
        pivot = max(range(i, n), key=lambda r: abs(rows[r][i]))
        rows[i], rows[pivot] = rows[pivot], rows[i]
        for r in range(n):
            if r != i:
                factor = rows[r][i] / rows[i][i]
                rows[r] = [a - factor * b for a, b in zip(rows[r], rows[i])]
    return [rows[i][n] / rows[i][i] for i in range(n)]


def lakeside_profile():
    """A lap round a lake, counter-clockwise, 1138 m: the sequence and radii of corners of a well-known class-room circuit
    (38, 55, 27.5, the only right-hander 21.3, 31.6 m), with lengths of our own."""
    return Profile([
        (10, 22, 1 / 38.0),     # 0 out of the last complex
        (18, 45, 0.0115),       # 1 and on round a sweep
        (25, 70, 0.0050),       # 2
        (25, 205, 0.0026),      # 3 long near-straight: a car waits here for the start
        (25, 30, 0.0075),       # 4
        (25, 45, 1 / 55.0),     # 5 left
        (25, 60, 0.0095),       # 6
        (30, 60, 0.0030),       # 7
        (15, 105, 0.0),         # 8 the bridge
        (20, 20, 0.0060),       # 9
        (22, 24, 1 / 27.5),     # 10 tight left
        (18, 60, 0.0),          # 11
        (16, 26, -1 / 21.3),    # 12 the only right-hander
        (16, 60, 0.0),          # 13
        (20, 26, 1 / 31.6),     # 14 left, back to the beginning
    ]).close(free=(1, 3, 6, 7), length=1138.0)


def oval_profile():
    arc = math.pi * 45.0 - 30.0
    return Profile([(0, 75, 0.0), (30, arc, 1 / 45.0), (30, 150, 0.0), (30, arc, 1 / 45.0), (30, 75, 0.0)])


def turn(radius, transition, angle):
    """A bend by `angle` [rad]; the stretch behind it begins with the same transition."""
    return (transition, abs(angle) * radius - transition, math.copysign(1.0 / radius, angle))


def hairpins_profile():
    """Three ladders of U-turns down to R 8 m, then round the outside back to the start."""

    return Profile([
        (0, 50, 0.0),
        turn(15.0, 12, math.pi),
        (12, 70, 0.0),
        turn(12.0, 10, -math.pi),
        (10, 70, 0.0),
        turn(10.0, 9, math.pi),
        (9, 60, 0.0),
        turn(8.0, 8, -math.pi),
        (8, 90, 0.0),
        turn(20.0, 14, math.pi),
        (14, 150, 0.0),         # 10
        turn(20.0, 14, math.pi / 2),
        (14, 90, 0.0),          # 12
        turn(20.0, 14, math.pi / 2),
        (14, 40, 0.0),
    ]).close(free=(10, 12))


def speedway_profile():
    return Profile([
        (0, 300, 0.0),
        (80, 150, 1 / 150.0),   # 1
        (80, 250, 0.0),         # 2
        (60, 90, -1 / 120.0),
        (70, 80, 1 / 110.0),
        (70, 350, 1 / 900.0),
        (90, 200, 1 / 180.0),   # 6
        (60, 70, 1 / 90.0),
        (80, 300, 0.0),
        (70, 120, -1 / 200.0),
        (60, 140, 1 / 130.0),
        (80, 250, 0.0),
    ]).close(free=(1, 2, 6))


def crossover_profile():
    """A figure of eight: three quarters of a circle to the left, over the own road, and back by two right-handers."""
    return Profile([
        (0, 90, 0.0),           # 0 to the crossing and on
        turn(60.0, 30, 1.5 * math.pi),
        (30, 110, 0.0),         # 2 over the crossing
        turn(36.0, 20, -0.5 * math.pi),
        (20, 70, 0.0),
        turn(30.0, 18, -math.pi),
        (18, 110, 0.0),
    ]).close(free=(0, 2))


def stage_profile():
    """An open road with bends of R 18 to 90 m, as a stage of a rally, with room to stop behind the finish."""
    return Profile([
        (0, 90, 0.0),
        turn(70.0, 30, math.pi / 3),
        (30, 80, 0.0),
        turn(35.0, 20, -2.0 * math.pi / 3),
        (20, 60, 0.0),
        turn(25.0, 16, 0.7 * math.pi),
        (16, 110, 0.0),
        turn(50.0, 24, -math.pi / 2),
        (24, 120, 0.0),
        turn(18.0, 12, -0.9 * math.pi),
        (12, 55, 0.0),
        turn(30.0, 18, 0.8 * math.pi),
        (18, 160, 0.0),
        turn(90.0, 40, -math.pi / 4),
        (40, 120, 0.0),
    ])


def even_points(profile, spacing, left, right, closed=True):
    """Centre line and widths about every `spacing` metres: wide enough that six points show the road ahead."""
    rows = profile.integrate()
    count = round(profile.length() / spacing)
    return [(*rows[round(i * (len(rows) - 1) / count)][1:4], left, right) for i in range(count + (not closed))]


# --- lakeside's waypoints: few, unevenly spaced, as if placed by hand -----------------------------------------------

WAYPOINTS = 80
BRIDGE = 33.6                        # longest spacing [m]
BEFORE_RIGHT = (7.6, 4.9, 6.6, 7.6)  # spacings into the right-hander, 26.7 m together: the shortest sight of the lap
PLACEMENT = 0.25                     # waypoints lie within this of the line [m]


def waypoint_places(profile, chance):
    """Arc lengths of the waypoints: dense in corners, sparse on straights."""
    rows = profile.integrate()
    length = profile.length()
    jitter = [chance.uniform(0.75, 1.3) for _ in range(WAYPOINTS)]

    def tightness(s):
        return max(abs(rows[round(((s + ahead) % length) / length * (len(rows) - 1))][4]) for ahead in (0.0, 6.0, 12.0))

    def walk(scale):
        s, places = 0.0, []
        for factor in jitter:
            places.append(s)
            k = tightness(s)
            s += scale * factor * (7.2 if k > 0.022 else 11.0 if k > 0.009 else 13.5 if k > 0.004 else 19.0)
        return places, s

    low, high = 0.5, 2.0
    for _ in range(60):
        middle = 0.5 * (low + high)
        low, high = (middle, high) if walk(middle)[1] < length else (low, middle)
    places, end = walk(low)
    spacings = [min(max(b - a, 6.4), 31.0) for a, b in zip(places, places[1:] + [end])]
    starts = profile.corners()  # two knots a piece: end of its transition, end of the piece
    right_at = starts[2 * 12 + 1][0] - 16.0
    bridge_at = starts[2 * 8 + 1][0] + 30.0
    right = min(range(WAYPOINTS), key=lambda i: abs(places[i] - right_at))
    bridge = min(range(WAYPOINTS), key=lambda i: abs(places[i] - bridge_at))
    fixed = {bridge: BRIDGE, **{right + i: spacing for i, spacing in enumerate(BEFORE_RIGHT)}}
    scale = (length - sum(fixed.values())) / sum(d for i, d in enumerate(spacings) if i not in fixed)
    spacings = [fixed.get(i, d * scale) for i, d in enumerate(spacings)]
    return [sum(spacings[:i]) for i in range(WAYPOINTS)]


def lakeside_points(profile, seed):
    """Waypoints beside the line by up to PLACEMENT; the edges are smooth, so the widths take the difference up."""
    chance = random.Random(seed)
    rows = profile.integrate()
    length = profile.length()
    points = []
    for s in waypoint_places(profile, chance):
        _, x, y, heading, _ = rows[round(s / length * (len(rows) - 1))]
        turn = 2.0 * math.pi * s / length
        left = 4.80 + 0.16 * math.sin(3 * turn + 1.0) + 0.10 * math.sin(11 * turn)
        right = 4.40 + 0.10 * math.sin(5 * turn + 2.0) + 0.10 * math.sin(13 * turn + 0.5)
        for middle, depth in ((100.0, 1.18), (770.0, 0.9)):  # two openings of the right edge towards the shore
            right -= depth * math.exp(-((s - middle) / 16.0) ** 2)
        beside = PLACEMENT * chance.uniform(-1.0, 1.0)
        points.append((x - beside * math.sin(heading), y + beside * math.cos(heading), heading, left - beside, right + beside))
    return points


# --- files ----------------------------------------------------------------------------------------------------------


def text_of(description, settings, points):
    """TUM centre-line format; the map's origin in the middle of the track."""
    middle_x = 0.5 * (min(p[0] for p in points) + max(p[0] for p in points))
    middle_y = 0.5 * (min(p[1] for p in points) + max(p[1] for p in points))
    lines = [f"# {line}" for line in description]
    lines.append("# Made by tools/make_tracks.py from a curvature profile (arcs and clothoids). MIT, as the program.")
    lines.append("# " + ", ".join(f"{key}={value}" for key, value in settings.items()))
    lines.append("# x_m,y_m,w_tr_right_m,w_tr_left_m")
    for x, y, _, left, right in points:
        lines.append(f"{x - middle_x:.4f},{y - middle_y:.4f},{right:.3f},{left:.3f}")
    return "\n".join(lines) + "\n"


def make_all():
    lakeside = lakeside_profile()
    oval = oval_profile()
    hairpins = hairpins_profile()
    speedway = speedway_profile()
    crossover = crossover_profile()
    stage = stage_profile()
    exact = {"smoothing_sigma_m": 0.02, "kerb_width_m": 0.5}
    return {
        "lakeside": text_of(
            ["lakeside: 1138 m round a lake, counter-clockwise, about 9.15 m wide, one tight right-hander",
             "Few, unevenly spaced waypoints off the middle of the road, like waypoints placed by hand."],
            {"start_s_m": 258.0, "start_d_m": -0.76}, lakeside_points(lakeside, SEED)),
        "oval": text_of(["oval: two straights, two turns of R 45 m, 10 m wide, counter-clockwise"], exact,
                        even_points(oval, 12.0, 5.0, 5.0)),
        "hairpins": text_of(["hairpins: a ladder of U-turns of R 15, 12, 10 and 8 m, 9 m wide, counter-clockwise"], exact,
                            even_points(hairpins, 5.0, 4.5, 4.5)),
        "speedway": text_of(["speedway: sweeping corners of R 90 to 200 m between long straights, 12 m wide, counter-clockwise"],
                            exact, even_points(speedway, 20.0, 6.0, 6.0)),
        "crossover": text_of(["crossover: a figure of eight that crosses its own road, bends of R 60, 36 and 30 m, 10 m wide"],
                             {**exact, "start_s_m": -80.0}, even_points(crossover, 10.0, 5.0, 5.0)),
        "stage": text_of(["stage: an open road from a start to an end, bends of R 18 to 90 m, 8 m wide"],
                         {**exact, "start_s_m": 10.0, "finish_s_m": 1310.0, "closed": "false"}, even_points(stage, 10.0, 4.0, 4.0, closed=False)),
    }


SEED = 23  # of lakeside's waypoints: their spline peaks in the right-hander, at about 0.07 1/m, as hand-placed ones do


def main():
    parser = argparse.ArgumentParser(description=__doc__.splitlines()[0])
    parser.add_argument("--check", action="store_true", help="compare with the files instead of writing them")
    arguments = parser.parse_args()
    for name, text in make_all().items():
        file = TRACKS / f"{name}.csv"
        if arguments.check:
            if not file.exists() or file.read_text() != text:
                sys.exit(f"{file}: differs from what tools/make_tracks.py makes")
        else:
            file.write_text(text)


if __name__ == "__main__":
    main()
