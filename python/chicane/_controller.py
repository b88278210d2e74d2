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
        """Computes the command for one measurement, once in each control period (40 ms by default).

        The command acts `seen.delay` seconds after `seen.time`, and is limited to what the car can do.

        Parameters
        ----------
        seen : Measurement
            What the sensors show.

        Returns
        -------
        Command, tuple of two float, or NO_ANSWER
            Steer [rad] and throttle in [-1, 1]. After NO_ANSWER, for instance without waypoints, the guard continues the
            last plan, and brakes.
        """
        raise NotImplementedError(f"{type(self).__name__}.step(seen) is not written yet")

    def reset(self) -> None:
        """Forgets what was learned, because a new run begins; called before the first step."""
