// SPDX-License-Identifier: MIT
#include "chicane/safety/identify_options.hpp"

#include <array>

namespace chicane::safety {
namespace {

using I = IdentifyOptions;
constexpr std::array kIdentifyOptions{
    option<&I::during_run>("during_run",
                           "Delay, gain and offset of the steering are estimated while the car drives, and "
                           "driven with; the grip by tracking_mpc.learn_grip."),
};

}  // namespace

std::span<const Option> identify_options() noexcept { return kIdentifyOptions; }

}  // namespace chicane::safety
