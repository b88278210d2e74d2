# SPDX-License-Identifier: MIT
"""Controllers written in Python: in the whole loop, and stopped by the guard where they fail."""
import contextlib
import io
import math
import os
import signal
import tempfile
import unittest
from pathlib import Path

import numpy as np

import chicane as ch


class Chase(ch.Controller):
    """Steers at the third waypoint and holds 10 m/s."""

    def step(self, seen):
        if len(seen.waypoints) < 3:
            return ch.NO_ANSWER
        x, y = seen.waypoints_ahead[2]
        curvature = 2 * y / max(1.0, x * x + y * y)
        return ch.Command(steer=seen.wheelbase * curvature, throttle=0.2 * (10 - seen.speed) + 0.2)


class Failing(Chase):
    """Fails at 5 s."""

    def __init__(self, failure):
        self.failure = failure
        self.calls = 0

    def step(self, seen):
        if seen.time < 5.0:
            return super().step(seen)
        self.calls += 1
        return self.failure()


def drive(controller, **arguments):
    """The run, and what it printed."""
    printed = io.StringIO()
    with contextlib.redirect_stderr(printed):
        run = ch.drive("oval", laps=1, controller=controller, **arguments)
    return run, printed.getvalue()


class Controllers(unittest.TestCase):
    def test_drive_with_latency_faults_and_guard(self):
        with tempfile.TemporaryDirectory() as folder:
            file = Path(folder) / "chase.mcap"
            run, printed = drive(Chase(), latency_ms=150, faults=["link_lost@20"], record=file)
            self.assertEqual(printed, "")
            self.assertTrue(run["completed"])
            self.assertEqual((run["controller"], run["latency_ms"], run["off_track_events"]), ("Chase", 150, 0))
            self.assertGreater(run["fallbacks"], 0)
            self.assertEqual(ch.verify(file, Chase())["different"], 0)
            self.assertGreater(ch.verify(file, Failing(lambda: (0.0, 0.0)))["different"], 0)
            self.assertEqual(ch.read(file).head["controller"], "Chase")

    def test_same_run_twice(self):
        self.assertEqual(drive(Chase())[0]["state_hash"], drive(Chase())[0]["state_hash"])

    def test_a_model_car_is_seen_as_it_is(self):
        told = []

        class Listening(Chase):
            def step(self, seen):
                told.append((seen.time, seen.x, seen.y, seen.speed, seen.wheelbase))
                return 0.02, 0.1

        run = ch.drive("oval", car="f1tenth", laps=0, controller=Listening(), settings={"time_limit_s": 3, "guard.mode": "off"})
        times, x, y, speed, wheelbase = np.array(told).T
        np.testing.assert_allclose(times, run.frames["time_s"], rtol=1e-12)
        np.testing.assert_allclose(x, run.frames["measured_x_m"], rtol=1e-12)
        np.testing.assert_allclose(y, run.frames["measured_y_m"], rtol=1e-12)
        np.testing.assert_allclose(speed, run.frames["measured_speed_mps"], rtol=1e-12)
        self.assertLess(wheelbase[0], 0.5)

    def test_failures_are_told_and_the_guard_stops_the_car(self):
        def endless():
            while True:
                pass

        failures = (
            (lambda: [][1], r"Failing failed at 5\.00 s; the guard stops the car:\n(?s:Traceback.*)IndexError: list index"),
            (lambda: (math.nan, 0.0), r"step: steer: got nan, expected a number in \[-1.57, 1.57\] rad"),
            (lambda: (12.0, 0.0), r"step: steer: got 12, expected .* \(is it in degrees\?\)"),
            (lambda: ch.Command(0.0, math.inf), r"Command: throttle: got inf, expected a finite number"),
            (lambda: None, r"step: got None, expected Command\(steer, throttle\), two numbers or NO_ANSWER"),
            (lambda: "fast", r"step: got 'fast', expected Command"),
            (endless, r"TimeoutError\nstep: it took longer than 0\.2 s \(step_limit_s\)"))
        for failure, message in failures:
            with self.subTest(message):
                controller = Failing(failure)
                run, printed = drive(controller, step_limit_s=0.2)
                self.assertRegex(printed, message)
                self.assertIn(run.error, printed)
                self.assertEqual(controller.calls, 1)
                self.assertFalse(run["completed"])
                self.assertEqual(run["off_track_events"], 0)
                self.assertLess(run.frames["speed_mps"][-1], 0.2)
                self.assertLess(run["duration_s"], 15.0)
                self.assertIn("its controller failed", repr(run))

    def test_what_is_called_wrongly_is_told_too(self):
        class TooFew(ch.Controller):
            def step(self):
                return 0.0, 0.0

        class TooMany(ch.Controller):
            def reset(self, seed):
                pass
        for controller, message in ((TooFew(), r"TooFew\.step\(\) takes 1 positional argument but 2 were given"),
                                    (TooMany(), r"TooMany\.reset\(\) missing 1 required positional argument")):
            run, printed = drive(controller)                # errors without a trace: no line of Python has run
            self.assertRegex(run.error, "TypeError: .*" + message)
            self.assertIn(run.error, printed)
        with self.assertRaisesRegex(ValueError, r"^controller: got the class Chase, expected an instance of it: Chase\(\)$"):
            ch.drive("oval", controller=Chase)

    def test_says_what_is_not_written(self):
        run, _ = drive(ch.Controller())
        self.assertIn("NotImplementedError: Controller.step(seen) is not written yet", run.error)

    def test_an_interrupt_ends_the_run(self):
        with self.assertRaises(KeyboardInterrupt):
            drive(Failing(lambda: (os.kill(os.getpid(), signal.SIGINT), 0.0)[1:]))


if __name__ == "__main__":
    unittest.main()
