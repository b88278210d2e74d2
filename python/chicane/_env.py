# SPDX-License-Identifier: MIT
"""The closed loop as an environment for reinforcement learning, with the interface of gymnasium."""
from __future__ import annotations

from collections.abc import Callable, Iterable, Mapping
from functools import partial
from typing import Any

import numpy as np

from ._types import npt
from . import _chicane
from ._request import Settings, make_request
from ._track import AnyTrack
from ._spaces import AUTORESET, BaseEnv, BaseVecEnv, Box, batch_space, box

Array = npt.NDArray[np.float64]
Info = dict[str, Any]
Reward = Callable[[Array, Info], float]

NOISE = {"sensor.position_noise_m": 0.05, "sensor.heading_noise_deg": 0.3, "sensor.speed_noise_mps": 0.1}
"""What `noise=True` sets: standard deviations of a good localisation in full size."""


def _request(track: AnyTrack | None, car: str | None, rate_hz: float, noise: bool | Settings, seed: int, faults: Iterable[str],
             settings: Settings | None) -> _chicane.Request:
    if not 1.0 <= rate_hz <= 200.0:
        raise ValueError(f"rate_hz: got {rate_hz}, expected a number in [1, 200]")
    sensors = {key: value for key, value in (NOISE.items() if noise is True else noise.items() if noise else ())}
    named = {"laps": 0, "guard.mode": "off", "track": track, "car": car, "control_period_ms": 1000.0 / rate_hz, "seed": seed,
             **sensors}
    return make_request(named, settings, faults)


def _options(observation: str, randomise: Mapping[str, tuple[float, float]] | None, random_faults: Iterable[str], starts_anywhere: bool,
             ends_off_road: bool, off_road_cost: float, episode_s: float) -> dict[str, Any]:
    randomise = dict(randomise or {})
    for key, (low, high) in randomise.items():
        if not low <= high:
            raise ValueError(f"randomise: {key}: got ({low}, {high}), expected (low, high)")
    return {"observation": observation, "randomise": randomise, "random_faults": list(random_faults),
            "starts_anywhere": starts_anywhere, "ends_off_road": ends_off_road, "off_road_cost": float(off_road_cost),
            "episode_s": float(episode_s)}


class Env(BaseEnv):
    """A car on a track for an agent, on the loop of drive(): the same commands give the same run, bit for bit.

        env = ch.Env("hairpins", car="f1tenth", rate_hz=20, noise=True, seed=1)
        observation, info = env.reset()
        observation, reward, terminated, truncated, info = env.step([steer, throttle])

    It is a gymnasium.Env if gymnasium can be imported, also made by gymnasium.make("chicane/Race-v0"), and has the same
    methods if not. A pickle or copy is another one with the same arguments, whose first episode begins.

    Actions are arrays of shape (2,): steer [rad], left positive, and throttle in [-1, 1], negative brakes. An action answers
    the observation before it, acts `latency_ms` later, and is limited to what the car can do.

    An episode is terminated when a tyre has left the road (unless ends_off_road=False), or settings["laps"] laps are driven. It
    is truncated after `episode_s`, or when the car is lost. `info` has the truth: time_s, s_m, lateral_error_m,
    edge_distance_m, speed_mps, lap, is_off_track.

    Parameters
    ----------
    track : str, path or Track
        Road, as for drive().
    car : str or path
        Car, as for drive().
    rate_hz : float
        Observations in a second [1/s], 1 to 200.
    noise : bool or dict
        True: noise of a good localisation (0.05 m, 0.3°, 0.1 m/s); or settings by key ("sensor.position_noise_m").
    seed : int
        Seed of the first episode; each reset() without a seed adds one. Everything random follows from it.
    observation : {"track", "waypoints", "pose", "scan"}
        Kind of observations: float64, by the sensors, with their noise, age and faults; not-a-number if they show nothing.
        "track", shape (15,): speed [m/s], distance from the centre line [m], heading against it [rad], steer [rad],
        throttle, and the curvature of the centre line 5, 10, ... 50 m ahead [1/m] (times the scale of a model car).
        "waypoints", shape (3 + 2 n,): speed [m/s], steer [rad], throttle, and n waypoints seen from the car, x ahead and
        y to the left [m]; n is settings["waypoints_sent"], 6 by default.
        "pose", shape (7,): time [s], x, y [m], yaw [rad], speed [m/s], steer [rad], throttle.
        "scan", shape (3 + 1080,): speed [m/s], steer [rad], throttle, and a laser as F1TENTH has it: distances [m] to walls
        along the edges of the road, from -135° on the right to 135° on the left, at most 30 m, without noise and delay.
    reward : function
        Function of observation and info, such as lambda observation, info: info["speed_mps"]; None: metres gained along the
        centre line, less `off_road_cost`.
    faults : list of str
        Faults of every episode, as in drive().
    random_faults : list of str
        Faults of which each episode gets one.
    randomise : dict
        Settings that are drawn evenly for each episode: {"plant_options.friction_scale": (0.7, 1.0)}.
    starts_anywhere : bool
        Whether the car starts, standing, anywhere on the centre line; else at the track's start.
    ends_off_road : bool
        Whether an episode ends when a tyre leaves the road.
    off_road_cost : float
        Cost of leaving the road, in metres.
    episode_s : float
        Length of an episode [s]; 0: no limit.
    settings : dict
        Any others; the guard is off unless you set "guard.mode".
    render_mode : {None, "rgb_array"}
        Whether render() makes pictures.
    """

    metadata: dict[str, Any] = {"render_modes": ["rgb_array"], "render_fps": 20}

    def __init__(self, track: AnyTrack | None = None, car: str | None = None, rate_hz: float = 20.0, noise: bool | Settings = False,
                 seed: int = 1, *, observation: str = "track", reward: Reward | None = None, faults: Iterable[str] = (),
                 random_faults: Iterable[str] = (), randomise: Mapping[str, tuple[float, float]] | None = None,
                 starts_anywhere: bool = False, ends_off_road: bool = True, off_road_cost: float = 10.0, episode_s: float = 0.0,
                 settings: Settings | None = None, render_mode: str | None = None) -> None:
        faults, random_faults = tuple(faults), tuple(random_faults)  # of generators, too: copies get the same
        self._arguments = {name: value for name, value in locals().items() if name not in ("self", "__class__")}
        if render_mode not in (None, "rgb_array"):
            raise ValueError(f"render_mode: got {render_mode!r}, expected None or \"rgb_array\"")
        options = _options(observation, randomise, random_faults, starts_anywhere, ends_off_road, off_road_cost, episode_s)
        self._core = _chicane.Environment(_request(track, car, rate_hz, noise, seed, faults, settings), options)
        self._reward = reward
        self._next_seed = seed
        self.render_mode = render_mode
        self.action_space: Box = _action_space(self._core)
        self.observation_space: Box = _observation_space(self._core)

    def reset(self, *, seed: int | None = None, options: Mapping[str, Any] | None = None) -> tuple[Array, Info]:
        """Begins an episode.

        Parameters
        ----------
        seed : int
            Seed of everything random in it; None: the one after the last.
        options : dict
            Not used.

        Returns
        -------
        observation : array
            First observation.
        info : dict
            The truth.
        """
        super().reset(seed=seed)
        if seed is not None:
            self._next_seed = seed
        self._core.reset(self._next_seed)
        self._next_seed += 1
        return self._core.observe(), self._core.info()

    def step(self, action: npt.ArrayLike) -> tuple[Array, float, bool, bool, Info]:
        """Drives one control period with a command; beyond the end of an episode nothing moves: truncated.

        Parameters
        ----------
        action : array of shape (2,)
            Steer [rad] and throttle in [-1, 1].

        Returns
        -------
        observation : array
            Next observation.
        reward : float
            Reward of the step.
        terminated, truncated : bool
            Whether the episode has ended.
        info : dict
            The truth.
        """
        outcome = self._core.step(action)
        if self._reward is None:
            return outcome
        observation, _, terminated, truncated, info = outcome
        return observation, self._reward(observation, info), terminated, truncated, info

    def set(self, key: str, value: Any) -> None:
        """Changes a setting of the present episode, or switches a fault: set("fault.half_grip", True).

        Parameters
        ----------
        key : str
            Setting.
        value : Any
            Its value, in the setting's unit.
        """
        from ._request import text_of
        self._core.set(key, text_of(value))

    @property
    def drawn(self) -> list[float]:
        """Values drawn for this episode, in the order of `randomise`."""
        return self._core.drawn

    @property
    def state_hash(self) -> str:
        """Hash of every state and command of the episode, as run["state_hash"] of a run with the same commands."""
        return f"{self._core.state_hash:016x}"

    def render(self) -> npt.NDArray[np.uint8] | None:
        """Paints the road and the car from above; the recording of a trained controller (drive(record=...), view()) shows more.

        Returns
        -------
        array of shape (400, 400, 3), or None
            Picture with render_mode="rgb_array".
        """
        return _picture(self._core.edges(), *self._core.pose()) if self.render_mode else None

    def __reduce__(self) -> Any:
        return partial(type(self), **self._arguments), ()

    def close(self) -> None:
        """Does nothing: an environment holds nothing to give back."""

    def __repr__(self) -> str:
        return f"<Env: observation {self.observation_space.shape}, episode step {self._core.steps}>"


class VecEnv(BaseVecEnv):
    """Many environments that are stepped together on threads, without the interpreter's lock.

        envs = ch.VecEnv(64, "hairpins", car="f1tenth", threads=2, noise=True, seed=1)
        observations, infos = envs.reset()
        observations, rewards, terminated, truncated, infos = envs.step(actions)      # (64, 2)

    Shapes have `count` in front. The bits do not depend on `threads`: environment i begins with seed + i, and each episode that
    ends is followed at once by one with the next seed. Then infos["final_obs"] has the last observations of all environments,
    and infos["_final_obs"] says whose episode has ended (gymnasium's AutoresetMode.SAME_STEP). `reward` is called for each
    environment with its last observation and the truth there.

    Parameters
    ----------
    count : int
        Number of environments.
    track, car, rate_hz, noise, seed : Any
        As for Env.
    threads : int
        Threads; 0: as many as processors.
    observation, reward, faults, random_faults, randomise, starts_anywhere, ends_off_road, off_road_cost, episode_s, settings : Any
        As for Env.
    """

    metadata: dict[str, Any] = {"render_modes": [], "autoreset_mode": AUTORESET}

    def __init__(self, count: int, track: AnyTrack | None = None, car: str | None = None, rate_hz: float = 20.0,
                 noise: bool | Settings = False, seed: int = 1, *, threads: int = 0, observation: str = "track",
                 reward: Reward | None = None, faults: Iterable[str] = (), random_faults: Iterable[str] = (),
                 randomise: Mapping[str, tuple[float, float]] | None = None, starts_anywhere: bool = False, ends_off_road: bool = True,
                 off_road_cost: float = 10.0, episode_s: float = 0.0, settings: Settings | None = None) -> None:
        if isinstance(count, bool) or not isinstance(count, (int, np.integer)) or count < 1:
            raise ValueError(f"count: got {count!r}, expected a whole number of environments from 1 on: VecEnv(16, \"oval\")")
        options = _options(observation, randomise, random_faults, starts_anywhere, ends_off_road, off_road_cost, episode_s)
        self._core = _chicane.Batch(_request(track, car, rate_hz, noise, seed, faults, settings), options, count, threads)
        self._reward = reward
        self._seed = seed
        self.num_envs = count
        self.single_action_space: Box = _action_space(self._core.at(0))
        self.single_observation_space: Box = _observation_space(self._core.at(0))
        self.action_space: Box = batch_space(self.single_action_space, count)
        self.observation_space: Box = batch_space(self.single_observation_space, count)

    def reset(self, *, seed: int | None = None, options: Mapping[str, Any] | None = None) -> tuple[Array, Info]:
        """Begins an episode in each environment.

        Parameters
        ----------
        seed : int
            Seed of the first; None: the one of the constructor.
        options : dict
            Not used.

        Returns
        -------
        observations : array
            First observations.
        infos : dict
            Empty.
        """
        super().reset(seed=seed)
        if seed is not None:
            self._seed = seed
        return self._core.reset(self._seed), {}

    def step(self, actions: npt.ArrayLike) -> tuple[Array, Array, npt.NDArray[np.bool_], npt.NDArray[np.bool_], Info]:
        """Drives one control period in each environment.

        Parameters
        ----------
        actions : array of shape (count, 2)
            Steer [rad] and throttle in [-1, 1].

        Returns
        -------
        observations, rewards, terminated, truncated : array
            As of Env.step(), with `count` in front.
        infos : dict
            "final_obs" and "_final_obs" if an episode has ended.
        """
        observations, rewards, terminated, truncated, last, truths = self._core.step(actions, self._reward is not None)
        if self._reward is not None:
            rewards = np.array([self._reward(*reply) for reply in zip(last, truths)], float)
        ended = terminated | truncated
        infos: Info = {"final_obs": last, "_final_obs": ended} if ended.any() else {}
        return observations, rewards, terminated, truncated, infos

    def info(self, index: int) -> Info:
        """The truth of one environment, as Env.step() returns it.

        Parameters
        ----------
        index : int
            Number of the environment.

        Returns
        -------
        dict
            The truth.
        """
        return self._core.at(index).info()

    def close(self, **kwargs: Any) -> None:
        """Does nothing: the environments hold nothing to give back.

        Parameters
        ----------
        **kwargs : Any
            Not used.
        """

    def __len__(self) -> int:
        return self.num_envs

    def __repr__(self) -> str:
        return f"<VecEnv: {self.num_envs} environments, observation {self.single_observation_space.shape}>"


def _picture(edges: Array, x: float, y: float, yaw: float) -> npt.NDArray[np.uint8]:
    """Edges of the road, (n, 2) and dense, in black on white; the car in red, at least nine pixels long."""
    low, high = edges.min(axis=0), edges.max(axis=0)
    scale = 380.0 / (high - low).max()
    picture = np.full((400, 400, 3), 255, np.uint8)

    def paint(places: Array, colour: tuple[int, int, int]) -> None:
        pixels = np.rint((places - 0.5 * (low + high)) * scale).astype(int) + 200
        column, row = np.clip(pixels, 0, 399).T
        picture[399 - row, column] = colour
    paint(edges, (0, 0, 0))
    along, across = np.meshgrid(np.linspace(-4.5, 4.5, 19) / scale, np.linspace(-2.0, 2.0, 9) / scale)
    turn = np.array([[np.cos(yaw), np.sin(yaw)], [-np.sin(yaw), np.cos(yaw)]])
    paint(np.array([x, y]) + np.stack([along.ravel(), across.ravel()], axis=1) @ turn, (200, 0, 0))
    return picture


def _action_space(core: _chicane.Environment) -> Box:
    high = np.array([core.steer_limit, 1.0])
    return box(-high, high)


def _observation_space(core: _chicane.Environment) -> Box:
    high = np.full(core.size, np.inf)
    return box(-high, high)
