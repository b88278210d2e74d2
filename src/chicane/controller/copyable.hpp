// SPDX-License-Identifier: MIT
#pragma once

#include <memory>

#include "chicane/controller/controller.hpp"

namespace chicane::controller {

/// A controller that can be copied with all it knows: the other face of what make_controller() returns. Both
/// answer the same to the same measurements from then on, bit for bit. One that is not Copyable drives like
/// any other; a run with it cannot be copied (run::ClosedLoop::copy()).
class Copyable {
 public:
  [[nodiscard]] virtual std::unique_ptr<Controller> copy() const = 0;

 protected:
  Copyable() = default;
  Copyable(const Copyable&) = default;
  Copyable& operator=(const Copyable&) = default;
  ~Copyable() = default;
};

/// A controller that is Copyable by the copy constructor of `Derived`.
template <class Derived>
class CopyableController : public Controller, public Copyable {
 public:
  [[nodiscard]] std::unique_ptr<Controller> copy() const final {
    return std::make_unique<Derived>(static_cast<const Derived&>(*this));
  }
};

/// Null for a controller that is not Copyable.
[[nodiscard]] inline std::unique_ptr<Controller> copy_of(const Controller& controller) {
  const auto* copyable = dynamic_cast<const Copyable*>(&controller);
  return copyable == nullptr ? nullptr : copyable->copy();
}

}  // namespace chicane::controller
