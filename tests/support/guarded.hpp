// SPDX-License-Identifier: MIT
#pragma once

#include <memory>
#include <utility>

#include "chicane/safety/guard.hpp"

namespace chicane::test {

/// What was sent in a cycle, and what the guard says of it.
struct Sent : controller::StepResult {
  safety::GuardReport guard;
};

/// A controller inside its guard, asked by one call: what is sent for a measurement, without a rate limit.
class Guarded {
 public:
  Guarded(std::unique_ptr<controller::Controller> controller, const model::VehicleParams& vehicle,
          safety::GuardMode mode = safety::GuardMode::kOff)
      : guard_{std::move(controller), vehicle, {.mode = mode}} {}
  const Sent& step(const model::Measurement& now, Deadline deadline) {
    static_cast<void>(guard_.step(now, deadline, {}, sent_));
    sent_.guard = guard_.report();
    return sent_;
  }
  void reset() { guard_.reset(); }
  [[nodiscard]] std::string_view name() const { return guard_.controller().name(); }

 private:
  safety::Guard guard_;
  Sent sent_;
};

}  // namespace chicane::test
