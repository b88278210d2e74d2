# SPDX-License-Identifier: MIT
"""Optimal control problems of many kinds, written in Python: for tests and for the tables of docs/measured/python.md.

cart_pole() is the one of bench/families/pendulums.hpp, with its equations, costs and bounds. Others with names of bench/families are of
the same kind, but not the same: models, costs and bounds are other ones. swimmer, race_car, satellite and pendulum_by_energy are new."""
from __future__ import annotations

from collections.abc import Callable

import numpy as np

import chicane as ch

Family = tuple[ch.Problem, np.ndarray, np.ndarray | None]


def cart_pole() -> Family:
    """Swings a pole up by a force on its cart, between soft walls."""
    h, cart, tip, length, g = 0.04, 1.0, 0.2, 0.5, 9.81
    ocp = ch.Problem(4, 1, 50)

    @ocp.dynamics
    def _(x, u):
        position, angle, v, w = x
        s, c = ch.sin(angle), ch.cos(angle)
        inertia = cart + tip * s * s
        swing = tip * length * w * w
        v = v + h * ((u[0] + s * (swing + tip * g * c)) / inertia)
        w = w - h * ((u[0] * c + swing * s * c + (cart + tip) * g * s) / (length * inertia))
        return [position + h * v, angle + h * w, v, w]
    ocp.cost(lambda x, u: [x[0], x[1] - np.pi, 0.1 * x[2], 0.1 * x[3], 0.05 * u[0]])
    ocp.terminal(lambda x: [10 * x[0], 30 * (x[1] - np.pi), 5 * x[2], 5 * x[3]])
    ocp.subject_to(lambda x, u: [x[0] - 0.6, -0.6 - x[0]], penalty=(100, 100), name="wall")
    ocp.bounds(u=(-20, 20))
    return ocp, np.zeros(4), None


def cart_pole_exactly() -> Family:
    """The same, upright at the end whatever it costs."""
    ocp, x0, p = cart_pole()
    ocp.terminal_equality(lambda x: [x[0], x[1] - np.pi, x[2], x[3]], name="upright")
    return ocp, x0, p


def planar_quadrotor() -> Family:
    """Flies past a disc."""
    mass, inertia, arm, g = 1.0, 0.05, 0.25, 9.81
    ocp = ch.Problem(6, 2, 40)

    def flight(x, u):
        return [x[3], x[4], x[5], -(u[0] + u[1]) * ch.sin(x[2]) / mass, (u[0] + u[1]) * ch.cos(x[2]) / mass - g, arm * (u[1] - u[0]) / inertia]
    ocp.dynamics(ch.rk4(flight, 0.05))
    ocp.cost(lambda x, u: 0.5 * ((x[0] - 4) ** 2 + x[1] ** 2 + x[2] ** 2) + 0.05 * (x[3] ** 2 + x[4] ** 2 + x[5] ** 2)
             + 0.02 * ((u[0] - 4.9) ** 2 + (u[1] - 4.9) ** 2))
    ocp.terminal(lambda x: 20 * ((x[0] - 4) ** 2 + x[1] ** 2 + x[2] ** 2 + x[3] ** 2 + x[4] ** 2 + x[5] ** 2))
    ocp.subject_to(lambda x, u: 0.64 - (x[0] - 2) ** 2 - (x[1] - 0.1) ** 2, penalty=(200, 100), name="disc")
    ocp.bounds(u=(0, 12))
    return ocp, np.zeros(6), None


def rocket() -> Family:
    """Lands a rocket, its mass burning away."""
    g = 9.81
    ocp = ch.Problem(5, 2, 40)

    def flight(x, u):
        return [x[2], x[3], -u[0] * ch.sin(u[1]) / x[4], u[0] * ch.cos(u[1]) / x[4] - g, -0.02 * u[0]]
    ocp.dynamics(ch.rk4(flight, 0.1))
    ocp.cost(lambda x, u: 1e-3 * u[0] ** 2 + 0.1 * u[1] ** 2)
    ocp.terminal(lambda x: 50 * (x[0] ** 2 + x[1] ** 2 + x[2] ** 2 + x[3] ** 2))
    ocp.bounds(u=([0.0, -0.4], [40.0, 0.4]))
    return ocp, np.array([3.0, 20.0, -1.0, -6.0, 2.0]), None


def chain() -> Family:
    """Brings three masses between springs to rest by the last one's speed."""
    ocp = ch.Problem(8, 1, 40)
    matrix = np.diag([-2.0] * 4) + np.diag([1.0] * 3, 1) + np.diag([1.0] * 3, -1)

    def motion(x, u):
        pull = matrix @ x[:4] - 0.5 * x[:4] ** 3 - 0.05 * x[4:]
        return [*x[4:], *pull[:3], pull[3] + u[0]]
    ocp.dynamics(ch.rk4(motion, 0.2))
    ocp.cost(lambda x, u: x[:4] @ x[:4] + 0.1 * x[4:] @ x[4:] + 0.05 * u @ u)
    ocp.bounds(u=(-1, 1))
    return ocp, np.array([1.0, 0.5, -0.5, 1.0, 0, 0, 0, 0]), None


def parking() -> Family:
    """Backs a car into a place, round a pillar."""
    ocp = ch.Problem(5, 2, 40)

    def motion(x, u):
        return [x[3] * ch.cos(x[2]), x[3] * ch.sin(x[2]), x[3] * ch.tan(x[4]) / 2.7, u[0], u[1]]
    ocp.dynamics(ch.rk4(motion, 0.15))
    ocp.cost(lambda x, u: 0.02 * (x[0] ** 2 + x[1] ** 2) + 0.02 * x[2] ** 2 + 0.05 * u[0] ** 2 + 0.2 * u[1] ** 2)
    ocp.terminal(lambda x: 20 * (x[0] ** 2 + x[1] ** 2 + 2 * x[2] ** 2 + x[3] ** 2))
    ocp.subject_to(lambda x, u: [1.0 - (x[0] - 3) ** 2 - (x[1] - 3.2) ** 2, x[4] - 0.6, -0.6 - x[4]], penalty=(50, 50), name="pillar and lock")
    ocp.bounds(u=([-2, -1], [2, 1]))
    return ocp, np.array([6.0, 2.0, 0.2, 0.0, 0.0]), None


def crane() -> Family:
    """Carries a load over a distance with its rope swinging, at rest at the end."""
    ocp = ch.Problem(6, 2, 50)

    def motion(x, u):
        return [x[3], x[4], x[5], u[0], u[1], -(u[0] * ch.cos(x[2]) + 9.81 * ch.sin(x[2]) + 2 * x[4] * x[5]) / x[1]]
    ocp.dynamics(ch.rk4(motion, 0.1))
    ocp.cost(lambda x, u: 0.1 * (x[0] - 3) ** 2 + x[2] ** 2 + 0.1 * (x[1] - 2) ** 2 + 0.05 * u @ u)
    ocp.terminal(lambda x: 50 * ((x[0] - 3) ** 2 + (x[1] - 2) ** 2 + x[2:] @ x[2:]))
    ocp.subject_to(lambda x, u: [x[2] - 0.15, -0.15 - x[2]], penalty=(30, 30), name="swing")
    ocp.bounds(u=(-2, 2))
    return ocp, np.array([0.0, 2.0, 0.0, 0.0, 0.0, 0.0]), None


def reactor() -> Family:
    """Brings a stirred tank to its working point; a cost that is no sum of squares."""
    ocp = ch.Problem(2, 1, 40)

    def reaction(x, u):
        rate = ch.exp(10 * (x[1] - 0.6))
        return [1.0 - x[0] - 0.3 * x[0] * rate, 0.4 - x[1] + 0.2 * x[0] * rate + 0.3 * (u[0] - x[1])]
    ocp.dynamics(ch.rk4(reaction, 0.1))
    ocp.cost(lambda x, u: 10 * (x[0] - 0.6) ** 2 + ch.exp(4 * (x[1] - 0.7)) + 0.05 * u[0] ** 2)
    ocp.bounds(u=(0, 1.5))
    return ocp, np.array([0.9, 0.45]), None


def race_car() -> Family:
    """Follows a road whose curvature and speed come by stage, between edges."""
    h, length = 0.05, 0.33
    ocp = ch.Problem(6, 2, 40, parameters=2)

    @ocp.dynamics
    def _(x, u, p):
        s, n, a, v, d, last = x

        def rates(n, a, v, d):
            ahead = v * ch.cos(a) / (1 - n * p[0])
            return ahead, v * ch.sin(a), v * ch.tan(d) / length - p[0] * ahead
        first = rates(n, a, v, d)
        v2, d2 = v + h * u[1], d + h * u[0]
        second = rates(n + h * first[1], a + h * first[2], v2, d2)
        return [*(value + h / 2 * (one + two) for value, one, two in zip((s, n, a), first, second)), v2, d2, u[0]]
    ocp.cost(lambda x, u, p: [0.3 * x[1], 0.3 * x[2], x[3] - p[1], 0.1 * u[0], 0.05 * u[1], 0.1 * (u[0] - x[5])])
    ocp.terminal(lambda x: [x[1], x[2]])
    ocp.subject_to(lambda x, u: [x[1] - 0.8, -0.8 - x[1]], name="edge")
    ocp.subject_to(lambda x, u: [x[3] ** 2 * ch.tan(x[4]) / length - 7, -7 - x[3] ** 2 * ch.tan(x[4]) / length], penalty=(20, 20), name="grip")
    ocp.bounds(u=([-1.5, -8], [1.5, 5]))
    curvature = 0.3 * np.sin(0.15 * np.arange(41))
    return ocp, np.array([0.0, 0.1, 0.0, 3.0, 0.0, 0.0]), np.column_stack([curvature, np.full(41, 4.0)])


def swimmer() -> Family:
    """Crosses a river whose current is a table over its width; lands at a point."""
    current = ch.table([0.0, 2.0, 5.0, 8.0, 10.0], [0.0, 0.8, 1.2, 0.7, 0.0])
    ocp = ch.Problem(2, 2, 40)
    ocp.dynamics(ch.rk4(lambda x, u: [current(x[1]) + u[0], u[1]], 0.25))
    ocp.cost(lambda x, u: 0.5 * u @ u)
    ocp.terminal_equality(lambda x: [x[0] - 2.0, x[1] - 10.0], name="landing")
    ocp.bounds(u=(-2, 2))
    return ocp, np.zeros(2), None


def satellite() -> Family:
    """Turns a satellite by three wheels, with attitude as modified Rodrigues parameters."""
    inertia = np.array([1.0, 1.5, 2.0])
    ocp = ch.Problem(6, 3, 40)

    h = 0.2

    @ocp.dynamics
    def _(x, u):
        s, w = x[:3], x[3:]
        w = [w[0] + h * (u[0] - (inertia[2] - inertia[1]) * w[1] * w[2]) / inertia[0], w[1] + h * (u[1] - (inertia[0] - inertia[2]) * w[2] * w[0])
             / inertia[1], w[2] + h * (u[2] - (inertia[1] - inertia[0]) * w[0] * w[1]) / inertia[2]]
        cross = [s[1] * w[2] - s[2] * w[1], s[2] * w[0] - s[0] * w[2], s[0] * w[1] - s[1] * w[0]]
        along = s[0] * w[0] + s[1] * w[1] + s[2] * w[2]
        return [*(s[i] + 0.25 * h * ((1 - s @ s) * w[i] + 2 * cross[i] + 2 * along * s[i]) for i in range(3)), *w]
    ocp.cost(lambda x, u: 5 * x[:3] @ x[:3] + 0.5 * x[3:] @ x[3:] + 0.5 * u @ u)
    ocp.bounds(u=(-0.3, 0.3))
    return ocp, np.array([0.4, -0.3, 0.5, 0.1, 0.0, -0.1]), None


def pendulum_by_energy() -> Family:
    """Swings a pendulum up with its height as the cost: bounded below, no sum of squares. Its speed is bounded."""
    ocp = ch.Problem(2, 1, 60)
    ocp.dynamics(ch.rk4(lambda x, u: [x[1], -9.81 * ch.sin(x[0]) - 0.05 * x[1] + u[0]], 0.05))
    ocp.cost(lambda x, u: 2 * (1 + ch.cos(x[0])) + 0.01 * x[1] ** 2 + 0.02 * u[0] ** 2)
    ocp.terminal(lambda x: 20 * (1 + ch.cos(x[0])) + 2 * x[1] ** 2)
    ocp.bounds(u=(-6, 6), x=([-np.inf, -7], [np.inf, 7]))
    return ocp, np.array([0.3, 0.0]), None


FAMILIES: dict[str, Callable[[], Family]] = {
    "cart-pole swing-up": cart_pole, "cart-pole, exactly": cart_pole_exactly, "planar quadrotor past a disc": planar_quadrotor,
    "rocket landing": rocket, "chain of masses": chain, "parking": parking, "crane": crane, "stirred tank": reactor, "race car": race_car,
    "swimmer in a current": swimmer, "satellite": satellite, "pendulum by energy": pendulum_by_energy}
