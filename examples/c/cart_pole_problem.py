#!/usr/bin/env python3
# SPDX-License-Identifier: MIT
"""Writes cart_pole_problem.cpp and .h beside it: a pole on a cart, to be swung up, for cart_pole.c.

    ./run.sh python examples/c/cart_pole_problem.py"""
import sys
from pathlib import Path

import numpy as np

import chicane as ch

H, CART, TIP, LENGTH, G = 0.04, 1.0, 0.2, 0.5, 9.81


def cart_pole() -> ch.Problem:
    """Angle 0 hangs, π stands. One parameter: where the cart is wanted [m]."""
    ocp = ch.Problem(nx=4, nu=1, horizon=50, parameters=1)

    @ocp.dynamics
    def _(x, u):
        position, angle, v, w = x
        s, c = ch.sin(angle), ch.cos(angle)
        inertia = CART + TIP * s * s
        swing = TIP * LENGTH * w * w
        v = v + H * ((u[0] + s * (swing + TIP * G * c)) / inertia)
        w = w - H * ((u[0] * c + swing * s * c + (CART + TIP) * G * s) / (LENGTH * inertia))
        return [position + H * v, angle + H * w, v, w]
    ocp.cost(lambda x, u, p: [x[0] - p[0], x[1] - np.pi, 0.1 * x[2], 0.1 * x[3], 0.05 * u[0]])
    ocp.terminal(lambda x, p: [10 * (x[0] - p[0]), 30 * (x[1] - np.pi), 5 * x[2], 5 * x[3]])
    ocp.bounds(u=(-20, 20))
    return ocp


if __name__ == "__main__":
    folder = Path(sys.argv[1]) if len(sys.argv) > 1 else Path(__file__).parent
    cart_pole().export_c(folder / "cart_pole_problem")
    source = folder / "cart_pole_problem.cpp"
    source.write_text("// SPDX-License-Identifier: MIT\n" + source.read_text(encoding="utf-8"), encoding="utf-8")
