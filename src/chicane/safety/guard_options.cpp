// SPDX-License-Identifier: MIT
#include "chicane/safety/guard_options.hpp"

#include <array>
#include <string_view>

namespace chicane::safety {
namespace {

using G = GuardOptions;
constexpr std::array<std::string_view, 3> kModes{"on", "observe", "off"};
constexpr std::array<std::string_view, 2> kRoads{"track", "waypoints"};
constexpr std::array<std::string_view, 3> kReceivers{"stop-plan", "brake", "hold"};
constexpr std::array kOptions{
    option<&G::mode>(
        "mode", kModes,
        "Mode. on: without a way to stop, or when sensors fail, the car is stopped on the road; observe: it "
        "is only reported; off: only range and rate of commands are limited."),
    option<&G::road>("road", kRoads,
                     "Source of the road for the guard and for racing: the track, or waypoints."),
    option<&G::half_width>("half_width", unit::kMetre, 0.2, 100,
                           "Assumed from waypoints to edge where the road is known from waypoints."),
    option<&G::receiver>(
        "receiver", kReceivers,
        "Action of the actuators when commands cease: the stop that came with the last one, all "
        "braking with the last steering, or the last command for ever, as the original game."),
    option<&G::margin>("margin", unit::kMetre, 0, 10, "Distance from the edge that the stop at hand keeps."),
    option<&G::blind_time>(
        "blind_time", unit::kSecond, 0, 60,
        "Duration that a silence may last: the stop at hand keeps the road for so long when it is played "
        "by a car that differs a little from the assumed one; 0: not checked."),
};

}  // namespace

std::span<const Option> guard_options() noexcept { return kOptions; }

}  // namespace chicane::safety
