#!/usr/bin/env python3
# SPDX-License-Identifier: MIT
"""Whether an agent of others learns to drive: PPO of stable-baselines3 on chicane/Race-v0, the table of docs/measured/python.md.

    ./run.sh python python/tests/learning_table.py [STEPS]

Needs gymnasium, stable-baselines3 and PyTorch. Eight environments, one thread, the learner's own defaults but for n_steps, batch_size and
log_std_init.
Prints the mean return and the share of finished laps of the last 40 episodes over training, then five laps of the trained agent. Exit code 1
where it does not finish one."""
import sys
import time

import gymnasium
import numpy as np
import torch
from stable_baselines3 import PPO
from stable_baselines3.common.callbacks import BaseCallback
from stable_baselines3.common.env_checker import check_env
from stable_baselines3.common.monitor import Monitor
from stable_baselines3.common.vec_env import DummyVecEnv, VecNormalize

import chicane  # noqa: F401  (makes its ids known)


def make(seed, **others):
    env = gymnasium.make("chicane/Race-v0", track="oval", car="road-car", rate_hz=10, seed=seed, settings={"laps": 1}, **others)
    return Monitor(gymnasium.wrappers.RescaleAction(env, np.float32(-1.0), np.float32(1.0)))


class Told(BaseCallback):
    """Prints the mean of the last episodes."""

    def _on_training_start(self):
        self.episodes = []

    def _on_step(self):
        self.episodes += [(info["episode"]["r"], info["lap"]) for info in self.locals["infos"] if "episode" in info]
        return True

    def _on_rollout_end(self):
        if self.episodes and self.num_timesteps % 10240 == 0:
            total, laps = np.mean(self.episodes[-40:], axis=0)
            print(f"| {self.num_timesteps:,} | {total:.0f} | {100 * laps:.0f} % |", flush=True)


def main():
    torch.set_num_threads(1)
    check_env(gymnasium.make("chicane/Race-v0", track="oval").unwrapped)
    envs = VecNormalize(DummyVecEnv([lambda n=n: make(1000 * n, episode_s=90.0, starts_anywhere=True) for n in range(1, 9)]))
    model = PPO("MlpPolicy", envs, n_steps=256, batch_size=256, seed=1, device="cpu", policy_kwargs={"log_std_init": -1.0})
    print("| steps | mean return [m] | laps finished |\n|--:|--:|--:|")
    begin = time.perf_counter()
    model.learn(int(sys.argv[1]) if len(sys.argv) > 1 else 100_000, callback=Told())
    print(f"\n{time.perf_counter() - begin:.0f} s")
    env, finished = make(50, episode_s=120.0), 0
    for _ in range(5):
        observation, info = env.reset()
        is_over = False
        while not is_over:
            observation, _, terminated, truncated, info = env.step(model.predict(envs.normalize_obs(observation), deterministic=True)[0])
            is_over = terminated or truncated
        finished += info["lap"] == 1 and not info["is_off_track"]
        print(f"lap {info['lap']} after {info['time_s']:.1f} s, {'off' if info['is_off_track'] else 'on'} the road")
    return 0 if finished == 5 else 1


if __name__ == "__main__":
    sys.exit(main())
