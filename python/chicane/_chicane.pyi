# SPDX-License-Identifier: MIT
"""The compiled part: what the package's Python files call. Users import `chicane`."""
from typing import Any

import numpy as np
import numpy.typing as npt

Array = npt.NDArray[np.float64]
Flags = npt.NDArray[np.bool_]

__version__: str

class Request:
    def __init__(self, scenario: str, settings: list[tuple[str, str]], speed_mps: str, faults: list[str]) -> None: ...

class Command:
    """A command of a controller to the car.

    Attributes
    ----------
    steer : float
        Angle of the front wheels [rad], left positive.
    throttle : float
        One pedal in [-1, 1], negative brakes.
    """
    steer: float
    throttle: float
    def __init__(self, steer: float = 0.0, throttle: float = 0.0) -> None: ...

class NoAnswer:
    """The type of NO_ANSWER, which a controller returns when it has no command to give."""

NO_ANSWER: NoAnswer

class Measurement:
    """A controller's measurement in one cycle, noise, age and faults of the sensors included."""
    @property
    def time(self) -> float:
        """Time of the measurement, from the start of the run [s]."""
    @property
    def x(self) -> float:
        """Position of the centre of mass in the world [m]."""
    @property
    def y(self) -> float:
        """Position of the centre of mass in the world [m]."""
    @property
    def yaw(self) -> float:
        """Heading in the world, counter-clockwise positive [rad]."""
    @property
    def speed(self) -> float:
        """Magnitude of the velocity [m/s]."""
    @property
    def steer(self) -> float:
        """Angle of the front wheels that acted in the cycle before [rad], left positive."""
    @property
    def throttle(self) -> float:
        """Pedal that acted in the cycle before, [-1, 1]."""
    @property
    def delay(self) -> float:
        """Time from `time` until the command acts that is computed now [s]."""
    @property
    def waypoints(self) -> Array:
        """Next points of the road in the world, in driving order, shape (n, 2) [m]; the first may lie behind the car. A copy."""
    @property
    def waypoints_ahead(self) -> Array:
        """The waypoints seen from the car, x ahead and y to the left, shape (n, 2) [m]. A copy."""
    @property
    def wheelbase(self) -> float:
        """Distance between the axles [m]."""
    @property
    def steer_limit(self) -> float:
        """Largest angle of the front wheels [rad]."""

class CarState:
    """Motion of a car in the plane.

    Attributes
    ----------
    x, y : float
        Position of the centre of mass in the world [m].
    yaw : float
        Heading in the world [rad].
    vx, vy : float
        Velocity along the car and to its left [m/s].
    yaw_rate : float
        Rate of the heading [rad/s].
    steer : float
        Angle of the front wheels [rad], left positive.
    """
    x: float
    y: float
    yaw: float
    vx: float
    vy: float
    yaw_rate: float
    steer: float
    def __init__(self, x: float = 0.0, y: float = 0.0, yaw: float = 0.0, vx: float = 0.0, vy: float = 0.0, yaw_rate: float = 0.0,
                 steer: float = 0.0) -> None: ...

class Environment:
    def __init__(self, request: Request, options: dict[str, Any]) -> None: ...
    def reset(self, seed: int) -> None: ...
    def step(self, action: npt.ArrayLike) -> tuple[Array, float, bool, bool, dict[str, Any]]: ...
    def repeat(self, actions: npt.ArrayLike) -> int: ...
    def observe(self) -> Array: ...
    def info(self) -> dict[str, Any]: ...
    def edges(self) -> Array: ...
    def pose(self) -> tuple[float, float, float]: ...
    def set(self, key: str, text: str) -> None: ...
    @property
    def size(self) -> int: ...
    @property
    def drawn(self) -> list[float]: ...
    @property
    def steps(self) -> int: ...
    @property
    def steer_limit(self) -> float: ...
    @property
    def state_hash(self) -> int: ...

class Batch:
    def __init__(self, request: Request, options: dict[str, Any], count: int, threads: int) -> None: ...
    def reset(self, seed: int) -> Array: ...
    def step(self, actions: npt.ArrayLike, wants_truth: bool) -> tuple[Array, Array, Flags, Flags, Array, list[dict[str, Any]]]: ...
    def at(self, index: int) -> Environment: ...
    @property
    def threads(self) -> int: ...
    def __len__(self) -> int: ...

TAPE_OPERATIONS: list[str]
SOLVE_STATUSES: dict[int, tuple[str, str]]

def solve_banded(rows: npt.NDArray[np.int_], columns: npt.NDArray[np.int_], values: Array, right: Array) -> Array: ...

class Interpreter:
    def __init__(self, nx: int, nu: int, parameters: int, horizon: int, ops: npt.NDArray[np.int32], operands: npt.NDArray[np.int32],
                 values: Array, outputs: list[list[int]], is_to_solve: bool) -> None: ...
    def set(self, lower: Array, upper: Array, penalties: Array, is_hard: list[bool], options: dict[str, Any]) -> None: ...
    def solve(self, x0: Array, parameters: Array, x: Array, u: Array, goes_on: bool, iterations: int) -> dict[str, Any]: ...
    def prepare(self) -> bool: ...
    def feedback(self, x0: Array) -> dict[str, Any]: ...
    def solve_many(self, x0: Array, parameters: Array, guess: Array, threads: int) -> dict[str, Any]: ...
    def evaluate(self, function: int, points: Array, parameters: Array, weights: Array, first: int) -> tuple[Array, Array, Array]: ...
    def operations(self) -> list[int]: ...

def entries(shelf: str) -> dict[str, str]: ...
def parameters() -> dict[str, tuple[str, str]]: ...
def faults() -> dict[str, str]: ...
def frame_fields() -> dict[str, str]: ...
def check_processor() -> None: ...
def drive(request: Request, controller: object, plant: object, record: str, wants_frames: bool, step_limit_s: float) -> dict[str, Any]: ...
def verify(file: str, controller: object, step_limit_s: float) -> dict[str, Any]: ...
def read(path: str) -> dict[str, Any]: ...
def limit(request: Request, wants_witness: bool) -> dict[str, Any]: ...
def sweep(plan: str, name: str, file: str, jobs: int) -> dict[str, Any]: ...
def write_page(recording: str, name: str, page: str) -> int: ...
