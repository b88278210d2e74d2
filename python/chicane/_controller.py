# SPDX-License-Identifier: MIT
"""The base class of controllers written in Python."""
from __future__ import annotations

from ._chicane import Command, Measurement, NoAnswer


class Controller:
    """A controller of your own for drive() and verify(): derive from it and write step().

        class Chase(ch.Controller):
            def step(self, seen):
                if len(seen.waypoints) < 3:
                    return ch.NO_ANSWER
                x, y = seen.waypoints_ahead[2]
                curvature = 2 * y / max(1.0, x * x + y * y)
                return ch.Command(steer=seen.wheelbase * curvature, throttle=0.2 * (10 - seen.speed))

    It drives in the same loop as the library's controllers: with latency, faults, guard, metrics and recording. After an
    exception, a command that is not finite, or a step that takes longer than `step_limit_s`, it is not called any more,
    and the guard stops the car; Run.error has the traceback.
    """

    def step(self, seen: Measurement) -> Command | tuple[float, float] | NoAnswer:
        """The command for one measurement: Command(steer [rad], throttle [-1, 1]), or these two as a tuple.

        Called once in each control period (40 ms unless said otherwise). The command acts `seen.delay` seconds after
        `seen.time`. It is limited to what the car can do. NO_ANSWER where there is none to give, such as without waypoints:
        the guard then continues the last plan, and brakes."""
        raise NotImplementedError(f"{type(self).__name__}.step(seen) is not written yet")

    def reset(self) -> None:
        """A new run begins: forget what was learned. Called before the first step."""
