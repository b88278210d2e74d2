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
    What it raises, a state that is not finite, and a step that takes longer than `step_limit_s` end drive() with that error.

    Attributes
    ----------
    step_s : float
        Length of a step [s], 0.0001 to 0.05.
    front_axle, rear_axle : float
        Distance of the axles from the centre of mass [m], as the `car` of drive() has them.
    steer_limit : float
        Largest angle of the front wheels [rad]; step() gets none above.
    friction_scale : float
        Setting plant_options.friction_scale: tyre forces times this.
    mass_scale : float
        Setting plant_options.mass_scale.
    grip : float
        Share of the tyre forces that faults such as half_grip leave.
    side_acceleration : float
        Push to the left by faults such as side_wind [m/s²].
    """

    step_s: float = 0.005
    front_axle: float
    rear_axle: float
    steer_limit: float
    friction_scale: float = 1.0
    mass_scale: float = 1.0
    grip: float = 1.0
    side_acceleration: float = 0.0

    def step(self, state: CarState, steer: float, throttle: float) -> CarState:
        """Computes the state `step_s` later; called in each physics step.

        Parameters
        ----------
        state : CarState
            State at the beginning of the step.
        steer : float
            Commanded angle of the front wheels [rad], left positive.
        throttle : float
            One pedal in [-1, 1], negative brakes.

        Returns
        -------
        CarState
            State at the end of the step.
        """
        raise NotImplementedError(f"{type(self).__name__}.step(state, steer, throttle) is not written yet")

    def reset(self, state: CarState) -> None:
        """Forgets all but the state, because the car is put somewhere; called before the first step.

        Parameters
        ----------
        state : CarState
            State from which the car continues.
        """
