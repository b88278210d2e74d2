// SPDX-License-Identifier: MIT

#pragma once

#include <memory>
#include <string_view>

#include "chicane/controller/controller.hpp"
#include "chicane/scenario/scenario.hpp"

namespace chicane::test {

/// A controller that the library does not know, and that gives the same answer again and again.
class OwnController : public controller::Controller {
 public:
  explicit OwnController(const model::Command& command = {}) { result_.command = command; }
  [[nodiscard]] const controller::StepResult& step(const model::Measurement&, Deadline) noexcept override {
    return result_;
  }
  void reset() noexcept override {}
  [[nodiscard]] std::string_view name() const noexcept override { return "own"; }

 protected:
  controller::StepResult result_;
};

/// Factory of one for closed loops.
inline Result<std::unique_ptr<controller::Controller>> make_own_controller(const scenario::Scenario&) {
  return std::make_unique<OwnController>(model::Command{.steer = 0.01, .throttle = 0.2});
}

}  // namespace chicane::test
