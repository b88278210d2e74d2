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
    """What a controller asks of the car: steer, the angle of the front wheels [rad], left positive, and throttle in
    [-1, 1], negative brakes."""
    steer: float
    throttle: float
    def __init__(self, steer: float = 0.0, throttle: float = 0.0) -> None: ...

class NoAnswer:
    """The type of NO_ANSWER."""

NO_ANSWER: NoAnswer

class Seen:
    """What a controller is told in one cycle, of the car as it is, noise, age and faults of the sensors included."""
    @property
    def time(self) -> float:
        """When it was measured, from the start of the run [s]."""
    @property
    def x(self) -> float:
        """Of the centre of mass in the world [m]."""
    @property
    def y(self) -> float:
        """Of the centre of mass in the world [m]."""
    @property
    def yaw(self) -> float:
        """In the world, counter-clockwise positive [rad]."""
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
        """From `time` until the command acts that is computed now [s]."""
    @property
    def waypoints(self) -> Array:
        """The next points of the road in the world, in driving order, shape (n, 2) [m]; the first may lie behind the car.
        A copy."""
    @property
    def waypoints_ahead(self) -> Array:
        """The same seen from the car, x ahead and y to the left, shape (n, 2) [m]. A copy."""
    @property
    def wheelbase(self) -> float:
        """Of the car [m]."""
    @property
    def steer_limit(self) -> float:
        """Largest angle of the front wheels [rad]."""

class Environment:
    def __init__(self, request: Request, options: dict[str, Any]) -> None: ...
    def reset(self, seed: int) -> None: ...
    def step(self, action: npt.ArrayLike) -> tuple[Array, float, bool, bool, dict[str, Any]]: ...
    def observe(self) -> Array: ...
    def info(self) -> dict[str, Any]: ...
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
    def step(self, actions: npt.ArrayLike) -> tuple[Array, Array, Flags, Flags, Array]: ...
    def at(self, index: int) -> Environment: ...
    def __len__(self) -> int: ...

def entries(shelf: str) -> dict[str, str]: ...
def parameters() -> dict[str, tuple[str, str]]: ...
def faults() -> dict[str, str]: ...
def frame_fields() -> dict[str, str]: ...
def check_processor() -> None: ...
def drive(request: Request, controller: object, record: str, wants_frames: bool, step_limit_s: float) -> dict[str, Any]: ...
def verify(file: str, controller: object, step_limit_s: float) -> dict[str, Any]: ...
def read(path: str) -> dict[str, Any]: ...
def limit(request: Request, wants_witness: bool) -> dict[str, Any]: ...
def quick_limit(request: Request) -> dict[str, Any]: ...
def sweep(plan: str, name: str, file: str, jobs: int) -> dict[str, Any]: ...
def write_page(recording: str, name: str, page: str) -> int: ...
