# SPDX-License-Identifier: MIT
"""Cars and roads of one's own: in the loop of the library's."""
import math
import os
import tempfile
import unittest
from pathlib import Path
from unittest import mock

import numpy as np

import chicane as ch


class Cart(ch.Plant):
    """Rolls where its front wheels point."""
    step_s = 0.01

    def __init__(self):
        self.resets = 0
        self.told = set()

    def reset(self, state):
        self.resets += 1
        self.begin = state

    def step(self, state, steer, throttle):
        self.told.add((self.grip, self.side_acceleration, self.friction_scale))
        h = self.step_s
        speed = max(0.0, state.vx + h * self.grip * (6.0 * throttle - 0.02 * state.vx))
        yaw_rate = speed * math.tan(steer) / (self.front_axle + self.rear_axle)
        return ch.CarState(state.x + h * speed * math.cos(state.yaw), state.y + h * speed * math.sin(state.yaw), state.yaw + h * yaw_rate,
                           vx=speed, yaw_rate=yaw_rate, steer=steer)


class Failing(Cart):
    def __init__(self, failure):
        super().__init__()
        self.failure, self.steps = failure, 0

    def step(self, state, steer, throttle):
        self.steps += 1
        return self.failure() if self.steps == 100 else super().step(state, steer, throttle)


class Points(ch.TrackReader):
    extension = ".points"

    def read(self, path):
        return ch.Track(np.loadtxt(path), left=5.0, right=5.0, closed=True, name="ring")


def ring(radius):
    angle = np.linspace(0, 2 * np.pi, 40, endpoint=False)
    return radius * np.column_stack([np.cos(angle), np.sin(angle)])


class Plants(unittest.TestCase):
    def test_a_car_of_ones_own_is_driven_by_the_library_and_recorded(self):
        with tempfile.TemporaryDirectory() as folder:
            file = Path(folder) / "cart.mcap"
            cart = Cart()
            run = ch.drive("oval", plant=cart, laps=1, latency_ms=100, faults=["half_grip@10+3"], record=file)
            self.assertTrue(run["completed"])
            self.assertEqual(run["off_track_events"], 0)
            self.assertGreaterEqual(cart.resets, 1)
            self.assertEqual(cart.told, {(1.0, 0.0, 1.0), (0.5, 0.0, 1.0)})
            self.assertTrue(ch.verify(file)["is_verified"])
            self.assertEqual(ch.read(file).frames["speed_mps"].tolist(), run.frames["speed_mps"].tolist())
            again = ch.drive("oval", plant=Cart(), laps=1, latency_ms=100, faults=["half_grip@10+3"])
            self.assertEqual(again["state_hash"], run["state_hash"])
            self.assertNotEqual(ch.drive("oval", laps=1, latency_ms=100, faults=["half_grip@10+3"])["state_hash"], run["state_hash"])

    def test_what_it_raises_ends_the_run(self):
        def endless():
            while True:
                pass

        for failure, kind, message in ((lambda: {}["no"], KeyError, "no"), (lambda: None, TypeError, "step: got None, expected a CarState"),
                                       (lambda: ch.CarState(math.nan), ValueError, "expected finite numbers"), (endless, TimeoutError, "")):
            with self.subTest(message), self.assertRaisesRegex(kind, message):
                ch.drive("oval", plant=Failing(failure), laps=1, step_limit_s=0.2)
        slow = Cart()
        slow.step_s = 1.0
        with self.assertRaisesRegex(ValueError, "Plant: step_s: got 1.0+, expected a number of seconds"):
            ch.drive("oval", plant=slow)
        with self.assertRaisesRegex(ValueError, "plant: got boat, expected one of"):
            ch.drive("oval", plant="boat")
        with self.assertRaisesRegex(NotImplementedError, r"Plant\.step\(state, steer, throttle\) is not written yet"):
            ch.drive("oval", plant=ch.Plant())


class Tracks(unittest.TestCase):
    def test_a_road_of_ones_own_is_driven_recorded_and_measured(self):
        with tempfile.TemporaryDirectory() as folder, mock.patch.dict(os.environ, {"XDG_CACHE_HOME": folder}):
            road = ch.Track(ring(60.0), left=4.0, right=np.full(40, 5.0), name="ring", smoothing_sigma_m=0.01)
            file = Path(folder) / "ring.mcap"
            run = ch.drive(road, laps=1, record=file)
            self.assertTrue(run["completed"])
            self.assertEqual(run["track"], "ring")
            radii = np.hypot(*run.road["left"].T)
            np.testing.assert_allclose(radii, 56.0, atol=0.1)
            self.assertTrue(ch.verify(file)["is_verified"])
            road.save(Path(folder) / "ring.csv")
            self.assertEqual(ch.drive(Path(folder) / "ring.csv", laps=1)["state_hash"], run["state_hash"])
            env = ch.Env(road)
            env.reset()
            self.assertGreater(ch.limit(road, witness=False).bound_s, 5.0)

    def test_a_reader_brings_its_files_along(self):
        with tempfile.TemporaryDirectory() as folder, mock.patch.dict(os.environ, {"XDG_CACHE_HOME": folder}):
            file = Path(folder) / "here.points"
            np.savetxt(file, ring(50.0))
            ch.use_track_reader(Points())
            run = ch.drive(file, laps=1)
            self.assertTrue(run["completed"])
            np.testing.assert_allclose(np.hypot(*run.road["centre"].T), 50.0, atol=0.5)
            table = ch.sweep({"latency_ms": [100]}, settings={"laps": 1, "track": file})
            self.assertEqual(len(table), 1)
            with self.assertRaisesRegex(ValueError, "there is no such file"):
                ch.drive("no.points")

    def test_what_is_no_road_is_refused(self):
        for call, message in ((lambda: ch.Track([[0, 0]]), r"xy: got shape \(1, 2\), expected \(n, 2\) with n >= 4"),
                              (lambda: ch.Track(ring(50), left=[1, 2]), r"widths of shapes \(2,\)"),
                              (lambda: ch.Track(ring(50), name="a/b"), "name: got 'a/b'"),
                              (lambda: ch.drive(ch.Track(ring(50), left=-1.0)), "expected a width > 0"),
                              (lambda: ch.use_track_reader(ch.TrackReader()), "expected a TrackReader with an extension")):
            with self.subTest(message), self.assertRaisesRegex(ValueError, message):
                call()


if __name__ == "__main__":
    unittest.main()
