// SPDX-License-Identifier: MIT
#pragma once

#include <memory>
#include <span>
#include <string_view>

#include "chicane/base/option.hpp"
#include "chicane/base/result.hpp"
#include "chicane/controller/controller.hpp"
#include "chicane/model/vehicle.hpp"

namespace chicane::controller {

/// Holds wheel and pedal where its options say.
struct SteadyOptions {
  double steer = 0.0;     ///< [rad], left positive
  double throttle = 0.3;  ///< 1 is full
};

[[nodiscard]] Result<std::unique_ptr<Controller>> make_steady(const SteadyOptions& options,
                                                              const model::VehicleParams& vehicle);

struct SteadyEntry {
  using Options = SteadyOptions;
  static constexpr std::string_view kName = "hold-steady";
  static constexpr std::string_view kMeaning = "holds wheel and pedal";
  [[nodiscard]] static std::span<const Option> options() noexcept;
  static constexpr auto kMake = &make_steady;
};

}  // namespace chicane::controller
