// SPDX-License-Identifier: MIT
#include "chicane/controller/steady.hpp"

#include <array>

#include "chicane/controller/controller.hpp"
#include "chicane/controller/controller_list.hpp"

namespace chicane::controller {
namespace {

class Steady final : public Controller, public Tunable<SteadyOptions> {
 public:
  explicit Steady(const SteadyOptions& options) { result_.command = {options.steer, options.throttle}; }
  [[nodiscard]] const StepResult& step(const model::Measurement& /*now*/,
                                       Deadline /*deadline*/) noexcept override {
    return result_;
  }
  void configure(const SteadyOptions& options, const model::VehicleParams& /*vehicle*/) noexcept override {
    result_.command = {options.steer, options.throttle};
  }
  void reset() noexcept override {}
  [[nodiscard]] std::string_view name() const noexcept override { return SteadyEntry::kName; }

 private:
  StepResult result_;
};

constexpr std::array kOptions{
    option<&SteadyOptions::steer>("steer", unit::kDegree, -20, 20, "Where the wheel is held."),
    option<&SteadyOptions::throttle>("throttle", unit::kNone, 0, 1, "Where the pedal is held."),
};

}  // namespace

std::span<const Option> SteadyEntry::options() noexcept { return kOptions; }

Result<std::unique_ptr<Controller>> make_steady(const SteadyOptions& options,
                                                const model::VehicleParams& vehicle) {
  if (const auto valid = check<SteadyEntry>(options, vehicle); !valid) return fail(valid.error());
  return std::make_unique<Steady>(options);
}

}  // namespace chicane::controller
