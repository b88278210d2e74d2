# SPDX-License-Identifier: MIT
"""The base class of simulated cars written in Python."""
from __future__ import annotations

from ._chicane import CarState


class Plant:
    """A simulated car of your own for drive(): derive from it and write step().

        class Cart(ch.Plant):
            step_s = 0.01

            def step(self, state, steer, throttle):
                speed = max(0.0, state.vx + self.step_s * 8.0 * throttle)
                yaw_rate = speed * math.tan(steer) / (self.front_axle + self.rear_axle)
                return ch.CarState(state.x + self.step_s * speed * math.cos(state.yaw), state.y + self.step_s * speed * math.sin(state.yaw),
                                   state.yaw + self.step_s * yaw_rate, vx=speed, yaw_rate=yaw_rate, steer=steer)

    It takes the place of the library's cars in the same loop: with latency, sensors, faults, guard, judge, metrics and recording.
    What it raises, a state that is not finite, and a step that takes longer than `step_limit_s` end drive() with that error."""

    step_s: float = 0.005
    """Length of a step [s], 0.0001 to 0.05."""
    front_axle: float
    """From the centre of mass to the front axle [m]: of the `car` of drive(), as the two below."""
    rear_axle: float
    steer_limit: float
    """Largest angle of the front wheels [rad]; step() gets none above."""
    friction_scale: float = 1.0
    """Setting plant_options.friction_scale: tyre forces times this."""
    mass_scale: float = 1.0
    """Setting plant_options.mass_scale."""
    grip: float = 1.0
    """Of faults, such as half_grip: tyre forces times this, too."""
    side_acceleration: float = 0.0
    """Of faults, such as side_wind: a push to the left [m/s²]."""

    def step(self, state: CarState, steer: float, throttle: float) -> CarState:
        """The state step_s later. steer: angle of the front wheels that is commanded [rad], left positive. throttle: one pedal in
        [-1, 1], negative brakes. Called in each physics step."""
        raise NotImplementedError(f"{type(self).__name__}.step(state, steer, throttle) is not written yet")

    def reset(self, state: CarState) -> None:
        """The car is put at a state: forget what else there was. Called before the first step."""
