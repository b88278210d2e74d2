# SPDX-License-Identifier: MIT
"""All that the module is for, in the few lines that somebody types first: their names and shapes."""
import os
import tempfile
import unittest
from pathlib import Path

import numpy as np

import chicane as ch


class FirstLines(unittest.TestCase):
    def setUp(self):
        folder = tempfile.TemporaryDirectory()
        self.addCleanup(folder.cleanup)
        self.addCleanup(os.chdir, os.getcwd())
        os.chdir(folder.name)

    def test_drive_step_sweep_and_look(self):
        run = ch.drive("oval", car="road-car", preset="pid", laps=1, record="run.mcap")
        self.assertEqual(run.best_lap_s, run.laps[0]["lap_time_s"])
        self.assertEqual(run.frames["speed_mps"].shape, (run["cycles"],))
        env = ch.Env("hairpins", car="f1tenth", rate_hz=20, noise=True, seed=1)
        obs, info = env.reset()
        steer, throttle = -0.5 * obs[1], 0.1
        obs, reward, terminated, truncated, info = env.step([steer, throttle])
        self.assertEqual((obs.shape, terminated, truncated, type(reward)), ((15,), False, False, float))
        table = ch.sweep({"preset": ["default", "pid"], "latency_ms": range(0, 100, 50)}, settings={"track": "oval", "laps": 0, "time_limit_s": 3},
                         jobs=2)
        self.assertEqual(len(table), 4)
        limit = ch.limit("oval", car="udacity", witness=False)
        self.assertLess(limit.bound_s, run.best_lap_s)
        rec = ch.read("run.mcap")
        self.assertEqual(rec.laps[0]["lap_time_s"], run.best_lap_s)
        ch.report(run, "run.html")
        self.assertIn("<html", Path("run.html").read_text(encoding="utf-8")[:2000])

    def test_drive_with_a_controller(self):
        class Mine(ch.Controller):
            def step(self, seen):
                x, y = seen.waypoints_ahead[2]
                return ch.Command(steer=2 * y * seen.wheelbase / max(1.0, x * x + y * y), throttle=0.2 * (8 - seen.speed))
        self.assertTrue(ch.drive("oval", controller=Mine(), laps=1)["completed"])

    def test_solve_an_optimal_control_problem(self):
        ocp = ch.Problem(nx=4, nu=1, horizon=50)

        @ocp.dynamics
        def _(x, u):
            s, c = np.sin(x[1]), np.cos(x[1])
            push = (u[0] + 0.2 * s * (0.5 * x[3] ** 2 + 9.81 * c)) / (1.0 + 0.2 * s * s)
            return x + 0.04 * np.array([x[2], x[3], push, -2 * (push * c + 9.81 * s)])
        ocp.cost(lambda x, u: x[0] ** 2 + (x[1] - np.pi) ** 2 + 0.01 * x[2:] @ x[2:] + 0.001 * u @ u)
        ocp.terminal(lambda x: 10 * x[2:] @ x[2:])
        ocp.bounds(u=(-20, 20))
        ocp.subject_to(lambda x, u: [x[0] - 2, -2 - x[0]])
        ocp.terminal_equality(lambda x: x[1] - np.pi)
        sol = ocp.solve([0, 0, 0, 0])
        self.assertEqual((sol.status, sol.u.shape, sol.x.shape), ("optimal", (50, 1), (51, 4)))
        self.assertAlmostEqual(sol.x[-1, 1], np.pi, places=5)
        self.assertLess(sol.violation, 1e-4)
        self.assertEqual(sol.multipliers["terminal_equality"].shape, (1,))
        many = ocp.solve_many(np.zeros((3, 4)))
        np.testing.assert_array_equal(many.cost, sol.cost)
        ocp.export("cart_pole.hpp")
        self.assertIn("struct Problem", Path("cart_pole.hpp").read_text(encoding="utf-8"))
        du = sol.sensitivity("x0")
        self.assertEqual(du.u.shape, (50, 1, 4))
        self.assertRegex(repr(sol), "<Solution: optimal after")


if __name__ == "__main__":
    unittest.main()
