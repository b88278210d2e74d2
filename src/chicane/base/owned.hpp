// SPDX-License-Identifier: MIT
#pragma once

#include <memory>
#include <utility>

namespace chicane {

/// Pointer like std::unique_ptr whose copy owns a copy, made by copy_of(const T&), which argument-dependent
/// lookup finds and which may return null. For parts behind an interface of objects that are copied as
/// values.
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
