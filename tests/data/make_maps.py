#!/usr/bin/env python3
# SPDX-License-Identifier: MIT
"""Draws tests/data/maps: ten occupancy maps at F1TENTH's scale, in the dialects of map_server, SLAM Toolbox and F1TENTH.

The list `expected.csv` beside them has what an import has to find. Needs numpy. `--check` compares instead of writing.
"""
import argparse
import pathlib
import struct
import sys
import zlib

try:
    import numpy as np
except ImportError:  # --help does without
    np = None

HERE = pathlib.Path(__file__).resolve().parent / "maps"
FREE, WALL, UNKNOWN = 254, 0, 205

# Name, corners of a closed line [m], width [m], cell [m], and how the map is kept. Lines begin at the origin, towards +x.
MAPS = [
    ("ring", [(0, 0), (4, 0), (7, 3), (7, 6), (4, 9), (0, 9), (-3, 6), (-3, 3)], 2.0, 0.05, {}),
    ("oval", [(0, 0), (5, 0), (9, 1.2), (10.5, 4), (9, 6.8), (5, 8), (-3, 8), (-7, 6.8), (-8.5, 4), (-7, 1.2), (-4, 0)], 2.2, 0.05, {"image": "pgm"}),
    ("bean", [(0, 0), (5, 0), (9, 2), (9, 6), (6, 8), (3, 6.2), (0, 6.2), (-3, 8), (-6, 6), (-6, 2), (-3, 0)], 1.8, 0.05, {"outside": "white"}),
    ("clover", [(0, 0), (3.5, 0), (6, 2), (5.5, 5), (8, 7), (6, 10), (2.5, 9.5), (-1, 10.5), (-4, 8.5), (-3, 5), (-5, 2.5), (-3, 0.3)], 1.7, 0.05, {"negate": True}),
    ("chicane", [(0, 0), (5, 0), (8, 1.6), (11, 0), (15, 0), (18, 3), (15, 6.5), (7, 6.5), (3, 8), (-2, 7.5), (-5, 4), (-3, 0.6)], 1.6, 0.05, {"noise": 0.05}),
    ("hairpins", [(0, 0), (8, 0), (10.2, 1.8), (8, 3.6), (3, 3.6), (1, 5.6), (3, 7.6), (8, 7.6), (10.2, 9.4), (8, 11.2), (-1, 11.2), (-4, 8), (-4, 3), (-2.5, 0.6)],
     1.5, 0.05, {"image": "pgm", "ascii": False}),
    ("long", [(0, 0), (14, 0), (18, 2), (20, 6), (18, 10), (12, 11), (8, 9), (4, 11), (-4, 11), (-8, 8), (-8, 3), (-5, 0.3)], 2.4, 0.1, {"rgb": True}),
    ("turned", [(0, 0), (4, 0), (7, 2.5), (6.5, 6), (3, 7.5), (-1, 6.5), (-4, 7.5), (-6.5, 5), (-5.5, 1.5), (-3, 0)], 1.8, 0.04, {"yaw": 0.3}),
    ("spots", [(0, 0), (6, 0), (9, 3), (7, 6.5), (3, 6), (0, 8), (-4, 7), (-5, 3), (-3, 0.5)], 2.0, 0.05, {"spots": 12}),
    ("corridors", None, 2.0, 0.05, {"noise": 0.03}),
]


def smooth_line(corners, spacing=0.02):
    """Closed Catmull-Rom line through the corners."""
    p = np.asarray(corners, float)
    points = []
    for i in range(len(p)):
        a, b, c, d = p[i - 1], p[i], p[(i + 1) % len(p)], p[(i + 2) % len(p)]
        for t in np.linspace(0, 1, 60, endpoint=False):
            points.append(0.5 * (2 * b + (c - a) * t + (2 * a - 5 * b + 4 * c - d) * t * t + (3 * b - a - 3 * c + d) * t**3))
    return np.asarray(points)


def length_of(line):
    return float(np.linalg.norm(np.roll(line, -1, axis=0) - line, axis=1).sum())


def distances(line, xs, ys):
    """From each cell's centre to the nearest segment of the line."""
    best = np.full((len(ys), len(xs)), np.inf)
    gx, gy = np.meshgrid(xs, ys)
    for a, b in zip(line[::3], np.roll(line[::3], -1, axis=0)):
        ab = b - a
        t = np.clip(((gx - a[0]) * ab[0] + (gy - a[1]) * ab[1]) / (ab @ ab + 1e-12), 0, 1)
        best = np.minimum(best, np.hypot(gx - a[0] - t * ab[0], gy - a[1] - t * ab[1]))
    return best


def png(pixels, rgb):
    rows = pixels if not rgb else np.repeat(pixels[:, :, None], 3, axis=2)
    raw = b"".join(b"\0" + row.tobytes() for row in rows.astype(np.uint8))
    height, width = pixels.shape

    def chunk(kind, body):
        return struct.pack(">I", len(body)) + kind + body + struct.pack(">I", zlib.crc32(kind + body))

    head = struct.pack(">IIBBBBB", width, height, 8, 2 if rgb else 0, 0, 0, 0)
    return b"\x89PNG\r\n\x1a\n" + chunk(b"IHDR", head) + chunk(b"IDAT", zlib.compress(raw, 9)) + chunk(b"IEND", b"")


def draw(name, corners, width, cell, how):
    """Image bytes, text of the YAML file, and what to find: length and width."""
    random = np.random.default_rng(len(name))
    margin = 1.5
    yaw = how.get("yaw", 0.0)
    if corners is None:  # corridors of a building with square corners
        outer, inner = np.array([-3.0, -1.0, 11.0, 9.0]), np.array([-1.0, 1.0, 9.0, 7.0])
        low, high = outer[:2] - margin, outer[2:] + margin
    else:
        line = smooth_line(corners)
        c, s = np.cos(-yaw), np.sin(-yaw)
        line = line @ np.array([[c, s], [-s, c]])  # into the axes of the image
        low, high = line.min(axis=0) - width / 2 - margin, line.max(axis=0) + width / 2 + margin
    columns, rows = np.ceil((high - low) / cell).astype(int)
    xs, ys = low[0] + (np.arange(columns) + 0.5) * cell, low[1] + (np.arange(rows) + 0.5) * cell
    ragged = how.get("noise", 0.0) * random.standard_normal((rows, columns))
    if corners is None:
        gx, gy = np.meshgrid(xs, ys)

        def depth(box):  # inside positive
            return np.minimum.reduce([gx - box[0], gy - box[1], box[2] - gx, box[3] - gy])

        away = np.maximum(-depth(outer), depth(inner)) + width / 2
        length = 2 * (12.0 + 8.0)
    else:
        away = distances(line, xs, ys)
        length = length_of(line)
    away = away + ragged
    pixels = np.full((rows, columns), FREE if how.get("outside") == "white" else UNKNOWN)
    pixels[away < width / 2 + 0.15] = WALL
    pixels[away < width / 2] = FREE
    for _ in range(how.get("spots", 0)):
        free = np.argwhere(away < width / 2 - 0.2)
        y, x = free[random.integers(len(free))]
        pixels[y : y + 2, x : x + 2] = WALL
    if how.get("negate"):
        pixels = 255 - pixels
    pixels = pixels[::-1].astype(np.uint8)  # the image begins at the top
    if how.get("image") == "pgm":
        image = b"P5\n# CREATOR: map_saver\n%d %d\n255\n" % (columns, rows) + pixels.tobytes()
    else:
        image = png(pixels, how.get("rgb", False))
    file = f"{name}.{how.get('image', 'png')}"
    c, s = np.cos(yaw), np.sin(yaw)
    origin = [c * low[0] - s * low[1], s * low[0] + c * low[1], yaw]
    text = (f"image: {file}\nmode: trinary\nresolution: {cell}\norigin: [{origin[0]:.4f}, {origin[1]:.4f}, {origin[2]}]\n"
            f"negate: {int(how.get('negate', False))}\noccupied_thresh: 0.65\nfree_thresh: 0.196\n")
    return file, image, text, length


def main():
    parser = argparse.ArgumentParser(description=__doc__)
    parser.add_argument("--check", action="store_true", help="compare with the files, write nothing")
    check = parser.parse_args().check
    if np is None:
        parser.error("numpy: got none, expected Debian's python3-numpy and /usr/bin/python3")
    table = "# made by tests/data/make_maps.py\nname,length_m,width_m\n"
    files = {}
    for name, corners, width, cell, how in MAPS:
        file, image, text, length = draw(name, corners, width, cell, how)
        files[file] = image
        files[f"{name}.yaml"] = text.encode()
        table += f"{name},{length:.2f},{width}\n"
    files["expected.csv"] = table.encode()
    for name, content in files.items():
        if not check:
            HERE.mkdir(parents=True, exist_ok=True)
            (HERE / name).write_bytes(content)
        elif (HERE / name).read_bytes() != content:
            sys.exit(f"{HERE / name} is not what tests/data/make_maps.py makes")


if __name__ == "__main__":
    main()
