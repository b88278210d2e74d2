#!/usr/bin/env python3
"""Draws the motions of examples/solver as SVG files, from what the programs write.

    studies/tables/draw_examples.py [BUILD] [FOLDER]     default build/release, docs/figures
"""
import argparse
import math
import subprocess
import tempfile
from pathlib import Path

ROOT = Path(__file__).resolve().parents[2]
DARK, BLUE, RED, GREY, SOFT = "#24292f", "#0969da", "#cf222e", "#8c959f", "#d8dee4"


class Picture:
    """Shapes in metres, y upwards."""

    def __init__(self, left, right, low, high, width=640):
        self.left, self.high, self.scale = left, high, width / (right - left)
        self.size = width, (high - low) * self.scale
        self.shapes = []

    def at(self, x, y):
        return f"{(x - self.left) * self.scale:.1f}", f"{(self.high - y) * self.scale:.1f}"

    def line(self, points, color=DARK, width=1.5, opacity=1.0):
        path = " ".join(",".join(self.at(x, y)) for x, y in points)
        self.shapes.append(f'<polyline points="{path}" fill="none" stroke="{color}" stroke-width="{width}" '
                           f'stroke-opacity="{opacity:.2f}" stroke-linejoin="round" stroke-linecap="round"/>')

    def disc(self, x, y, radius, color=DARK, opacity=1.0):
        cx, cy = self.at(x, y)
        self.shapes.append(f'<circle cx="{cx}" cy="{cy}" r="{radius * self.scale:.1f}" fill="{color}" '
                           f'fill-opacity="{opacity:.2f}"/>')

    def write(self, path, title):
        width, height = self.size
        path.write_text(
            f'<svg xmlns="http://www.w3.org/2000/svg" viewBox="0 0 {width:.0f} {height:.0f}" width="{width:.0f}" '
            f'height="{height:.0f}" role="img">\n<title>{title}</title>\n'
            f'<rect width="100%" height="100%" fill="#ffffff"/>\n' + "\n".join(self.shapes) + "\n</svg>\n", encoding="utf-8")


def shade(n, count):
    """From pale to full along the motion."""
    return 0.15 + 0.85 * n / max(count - 1, 1)


def turned(x, y, angle, *points):
    c, s = math.cos(angle), math.sin(angle)
    return [(x + c * a - s * b, y + s * a + c * b) for a, b in points]


def cart_pole(rows):
    picture = Picture(-1.2, 1.2, -0.7, 0.7)
    picture.line([(-1.2, 0.0), (1.2, 0.0)], SOFT, 3)
    for side in (-0.6, 0.6):
        picture.line([(side, -0.08), (side, 0.08)], GREY, 2)
    for n, (position, angle) in enumerate(rows):
        opacity = shade(n, len(rows))
        tip = position + 0.5 * math.sin(angle), -0.5 * math.cos(angle)
        picture.line([(position - 0.06, 0.0), (position + 0.06, 0.0)], DARK, 7, opacity)
        picture.line([(position, 0.0), tip], BLUE, 1.5, opacity)
        picture.disc(*tip, 0.018, RED, opacity)
    return picture


def quadrotor(rows):
    picture = Picture(-0.6, 4.6, -1.2, 2.0)
    picture.line([(-0.6, -1.0), (4.6, -1.0)], SOFT, 4)
    picture.disc(2.0, 0.4, 0.6, SOFT)
    picture.line([(x, z) for x, z, _ in rows], BLUE, 1, 0.5)
    for n, (x, z, pitch) in enumerate(rows[::2]):
        picture.line(turned(x, z, -pitch, (-0.2, 0.06), (-0.2, 0.0), (0.2, 0.0), (0.2, 0.06)), DARK, 2, shade(n, len(rows) // 2))
    return picture


def rocket_landing(rows):
    picture = Picture(-220.0, 220.0, -20.0, 540.0, 480)
    picture.line([(-220.0, 0.0), (220.0, 0.0)], SOFT, 4)
    picture.line([(-200.0, 79.0), (0.0, -1.0), (200.0, 79.0)], SOFT, 1.5)
    for n, (x, z, pitch, thrust, swivel) in enumerate(rows[::3]):
        opacity = shade(n, len(rows) // 3)
        foot, top = turned(x, z, -pitch, (0.0, 0.0), (0.0, 32.0))
        picture.line([foot, top], DARK, 6, opacity)
        picture.line([foot] + turned(*foot, -pitch - swivel, (0.0, -40.0 * thrust)), RED, 3, opacity)
    return picture


def chain_of_masses(rows):
    picture = Picture(-0.2, 1.3, -1.0, 0.5)
    picture.line([(-0.2, -0.8), (1.3, -0.8)], SOFT, 4)
    picture.line([(0.0, -0.3), (0.0, 0.3)], SOFT, 6)
    for n, row in enumerate(rows):
        opacity = shade(n, len(rows))
        points = [(0.0, 0.0)] + list(zip(row[0::2], row[1::2]))
        picture.line(points, BLUE, 1.2, opacity)
        for point in points[1:-1]:
            picture.disc(*point, 0.014, DARK, opacity)
        picture.disc(*points[-1], 0.018, RED, opacity)
    return picture


def parking(rows):
    picture = Picture(-4.5, 3.5, -2.8, 4.8)
    for side in (1.5, -1.5):
        picture.disc(-1.5, side, 1.0, SOFT)
    picture.line([(x, y) for x, y, _, _ in rows], BLUE, 1, 0.5)
    for n, (x, y, heading, steering) in enumerate(rows[::3]):
        opacity = shade(n, len(rows) // 3)
        picture.line(turned(x, y, heading, (-0.2, -0.35), (2.2, -0.35), (2.2, 0.35), (-0.2, 0.35), (-0.2, -0.35)), DARK, 1.2, opacity)
        axle = turned(x, y, heading, (2.0, 0.0))[0]
        picture.line(turned(*axle, heading + steering, (-0.25, 0.0), (0.25, 0.0)), RED, 2, opacity)
    return picture


EXAMPLES = {
    "cart_pole": (cart_pole, "A pole on a cart is swung up"),
    "quadrotor": (quadrotor, "A quadrotor flies past an obstacle"),
    "rocket_landing": (rocket_landing, "A rocket lands"),
    "chain_of_masses": (chain_of_masses, "A chain of masses is calmed"),
    "parking": (parking, "A cart is parked between pillars"),
}


def main():
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("build", nargs="?", type=Path, default=ROOT / "build/release")
    parser.add_argument("folder", nargs="?", type=Path, default=ROOT / "docs/figures")
    options = parser.parse_args()
    build, folder = options.build, options.folder
    for name, (draw, title) in EXAMPLES.items():
        with tempfile.TemporaryDirectory() as work:
            file = Path(work) / "motion.txt"
            subprocess.run([build / "examples/solver" / name, file], check=True)
            rows = [tuple(map(float, line.split())) for line in file.read_text().splitlines()]
        draw(rows).write(folder / f"example_{name}.svg", title)


if __name__ == "__main__":
    main()
