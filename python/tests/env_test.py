# SPDX-License-Identifier: MIT
"""The environment: the loop of drive(), step by step."""
import copy
import importlib.util
import os
import pickle
import subprocess
import sys
import unittest

import numpy as np

import chicane as ch

NOISY = {"sensor.position_noise_m": 0.1, "sensor.speed_noise_mps": 0.2, "sensor.latency_ms": 30}

FAKE_GYMNASIUM = """
import sys, types
for name in ("gymnasium", "gymnasium.spaces", "gymnasium.vector"):
    sys.modules[name] = types.ModuleType(name)
class Base:
    def reset(self, seed=None): self.seeded = seed
class Box:
    def __init__(self, low, high, dtype): self.low, self.high, self.shape, self.dtype = low, high, low.shape, dtype
sys.modules["gymnasium"].Env = type("Env", (Base,), {})
sys.modules["gymnasium.vector"].VectorEnv = type("VectorEnv", (Base,), {})
sys.modules["gymnasium.spaces"].Box = Box
sys.modules["gymnasium.vector"].AutoresetMode = types.SimpleNamespace(SAME_STEP="same")
for name in ("gymnasium.envs", "gymnasium.envs.registration"):
    sys.modules[name] = types.ModuleType(name)
registration = sys.modules["gymnasium.envs.registration"]
registration.registry = {}
registration.register = lambda id, entry_point: registration.registry.update({id: entry_point})
import chicane as ch
assert registration.registry == {"chicane/Race-v0": "chicane:Env"}, registration.registry
env = ch.Env("oval")
assert isinstance(env, sys.modules["gymnasium"].Env) and isinstance(env.action_space, Box), ch.Env.__mro__
assert issubclass(ch.VecEnv, sys.modules["gymnasium.vector"].VectorEnv)
env.reset(seed=3)
assert env.seeded == 3
env.step([0.0, 1.0])
"""

# Where gymnasium is looked for: what the interpreter imports, or a folder with its source (its package `gymnasium`).
GYMNASIUM = os.environ.get("CHICANE_GYMNASIUM", "")
CHECKED = """
import sys
sys.path.insert(0, sys.argv[1]) if sys.argv[1] else None
import gymnasium, numpy as np, chicane as ch
from gymnasium.utils.env_checker import check_env
from gymnasium.wrappers.vector import RecordEpisodeStatistics
env = gymnasium.make("chicane/Race-v0", track="oval", render_mode="rgb_array")
check_env(env.unwrapped)
check_env(ch.Env("oval", observation="scan"), skip_render_check=True)
env.reset(seed=1)
assert env.render().shape == (400, 400, 3)
envs = RecordEpisodeStatistics(ch.VecEnv(3, "oval", episode_s=0.5))
envs.reset(seed=1)
for _ in range(12): infos = envs.step(np.zeros((3, 2)))[4] or infos if _ else {}
assert infos["_episode"].all() and infos["final_obs"].shape == (3, 15), infos
"""


class Environment(unittest.TestCase):
    def test_recorded_commands_reproduce_the_run_bit_for_bit(self):
        settings = {**NOISY, "guard.mode": "off"}
        run = ch.drive("oval", car="road-car", laps=1, seed=5, settings=settings, faults=["half_grip@3+2"])
        env = ch.Env("oval", car="road-car", rate_hz=25, seed=5, observation="pose", noise=NOISY, settings={"laps": 1},
                     faults=["half_grip@3+2"])
        observation, _ = env.reset()
        frames = run.frames
        for i, action in enumerate(zip(frames["steer_asked_rad"], frames["throttle_asked"])):
            self.assertEqual(observation[1], frames["measured_x_m"][i])  # what the controller saw before this command
            self.assertEqual(observation[4], frames["measured_speed_mps"][i])
            observation, _, terminated, truncated, info = env.step(action)
        self.assertTrue(terminated)
        self.assertFalse(truncated)
        self.assertEqual(env.state_hash, run["state_hash"])
        self.assertEqual(info["time_s"], run["duration_s"])

    def test_tells_what_the_sensors_say(self):
        quiet = ch.Env("oval", noise=False).reset()[0]
        noisy = ch.Env("oval", noise=True).reset()[0]
        self.assertEqual(quiet.shape, (15,))
        self.assertEqual(quiet[1], 0.0)
        self.assertNotEqual(noisy[1], 0.0)
        self.assertEqual(ch.Env("oval", observation="waypoints").reset()[0].shape, (15,))
        env = ch.Env("oval", faults=["link_lost@0+1"])
        self.assertTrue(np.isnan(env.reset()[0][1]))
        self.assertFalse(ch.Env("oval").observation_space.contains(np.zeros(3)))

    def test_everything_random_follows_from_the_seed(self):
        def episode(seed):
            env = ch.Env("oval", noise=True, starts_anywhere=True, random_faults=["half_grip@0", "side_wind@0"],
                         randomise={"plant_options.friction_scale": (0.6, 1.0), "plant_options.mass_scale": (0.9, 1.1)})
            env.reset(seed=seed)
            for _ in range(20):
                observation, _, _, _, info = env.step([0.05, 0.5])
            return env.drawn, env.state_hash, info["s_m"], list(observation)

        self.assertEqual(episode(1), episode(1))
        self.assertNotEqual(episode(1)[0], episode(2)[0])
        self.assertNotEqual(episode(1)[1], episode(2)[1])
        self.assertTrue(all(0.6 <= episode(seed)[0][0] <= 1.0 for seed in (3, 4)))

    def test_the_car_is_looked_for_where_it_was_as_in_all_of_the_road(self):
        noise = {"sensor.position_noise_m": 0.2}
        run = ch.drive("crossover", laps=1, seed=3, settings={**noise, "guard.mode": "off", "control_period_ms": 50})
        env = ch.Env("crossover", noise=noise, seed=3, settings={"laps": 1})
        env.reset()
        for action in zip(run.frames["steer_asked_rad"], run.frames["throttle_asked"]):
            observation, _, _, _, info = env.step(action)
            self.assertLess(abs(observation[1] - info["lateral_error_m"]), 1.2)      # six times the noise, also where roads cross
        self.assertEqual(env.state_hash, run["state_hash"])

    def test_ends_where_a_tyre_leaves_the_road(self):
        env = ch.Env("oval", off_road_cost=50.0, reward=lambda observation, info: info["speed_mps"])
        env.reset()
        for _ in range(400):
            _, reward, terminated, truncated, info = env.step([0.0, 1.0])
            if terminated:
                break
        self.assertTrue(terminated and info["is_off_track"])
        self.assertEqual(reward, info["speed_mps"])
        self.assertEqual(env.step([0.0, 1.0])[3], True)
        short = ch.Env("oval", episode_s=0.5)
        short.reset()
        self.assertEqual([short.step([0.0, 0.0])[3] for _ in range(10)], [False] * 9 + [True])

    def test_changes_a_setting_on_the_way(self):
        env = ch.Env("oval")
        env.set("fault.half_grip", True)
        env.set("latency_ms", 20)
        with self.assertRaisesRegex(ValueError, "latency_ms: got 900"):
            env.set("latency_ms", 900)

    def test_refuses_what_it_cannot_do(self):
        env = ch.Env("oval")
        for action, message in (([0.0], r"action: got an array of another shape, expected \(2,\)"),
                                ([float("nan"), 0.0], "action: steer: got nan, expected a number in"),
                                ([20.0, 0.0], r"action: steer: got 20, .*is it in degrees\?")):
            with self.subTest(message), self.assertRaisesRegex(ValueError, message):
                env.step(action)
        for arguments, message in (({"rate_hz": 500}, r"rate_hz: got 500, expected a number in \[1, 200\]"),
                                   ({"observation": "camera"}, "observation: got \"camera\", expected one of track"),
                                   ({"randomise": {"mass": (1, 2)}}, "mass: got an unknown key"),
                                   ({"randomise": {"latency_ms": (2, 1)}}, "randomise: latency_ms"),
                                   ({"random_faults": ["ice"]}, "got ice")):
            with self.subTest(message), self.assertRaisesRegex(ValueError, message):
                ch.Env("oval", **arguments)

    def test_is_gymnasiums_where_that_is_there(self):
        subprocess.run([sys.executable, "-c", FAKE_GYMNASIUM], check=True)

    def test_is_valid_by_gymnasiums_own_checkers(self):
        if not GYMNASIUM and importlib.util.find_spec("gymnasium") is None:
            self.skipTest("gymnasium cannot be imported, and $CHICANE_GYMNASIUM names no folder with its source")
        subprocess.run([sys.executable, "-W", "ignore", "-c", CHECKED, GYMNASIUM], check=True)

    def test_draws_road_and_car(self):
        env = ch.Env("oval", render_mode="rgb_array")
        env.reset()
        picture = env.render()
        self.assertEqual((picture.shape, picture.dtype), ((400, 400, 3), np.uint8))
        self.assertGreater((picture == 0).all(axis=2).sum(), 1000)
        self.assertGreater((picture == [200, 0, 0]).all(axis=2).sum(), 30)
        self.assertIsNone(ch.Env("oval").render())
        with self.assertRaisesRegex(ValueError, "render_mode: got 'human', expected None or"):
            ch.Env("oval", render_mode="human")

    def test_a_copy_is_another_one_with_the_same_arguments(self):
        env = ch.Env("oval", noise=True, seed=7, settings={"laps": 1}, faults=(each for each in ["half_grip@1+1"]))
        self.assertEqual(copy.deepcopy(env)._arguments["faults"], ("half_grip@1+1",))
        first = env.reset()[0]
        env.step([0.0, 1.0])
        for take in (copy.deepcopy, lambda each: pickle.loads(pickle.dumps(each))):
            np.testing.assert_array_equal(take(env).reset()[0], first)

    def test_scans_the_walls_along_the_road(self):
        env = ch.Env("oval", car="f1tenth", observation="scan")
        observation, info = env.reset()
        ranges = observation[3:]
        self.assertEqual(ranges.shape, (1080,))
        right, left = ranges[180], ranges[-181]                          # 90 degrees to each side: beams are a quarter of a degree apart
        self.assertAlmostEqual(right, left, delta=0.05)                  # on the centre line
        self.assertGreater(min(right, left), info["edge_distance_m"])    # which counts from the tyres
        self.assertTrue(np.all((ranges > 0.0) & (ranges <= 30.0)))
        self.assertGreater(ranges[540], 2.0 * right)                     # along the road


class Many(unittest.TestCase):
    def test_bits_do_not_depend_on_threads(self):
        def episodes(threads):
            envs = ch.VecEnv(7, "hairpins", car="f1tenth", threads=threads, noise=True, seed=3)
            observations, _ = envs.reset()
            told, ends = [observations], 0
            for i in range(60):
                actions = np.stack([np.full(7, 0.1), np.linspace(0.2, 1.0, 7)], axis=1)
                observations, rewards, terminated, truncated, infos = envs.step(actions)
                ends += int((terminated | truncated).sum())
                told += [observations, rewards, infos.get("final_obs", rewards)]
            return ends, b"".join(array.tobytes() for array in told)

        ends, told = episodes(1)
        self.assertGreater(ends, 3)
        self.assertEqual(episodes(3), (ends, told))

    def test_takes_a_reward_of_ones_own(self):
        told = []

        def reward(observation, info):
            told.append((observation[0], info["time_s"]))
            return info["time_s"]
        envs = ch.VecEnv(2, "oval", reward=reward, episode_s=0.1)
        envs.reset()
        rewards = [list(envs.step(np.zeros((2, 2)))[1]) for _ in range(3)]
        np.testing.assert_allclose(rewards, [[0.06] * 2, [0.11] * 2, [0.06] * 2], atol=0.011)      # the last of an episode, too
        self.assertEqual(len(told), 6)

    def test_refuses_no_number_of_them(self):
        for count in ("oval", 0, 2.5):
            with self.assertRaisesRegex(ValueError, "count: got .*expected a whole number of environments"):
                ch.VecEnv(count, "oval")

    def test_works_in_a_process_that_was_forked(self):
        envs = ch.VecEnv(4, "oval", threads=2)
        envs.reset()
        actions = np.tile([0.0, 0.5], (4, 1))
        expected = envs.step(actions)[0]
        envs.reset(seed=1)
        child = os.fork()                                   # which has none of the threads
        if child == 0:
            os._exit(0 if np.array_equal(envs.step(actions)[0], expected) else 1)
        self.assertEqual(os.waitpid(child, 0)[1], 0)
        self.assertEqual(ch.VecEnv(2, "oval")._core.threads, os.cpu_count())

    def test_each_is_an_env(self):
        envs = ch.VecEnv(3, "oval", noise=True, seed=10)
        alone = ch.Env("oval", noise=True, seed=11)
        observations, _ = envs.reset()
        np.testing.assert_array_equal(observations[1], alone.reset()[0])
        for _ in range(10):
            observations, rewards, *_ = envs.step(np.tile([0.0, 1.0], (3, 1)))
            observation, reward, *_ = alone.step([0.0, 1.0])
        np.testing.assert_array_equal(observations[1], observation)
        self.assertEqual(rewards[1], reward)
        self.assertEqual(envs.action_space.shape, (3, 2))
        self.assertEqual(envs.info(1), alone.step([0.0, 1.0])[4] | envs.info(1))
        with self.assertRaisesRegex(ValueError, r"actions: got an array of another shape, expected \(3, 2\)"):
            envs.step(np.zeros((2, 2)))


if __name__ == "__main__":
    unittest.main()
