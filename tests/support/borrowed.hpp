// SPDX-License-Identifier: MIT
#pragma once

#include "chicane/controller/controller.hpp"

namespace chicane::test {

/// Passes everything on to a controller that a test keeps for itself.
class Borrowed final : public controller::Controller {
 public:
  explicit Borrowed(controller::Controller& inner) : inner_{inner} {}
  const controller::StepResult& step(const model::Measurement& now, Deadline deadline) noexcept override {
    return inner_.step(now, deadline);
  }
  void note_sent(const model::Command& command) noexcept override { inner_.note_sent(command); }
  void reset() noexcept override { inner_.reset(); }
  [[nodiscard]] std::string_view name() const noexcept override { return inner_.name(); }

 private:
  controller::Controller& inner_;
};

}  // namespace chicane::test
