// SPDX-License-Identifier: MIT
// Table of the options of the controller `tracking-mpc`: name, unit, range and meaning. Ranges are chosen,
// unless a constant limits them; meanings are output.
#include <array>

#include "chicane/controller/tracking_mpc.hpp"
#include "chicane/tracking/tracking_problem.hpp"

namespace chicane::controller {
namespace {

using T = TrackingMpcOptions;
constexpr double kHighestWeight = 1e6;  // limit of the weights; chosen, far above useful ones
constexpr std::array kOptions{
    option<&T::horizon_steps>("horizon_steps", unit::kNone, 5, tracking::TrackingProblem::kCapacity,
                              "Steps the plan looks ahead."),
    option<&T::step_length>("step_length", unit::kSecond, 0.01, 0.2, "Time between two points of the plan."),
    option<&T::speed_limit>("speed_limit", unit::kSpeed, 1, 110, "Speed that the plan never exceeds."),
    option<&T::grip_share>("grip_share", unit::kNone, 0.01, 1,
                           "Share of the modelled tyre force the speed plan uses."),
    option<&T::brake_share>("brake_share", unit::kNone, 0.01, 1,
                            "Share of the modelled braking the speed plan uses."),
    option<&T::assumed_half_width>("assumed_half_width", unit::kMetre, 0.2, 20,
                                   "Road on each side of the waypoint line that the centre of mass may use."),
    option<&T::smoothing_width>("smoothing_width", unit::kMetre, 0, 10,
                                "Distance by which the reference line may leave the waypoint line."),
    option<&T::weight_lateral>("weight_lateral", unit::per("1/m²"), 0, kHighestWeight,
                               "Weight of the squared lateral error."),
    option<&T::weight_heading>("weight_heading", unit::per("1/rad²"), 0, kHighestWeight,
                               "Weight of the squared heading error."),
    option<&T::weight_speed>("weight_speed", unit::per("s²/m²"), 0, kHighestWeight,
                             "Weight of the squared speed error."),
    option<&T::weight_progress>("weight_progress", unit::per("s/m"), 0, kHighestWeight,
                                "Worth of speed where a planned lap is raced by; needs weight_speed."),
    option<&T::weight_steer_rate>("weight_steer_rate", unit::per("s²/rad²"), 0, kHighestWeight,
                                  "Weight of the squared steering rate."),
    option<&T::weight_jerk>("weight_jerk", unit::per("s⁶/m²"), 0, kHighestWeight,
                            "Weight of the squared change of acceleration."),
    option<&T::weight_edge>("weight_edge", unit::per("1/m²"), 0, kHighestWeight,
                            "Weight of leaving assumed_half_width, squared."),
    option<&T::weight_slip>("weight_slip", unit::kNone, 0, kHighestWeight,
                            "Weight of slip beyond the useful, normalised and squared."),
    option<&T::racing_line>(
        "racing_line", "Race by the minimum-time line of the track, or of the road learned from waypoints."),
    option<&T::learn_grip>(
        "learn_grip",
        "Race with the grip that the tyres have shown; the first plan has 0.6 of the configured grip."),
    option<&T::slip_share>("slip_share", unit::kNone, 0.1, 2,
                           "Most slip of an axle in the plan to race by, over that of its peak force."),
    option<&T::slide>("slide",
                      "Race with the rear tyres beyond their peak where the closed loop is stable there."),
    option<&T::edge_margin>("edge_margin", unit::kMetre, 0, 5,
                            "Distance that the tyres keep from the edges of a road that is raced on."),
    option<&T::plan_budget>("plan_budget", unit::kSecond, 0.1, 36000,
                            "Work that planning a lap may take, in seconds of a reference core; the best "
                            "plan so far is used then."),
    option<&T::iterations>("iterations", unit::kNone, 1, T::kMostIterations,
                           "Least iterations of the solver in a control step."),
    option<&T::compensate_delay>("compensate_delay",
                                 "Replay the commands in flight; off only to show what happens."),
    option<&T::remember_waypoints>("remember_waypoints", "Close the waypoints seen into a map."),
};

}  // namespace

std::span<const Option> TrackingMpcEntry::options() noexcept { return kOptions; }

}  // namespace chicane::controller
