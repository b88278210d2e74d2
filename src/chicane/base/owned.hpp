// SPDX-License-Identifier: MIT
#pragma once

#include <memory>
#include <utility>

namespace chicane {

/// As std::unique_ptr, but a copy owns a copy: copy_of(const T&), found by argument-dependent lookup, makes
/// it, and may return null where there is none. For parts behind an interface of what is copied as a value.
template <class T>
class Owned {
 public:
  Owned(std::unique_ptr<T> owned) noexcept : owned_{std::move(owned)} {}  // NOLINT(*-explicit-*)
  Owned(const Owned& other) : owned_{other.owned_ ? copy_of(*other.owned_) : nullptr} {}
  Owned(Owned&&) noexcept = default;
  Owned& operator=(const Owned& other) { return *this = Owned(other); }
  Owned& operator=(Owned&&) noexcept = default;
  ~Owned() = default;

  [[nodiscard]] T* get() const noexcept { return owned_.get(); }
  [[nodiscard]] T& operator*() const noexcept { return *owned_; }
  [[nodiscard]] T* operator->() const noexcept { return owned_.get(); }
  explicit operator bool() const noexcept { return owned_ != nullptr; }

 private:
  std::unique_ptr<T> owned_;
};

}  // namespace chicane
