# SPDX-License-Identifier: MIT
"""Optimal control problems written in Python: traced, solved, exported, differentiated."""
import math
import pickle
import subprocess
import sys
import tempfile
import time
import unittest
from pathlib import Path

import numpy as np

import chicane as ch
import families


def double_integrator(parameters=0):
    ocp = ch.Problem(nx=2, nu=1, horizon=20, parameters=parameters)
    ocp.dynamics(lambda x, u: [x[0] + 0.1 * x[1], x[1] + 0.1 * u[0]])
    ocp.cost(lambda x, u: x @ x + 0.1 * u @ u)
    ocp.bounds(u=(-1, 1))
    return ocp


def simulated_cost(ocp, function, x0, u):
    """By numbers alone: nothing of the recorded graph."""
    x, total = np.asarray(x0, float), 0.0
    for k in range(ocp.horizon):
        total += float(x @ x + 0.1 * u[k] @ u[k])
        x = np.asarray(function(x, u[k]), float)
    return total


class Solving(unittest.TestCase):
    def test_its_cost_is_that_of_a_simulation_and_no_other_inputs_are_cheaper(self):
        ocp = double_integrator()
        solution = ocp.solve([1.0, 0.3])
        self.assertEqual(solution.status, "optimal")
        step = lambda x, u: [x[0] + 0.1 * x[1], x[1] + 0.1 * u[0]]  # noqa: E731
        cost = simulated_cost(ocp, step, [1.0, 0.3], solution.u)
        self.assertAlmostEqual(solution.cost, cost, delta=1e-9 * cost)
        random = np.random.default_rng(1)
        for _ in range(200):
            other = np.clip(solution.u + 0.05 * random.standard_normal(solution.u.shape), -1, 1)
            self.assertGreater(simulated_cost(ocp, step, [1.0, 0.3], other), cost)

    def test_the_cart_pole_of_the_bench_has_its_optimum(self):
        ocp, x0, _ = families.cart_pole()
        solution = ocp.solve(x0)
        self.assertAlmostEqual(solution.cost, 89.58327, delta=1e-4)   # as compiled; the problem of bench/families/pendulums.hpp
        again = ocp.solve(x0, start=solution)
        self.assertLess(again.iterations, solution.iterations)
        self.assertAlmostEqual(again.cost, solution.cost, delta=1e-9 * solution.cost)

    def test_every_family_is_solved_and_answers_with_what_it_violates(self):
        for name, make in families.FAMILIES.items():
            with self.subTest(name):
                ocp, x0, p = make()
                solution = ocp.solve(x0, p)
                self.assertEqual(solution.status, "optimal")
                self.assertLess(solution.residual, 1e-6)
        ocp, x0, p = families.race_car()
        solution = ocp.solve(x0 + [0, 0.9, 0, 0, 0, 0], p)          # beside the road
        self.assertTrue(solution)
        self.assertRegex(repr(solution), "violates edge at stage 0 by 0.2")
        self.assertIn("edge at stage 0", solution._repr_html_())

    def test_an_expression_costs_what_it_says(self):
        ocp = ch.Problem(1, 1, 1)
        ocp.dynamics(lambda x, u: [x[0] + u[0]])
        ocp.cost(lambda x, u: ch.exp(u[0]) - 2 * u[0], at_least=0.0)
        ocp.terminal(lambda x: 0.0 * x[0])
        solution = ocp.solve([0.0], tolerance=1e-9)
        self.assertAlmostEqual(solution.u[0, 0], math.log(2.0), places=6)
        self.assertAlmostEqual(solution.cost, 2.0 - 2.0 * math.log(2.0), places=9)

    def test_a_cost_without_a_floor_says_what_it_lacks(self):
        ocp = ch.Problem(1, 1, 5)
        ocp.dynamics(lambda x, u: [x[0] + u[0]])
        ocp.cost(lambda x, u: -x[0])
        self.assertRegex(repr(ocp.solve([0.0])), "not usable, .*; a cost that is no sum of squares has to stay above its at_least")

    def test_what_is_convex_over_a_nonlinear_function_is_a_cost(self):
        ocp = ch.Problem(1, 1, 1)
        ocp.dynamics(lambda x, u: [x[0] + u[0]])
        miss = lambda u: u ** 3 + u - 3.0  # noqa: E731
        ocp.cost(lambda x, u: ch.sqrt(1.0 + miss(u[0]) ** 2) + ch.log(1.0 + ch.exp(4.0 * (u[0] - 1.0))))
        ocp.terminal(lambda x: 0.0 * x[0])
        solution = ocp.solve([0.0], tolerance=1e-8)
        grid = np.linspace(-1, 3, 400001)
        costs = np.sqrt(1.0 + miss(grid) ** 2) + np.log1p(np.exp(4.0 * (grid - 1.0)))
        self.assertAlmostEqual(solution.cost, costs.min(), places=7)
        self.assertAlmostEqual(solution.u[0, 0], grid[costs.argmin()], places=4)

    def test_a_quadratic_form_becomes_squares(self):
        weight = np.array([[2.0, 0.5, 0.0], [0.5, 1.0, 0.2], [0.0, 0.2, 3.0]])
        ocp = ch.Problem(3, 1, 5)
        ocp.dynamics(lambda x, u: [x[0] + u[0], x[1], x[2]])
        ocp.cost(lambda x, u: (x - 1.0) @ weight @ (x - 1.0) + 0.5 * u[0] ** 2 + 3.0)
        self.assertEqual(len(ocp.rows["residual"]), 4)
        x0 = np.array([0.2, -0.4, 1.5])
        ocp.bounds(u=(0, 0))
        self.assertAlmostEqual(ocp.solve(x0).cost, 5 * ((x0 - 1) @ weight @ (x0 - 1) + 3.0), places=9)

    def test_what_must_hold_holds(self):
        ocp = double_integrator()
        ocp.bounds(u=(-3, 3), x=([-np.inf, -0.6], [np.inf, 0.6]))
        ocp.terminal_equality(lambda x: x[0] - 0.2)
        solution = ocp.solve([1.0, 0.0])
        self.assertTrue(solution)
        self.assertAlmostEqual(solution.x[-1, 0], 0.2, places=5)
        self.assertEqual(solution.multipliers["terminal_equality"].shape, (1,))
        self.assertGreaterEqual(solution.x[:, 1].min(), -0.6 - 1e-5)
        impossible = ocp.solve([3.0, 0.0])
        self.assertFalse(impossible.is_usable)
        self.assertRegex(repr(impossible), "infeasible|stalled")
        self.assertGreater(impossible.violation, 0.1)

    def test_of_every_size_it_is_the_regulator_of_riccati(self):
        random = np.random.default_rng(6)
        for nx, nu in ((1, 1), (2, 2), (4, 1), (6, 2), (7, 1), (8, 4), (20, 3), (52, 8)):
            with self.subTest(f"{nx} + {nu}"):
                a, b = np.eye(nx) + 0.1 * random.standard_normal((nx, nx)) / np.sqrt(nx), 0.3 * random.standard_normal((nx, nu))
                ocp = ch.Problem(nx, nu, 12)
                ocp.dynamics(lambda x, u, a=a, b=b: a @ x + b @ u)
                ocp.cost(lambda x, u: x @ x + 0.5 * u @ u)
                ocp.terminal(lambda x: 3 * x @ x)
                value, gains = 6.0 * np.eye(nx), []
                for _ in range(12):
                    gains.append(np.linalg.solve(np.eye(nu) + b.T @ value @ b, b.T @ value @ a))
                    value = 2.0 * np.eye(nx) + a.T @ value @ (a - b @ gains[-1])
                x0 = random.standard_normal(nx)
                solution = ocp.solve(x0, tolerance=1e-9)
                self.assertEqual(solution.status, "optimal")
                np.testing.assert_allclose(solution.u[0], -gains[-1] @ x0, atol=1e-8)
                self.assertAlmostEqual(solution.cost, 0.5 * x0 @ value @ x0, delta=1e-9 * solution.cost)

    def test_stages_have_numbers_and_parameters_of_their_own(self):
        ocp = ch.Problem(1, 1, 8, parameters=1)
        ocp.dynamics(lambda x, u: [x[0] + u[0]])
        ocp.cost(lambda x, u, p, k: [x[0] - p[0], 0.01 * u[0], ch.where(k > 5.5, 10.0 * u[0], 0.0)])
        ocp.terminal(lambda x, p: [x[0] - p[0]])
        wanted = np.array([0, 1, 2, 3, 2, 1, 0, 5, 5.0])[:, None]
        solution = ocp.solve([0.0], wanted)
        self.assertLess(np.abs(solution.x[:6] - wanted[:6]).max(), 0.02)
        self.assertLess(np.abs(solution.u[6:]).max(), 0.1)

    def test_solutions_can_be_pickled(self):
        solution = double_integrator().solve([1.0, 0.0])
        copy = pickle.loads(pickle.dumps(solution))
        self.assertEqual(copy.cost, solution.cost)
        with self.assertRaisesRegex(ValueError, "got a solution from a pickle"):
            copy.sensitivity()

    def test_many_have_the_same_bits_for_any_number_of_threads(self):
        ocp, _, _ = families.cart_pole()
        x0 = np.random.default_rng(2).normal(0, 0.3, (24, 4))
        one, three = ocp.solve_many(x0, threads=1), ocp.solve_many(x0, threads=3)
        np.testing.assert_array_equal(one.u, three.u)
        alone = ocp.solve(x0[7])
        np.testing.assert_array_equal(one.u[7], alone.u)
        self.assertEqual(one.cost[7], alone.cost)


class Iterations(unittest.TestCase):
    def test_the_log_has_each_turn_and_changes_nothing(self):
        for make in (families.cart_pole, families.cart_pole_exactly):
            ocp, x0, _ = make()
            plain, logged = ocp.solve(x0), ocp.solve(x0, log=True)
            np.testing.assert_array_equal(plain.u, logged.u)
            log = logged.log
            self.assertIsNone(plain.log)
            self.assertGreaterEqual(log.count, logged.iterations)
            self.assertEqual({"filter", "full step"}, set(log["kind"]))
            self.assertEqual(log["step"][-1], 0.0)
            self.assertLess(max(log["stationarity"][-1], log["defect"][-1], log["complementarity"][-1]), 1e-6)
            self.assertLess(log["barrier"][-1], log["barrier"][0])
            self.assertEqual(len(log.to_pandas()), log.count)
            self.assertEqual(len(str(log).split("\n")), log.count + 1)
            self.assertIn("<th>stationarity</th>", log._repr_html_())
        self.assertEqual(list(np.unique(log["round"])), list(range(int(log["round"].max()) + 1)))
        with self.assertRaisesRegex(KeyError, "got 'price', expected one of round, kind, cost"):
            log["price"]


class Feedback(unittest.TestCase):
    def test_is_of_first_order_as_sensitivities_are(self):
        ocp = double_integrator()
        ocp.subject_to(lambda x, u: -x[1] - 0.3, penalty=(5, 5))
        solution = ocp.prepare([1.0, 0.0], tolerance=1e-9)
        change = solution.sensitivity("x0")
        step = np.array([1e-4, -2e-4])
        answer = ocp.feedback(solution.x0 + step)
        self.assertTrue(answer.is_solved)
        np.testing.assert_array_equal(answer.x[0], solution.x0 + step)
        np.testing.assert_allclose(answer.u - solution.u, change.u @ step, atol=2e-6)

    def test_is_exact_for_a_quadratic_program_whatever_bounds_become_active(self):
        ocp = double_integrator()
        ocp.prepare([0.3, 0.0])
        for x0 in ([0.3, 0.0], [2.0, 0.5], [-3.0, 0.0], [0.0, 0.1]):
            answer, solution = ocp.feedback(x0), double_integrator().solve(x0)
            self.assertTrue(answer.is_solved)
            np.testing.assert_allclose(answer.u, solution.u, atol=1e-6)
            np.testing.assert_allclose(answer.x, solution.x, atol=1e-6)

    def test_drives_a_loop_by_real_time_iterations(self):
        ocp = ch.Problem(2, 1, 30)
        pendulum = ch.rk4(lambda x, u: [x[1], 9.81 * ch.sin(x[0]) + u[0]], 0.05)
        ocp.dynamics(pendulum)
        ocp.cost(lambda x, u: 5 * x[0] ** 2 + 0.1 * x[1] ** 2 + 0.01 * u[0] ** 2)
        ocp.bounds(u=(-15, 15))
        state = np.array([0.6, 0.0])
        ocp.solve(state)
        for cycle in range(60):
            ocp.prepare(shift=min(cycle, 1), max_iterations=1)
            u = ocp.feedback(state).u[0]
            state = np.asarray(pendulum(state, u), float) + [0.0, 1e-3]
        self.assertLess(np.abs(state).max(), 0.02)

    def test_says_what_is_missing(self):
        ocp = double_integrator()
        with self.assertRaisesRegex(ValueError, "prepare: got no x0 and no earlier answer"):
            ocp.prepare()
        with self.assertRaisesRegex(ValueError, r"feedback: got no preparation, expected prepare\(\)"):
            ocp.feedback([1.0, 0.0])
        ocp.prepare([1.0, 0.0])
        ocp.solve([1.0, 0.0])
        with self.assertRaisesRegex(ValueError, "feedback: got no preparation"):
            ocp.feedback([1.0, 0.0])
        ocp.prepare()
        with self.assertRaisesRegex(ValueError, "x0: got .*expected finite"):
            ocp.feedback([np.nan, 0.0])


def valve(method):
    """A slow state behind a valve that settles in a millisecond, by an implicit method over 0.1 s."""
    ocp = ch.Problem(2, 1, 20, parameters=1)
    ocp.dynamics(method)
    ocp.cost(lambda x, u, p: 10 * (x[0] - p[0]) ** 2 + 0.1 * u @ u)
    ocp.bounds(u=(0, 1))
    return ocp


class Implicit(unittest.TestCase):
    def test_a_stiff_system_is_that_of_the_method_solved_otherwise(self):
        matrix, h = np.array([[-1.0, 1.0], [0.0, -1000.0]]), 0.1
        flow = lambda x, u: [x[1] - x[0], 1000 * (u[0] - x[1])]  # noqa: E731
        eye, drive = np.eye(2), np.array([0.0, 1000.0])
        euler = lambda x, u: np.linalg.solve(eye - h * matrix, x + h * drive * u)  # noqa: E731
        middle = lambda x, u: np.linalg.solve(eye - h / 2 * matrix, (eye + h / 2 * matrix) @ x + h * drive * u)  # noqa: E731
        for method, step in ((ch.implicit_euler(flow, h), euler), (ch.gauss_legendre(flow, h, stages=1), middle)):
            ocp = valve(method)
            solution = ocp.solve([0.0, 0.0], [0.5])
            self.assertEqual(solution.status, "optimal")
            self.assertEqual((solution.u.shape, solution.unknowns.shape, solution.multipliers["equalities"].shape), ((20, 1), (20, 2), (20, 0)))
            x = np.zeros(2)
            for k in range(20):
                x = step(x, solution.u[k, 0])
                np.testing.assert_allclose(solution.x[k + 1], x, atol=2e-6)
            again = ocp.solve([0.0, 0.0], [0.5], start=solution)
            self.assertLess(again.iterations, solution.iterations)
            many = ocp.solve_many([[0.0, 0.0], [0.2, 0.1]], [0.5])
            self.assertEqual(many.u.shape, (2, 20, 1))
            self.assertTrue(many.is_usable.all())
        self.assertFalse(valve(ch.rk4(flow, h)).solve([0.0, 0.0], [0.5]).status == "optimal")       # as it would be without

    def test_gauss_and_legendre_agree_with_runge_and_kutta_where_nothing_is_stiff(self):
        flow = lambda x, u: [x[1], -9.81 * ch.sin(x[0]) + u[0]]  # noqa: E731
        solutions = []
        for method in (ch.gauss_legendre(flow, 0.05), ch.rk4(flow, 0.05, 4)):
            ocp = ch.Problem(2, 1, 20)
            ocp.dynamics(method)
            ocp.cost(lambda x, u: 10 * (x[0] - 0.5) ** 2 + 0.1 * u @ u)
            ocp.bounds(u=(-8, 8))
            solutions.append(ocp.solve([0.0, 0.0]))
            self.assertEqual(solutions[-1].status, "optimal")
        implicit, explicit = solutions
        np.testing.assert_allclose(implicit.x, explicit.x, atol=2e-5)
        np.testing.assert_allclose(implicit.sensitivity().u, explicit.sensitivity().u, atol=2e-3)

    def test_refuses_what_does_not_fit(self):
        ocp = ch.Problem(4, 1, 10)
        with self.assertRaisesRegex(ValueError, "got 8 unknowns inside the interval beside 1 inputs, expected at most 8 together"):
            ocp.dynamics(ch.gauss_legendre(lambda x, u: x, 0.1))
        with self.assertRaisesRegex(ValueError, "got a derivative of 2 values, expected 4"):
            ocp.dynamics(ch.implicit_euler(lambda x, u: x[:2], 0.1))
        with self.assertRaisesRegex(ValueError, "gauss_legendre: got 3 stages, expected 1 or 2"):
            ch.gauss_legendre(lambda x, u: x, 0.1, stages=3)
        ocp.dynamics(ch.implicit_euler(lambda x, u: -1.0 * x, 0.1))
        with self.assertRaisesRegex(ValueError, "dynamics: got a second function, expected one"):
            ocp.dynamics(lambda x, u: x)
        self.assertEqual((ocp.unknowns, len(ocp.rows["equality"])), (4, 4))


class Derivatives(unittest.TestCase):
    def test_agree_with_differences(self):
        random = np.random.default_rng(3)
        step = 1e-6
        for name, make in families.FAMILIES.items():
            ocp, x0, p = make()
            interpreter = ocp.make_interpreter(with_parameters=True)
            count = ocp.nx + ocp.nu + ocp.full_count
            point = np.concatenate([x0, np.zeros(ocp.nu), np.zeros(ocp.full_count) if p is None else p[0]]) + 0.3 + 0.05 * random.standard_normal(count)
            for function, rows in enumerate(ocp.all_rows().values()):
                if not rows:
                    continue
                with self.subTest(f"{name}, function {function}"):
                    weights = random.standard_normal((1, len(rows)))
                    def evaluate(at):
                        return interpreter.evaluate(function, at[None], np.zeros((1, 0)), weights, 3)
                    _, slopes, curvatures = evaluate(point)
                    for j in range(count):
                        change = np.zeros(count)
                        change[j] = step
                        (high, high_slopes, _), (low, low_slopes, _) = evaluate(point + change), evaluate(point - change)
                        scale = 1.0 + np.abs(slopes[0]).max()
                        np.testing.assert_allclose(slopes[0, :, j], (high - low)[0] / (2 * step), atol=2e-7 * scale)
                        numeric = weights[0] @ (high_slopes - low_slopes)[0] / (2 * step)
                        np.testing.assert_allclose(curvatures[0, j], numeric, atol=2e-6 * (1.0 + np.abs(curvatures).max()))

    def test_a_table_goes_through_its_points_and_goes_on_straight(self):
        table = ch.table([0.0, 1.0, 3.0, 4.0], [1.0, 0.0, 2.0, 1.5])
        for at, value in ((0.0, 1.0), (1.0, 0.0), (3.0, 2.0), (4.0, 1.5)):
            self.assertAlmostEqual(table(at), value, places=12)
        self.assertAlmostEqual(table(6.0) - table(5.0), table(5.0) - table(4.0), places=10)

    def test_sensitivities_agree_with_differences(self):
        ocp = ch.Problem(2, 1, 15, parameters=2)
        ocp.dynamics(lambda x, u, p: [x[0] + 0.1 * x[1], x[1] + 0.1 * (u[0] - p[0] * ch.sin(x[0]))])
        ocp.cost(lambda x, u, p: (x[0] - p[1]) ** 2 + 0.1 * u @ u)
        ocp.subject_to(lambda x, u: -u[0] - 0.6, penalty=(0.05, 1.0))
        ocp.subject_to(lambda x, u: x[1] + 0.2 * x[0] ** 2 - 0.5, hard=True)
        ocp.terminal_equality(lambda x, p: x[1] - 0.1 * p[0])
        ocp.bounds(u=(-1, 1.5))
        random = np.random.default_rng(4)
        count = compared = 0
        for _ in range(12):
            x0, p = np.array([-0.5, 0.0]) + 0.3 * random.standard_normal(2), np.array([1.0, 0.2]) + 0.2 * random.standard_normal(2)
            count += 1
            solution = ocp.solve(x0, p, tolerance=1e-11)
            if not solution or solution.sensitivity("x0").margin < 5e-3:        # differences of a barrier's end need that
                continue
            compared += 1
            for of, given in (("x0", x0), ("p", p)):
                derivative = solution.sensitivity(of)
                for n in range(2):
                    change = np.zeros(2)
                    change[n] = 5e-5
                    ends = [ocp.solve(x0 + sign * change, p, start=solution, tolerance=1e-11) if of == "x0" else
                            ocp.solve(x0, p + sign * change, start=solution, tolerance=1e-11) for sign in (1, -1)]
                    numeric = (ends[0].u - ends[1].u) / 1e-4
                    error = np.abs(numeric - derivative.u[:, :, n]).max() / (1e-3 + np.abs(numeric).max())
                    self.assertLess(error, 1e-5, f"{of} {n} of {given}")
        self.assertGreater(compared, count // 3)

    def test_a_long_horizon_of_many_states_takes_no_dense_matrix(self):
        ocp = ch.Problem(12, 2, 150)
        spread = np.diag(np.full(12, 0.9)) + np.diag(np.full(11, 0.1), 1)
        ocp.dynamics(lambda x, u: [*(spread @ x)[:10], (spread @ x)[10] + u[0], (spread @ x)[11] + u[1]])
        ocp.cost(lambda x, u: x @ x + u @ u)
        solution = ocp.solve(np.ones(12), tolerance=1e-9)
        begin = time.process_time()
        change = solution.sensitivity("x0")
        self.assertLess(time.process_time() - begin, 20.0)      # a dense one: 3,900 unknowns, 15 million entries, a minute
        np.testing.assert_allclose(change.u @ solution.x0, solution.u, atol=1e-7)      # linear, as the problem is

    def test_at_the_edge_they_say_that_they_are_one_sided(self):
        ocp = ch.Problem(1, 1, 1)
        ocp.dynamics(lambda x, u: [x[0] + u[0]])
        ocp.cost(lambda x, u: [u[0] - x[0]])
        ocp.bounds(u=(-1, 1))
        self.assertTrue(ocp.solve([1.0]).sensitivity().is_one_sided)
        inside = ocp.solve([0.5]).sensitivity()
        self.assertFalse(inside.is_one_sided)
        self.assertAlmostEqual(inside.margin, 0.5, places=6)


class Compiled(unittest.TestCase):
    def test_the_example_in_c_has_the_problem_that_is_exported_now(self):
        folder = Path(__file__).resolve().parents[2] / "examples/c"
        with tempfile.TemporaryDirectory() as made:
            subprocess.run([sys.executable, str(folder / "cart_pole_problem.py"), made], check=True)
            for name in ("cart_pole_problem.cpp", "cart_pole_problem.h"):
                self.assertEqual(Path(made, name).read_text(encoding="utf-8"), (folder / name).read_text(encoding="utf-8"),
                                 "./run.sh python examples/c/cart_pole_problem.py")
            families.cart_pole()[0].export(f"{made}/cart_pole.hpp")
            self.assertIn("struct Problem", Path(made, "cart_pole.hpp").read_text(encoding="utf-8"))
        with self.assertRaisesRegex(ValueError, "export_c: got the name 'cart-pole', expected a C identifier"):
            families.cart_pole()[0].export_c("cart-pole")

    def test_the_exported_problem_has_the_same_optimum(self):
        ocp = double_integrator(parameters=1)
        ocp.subject_to(lambda x, u, p, k: [p[0] - ch.where(x[1] < 0, x[1], 2.0 * x[1]), ch.where(k < 3.5, -1.0, -0.9 - x[1])], name="slow")
        ocp.cost(lambda x, u: ch.exp(0.1 * x[0]), at_least=0.0)
        stages = ", ".join(["-0.4"] * (ocp.horizon + 1))
        main = f"""
            #include <stdio.h>
            #include "slow.h"
            int main(void) {{
              static unsigned char memory[1 << 20];
              chicane_solver* solver;
              chicane_report report;
              const double x0[] = {{1.0, 0.0}}, p[] = {{{stages}}};
              if (chicane_create(slow(), memory, sizeof memory, &solver) != CHICANE_DONE) return 1;
              if (chicane_set(solver, CHICANE_PARAMETERS, p, sizeof p / sizeof *p) != CHICANE_DONE) return 1;
              if (chicane_solve(solver, x0, &report) != CHICANE_DONE) return 1;
              printf("%.17g", report.cost);
              return report.is_usable ? 0 : 1;
            }}"""
        with tempfile.TemporaryDirectory() as folder:
            ocp.export_c(f"{folder}/slow")
            ocp.export(f"{folder}/slow.hpp", "Slow")
            header = Path(folder, "slow.hpp").read_text(encoding="utf-8")
            self.assertIn("struct Slow {", header)
            Path(folder, "main.cpp").write_text(main, encoding="utf-8")
            source = Path(__file__).resolve().parents[2] / "src"
            subprocess.run(["g++", "-std=c++20", "-O0", "-w", f"-I{source}", "main.cpp", "slow.cpp", str(source / "chicane/base/math.cpp"), "-o", "slow"],
                           check=True, cwd=folder)
            cost = float(subprocess.run([f"{folder}/slow"], check=True, capture_output=True, text=True).stdout)
        solution = ocp.solve([1.0, 0.0], [-0.4])
        self.assertAlmostEqual(cost, solution.cost, delta=1e-6 * abs(solution.cost))


class Misuses(unittest.TestCase):
    def refuse(self, pattern, call, kind=ValueError):
        with self.assertRaisesRegex(kind, pattern):
            call()

    def test_what_cannot_be_recorded_is_refused_with_line_and_remedy(self):
        ocp = ch.Problem(2, 1, 10)
        here = r"problem_test\.py:\d+: "
        self.refuse(here + r".*got a branch on a symbol, expected ch\.where",
                    lambda: ocp.dynamics(lambda x, u: [x[0] if x[1] > 1 else x[1], 0]))
        self.refuse(here + r".*got a symbol where a number is needed, expected ch\.sin", lambda: ocp.cost(lambda x, u: math.sin(x[0])))
        self.refuse(here + r".*got a symbol where a number is needed", lambda: ocp.cost(lambda x, u: float(x[0])))
        self.refuse(here + r".*got a branch on a symbol", lambda: ocp.cost(lambda x, u: np.where(x[0] > 0.0, x[0], 0.0)))
        self.refuse(here + r".*not math\.sin, float\(\), np\.floor", lambda: ocp.cost(lambda x, u: np.floor(x[0])))
        for cost in (lambda x, u: round(x[0]), lambda x, u: x[0] % 1.0, lambda x, u: np.mod(x[0], 2.0), lambda x, u: np.exp2(x[0])):
            self.refuse(here + r".*Symbol.*, expected what docs/python_problems\.md lists", lambda: ocp.cost(cost))
        with self.assertRaises(TypeError):                       # a mistake of another kind stays what it is
            ocp.cost(lambda x, u: len(3))
        self.refuse(here + r".*got == of a symbol", lambda: ocp.cost(lambda x, u: x[0] == 1))
        self.refuse(here + r".*got a branch on a symbol", lambda: ocp.cost(lambda x, u: max(x[0], 0.0)))
        self.refuse(here + r".*got str beside a symbol", lambda: ocp.cost(lambda x, u: x[0] + "1"), TypeError)
        other = ch.Problem(1, 1, 5)
        taken = []
        other.cost(lambda x, u: taken.append(x[0]) or x[0])
        self.refuse("symbol of another problem", lambda: ocp.cost(lambda x, u: taken[0]))

    def test_what_makes_no_problem_is_refused(self):
        ocp = ch.Problem(2, 1, 10)
        self.refuse("dynamics: got 1 values, expected 2", lambda: ocp.dynamics(lambda x, u: [x[0]]))
        self.refuse(r"got no dynamics, expected @ocp\.dynamics", lambda: ocp.solve([0, 0]))
        self.refuse("dynamics: got a function that returns nothing", lambda: ocp.dynamics(lambda x, u: None))
        self.refuse("cost: .*expected x of 2 entries|residual: .*expected x of 2 entries", lambda: ocp.cost(lambda x, u: x[2]))
        ocp.dynamics(lambda x, u: x)
        self.refuse("dynamics: got a second function, expected one", lambda: ocp.dynamics(lambda x, u: 2.0 * x))
        self.refuse("constraint: got a comparison, expected what has to be <= 0: a - b for a <= b", lambda: ocp.subject_to(lambda x, u: x[0] <= 1))
        self.refuse("constraint: got a comparison", lambda: ocp.subject_to(lambda x, u: x < np.ones(2), at_end=False))
        self.refuse("residual: got a comparison, expected a value: ch.where", lambda: ocp.cost(lambda x, u: x[0] > u[0]))
        self.refuse("got no cost", lambda: ocp.solve([0, 0]))
        ocp.cost(lambda x, u: x @ x)
        self.refuse(r"x0: got shape \(3,\), expected numbers of shape \(2,\)", lambda: ocp.solve([0, 0, 0]))
        self.refuse(r"x0: got shape \(1,\), expected numbers of shape \(2,\)", lambda: ocp.solve([0]))
        self.refuse(r"x0: got shape \(1,\)", lambda: ocp.solve(0.0))
        self.refuse(r"u: got shape \(10,\), expected numbers of shape \(10, 1\)", lambda: ocp.solve([0, 0], u=np.zeros(10)))
        self.refuse("x0: got .*expected finite numbers", lambda: ocp.solve([0, np.nan]))
        self.refuse("p: got numbers, expected none", lambda: ocp.solve([0, 0], [1.0]))
        self.refuse("got a lower bound above the upper one", lambda: ocp.bounds(u=(1, -1)))
        self.refuse("horizon: got 500, expected a whole number from 1 to 200", lambda: ch.Problem(2, 1, 500))
        self.refuse("nx: got 53, expected a whole number from 1 to 52", lambda: ch.Problem(53, 1, 5))
        many = ch.Problem(2, 1, 5)
        many.dynamics(lambda x, u: x)
        many.cost(lambda x, u: [x[0] - n for n in range(70)])
        self.refuse(r"^Problem: residuals: got 70, expected at most 64$", lambda: many.solve([0, 0]))
        self.refuse("nx: got 2.5", lambda: ch.Problem(2.5, 1, 5))
        self.refuse("tolerance: got 1", lambda: ocp.solve([0, 0], tolerance=1.0))
        self.refuse('sensitivity: got "p", expected a problem with parameters', lambda: ocp.solve([0, 0]).sensitivity("p"))


if __name__ == "__main__":
    unittest.main()
