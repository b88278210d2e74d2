// SPDX-License-Identifier: MIT
// A pointer that copies what it points to, for members behind an interface.
#pragma once

#include <memory>
#include <utility>

namespace chicane {

/// Copy of an object by its member function copy().
template <class T>
[[nodiscard]] auto copy_of(const T& owned) -> decltype(owned.copy()) {
  return owned.copy();
}

/// Pointer like std::unique_ptr that can be copied: the copy owns a copy of the object, made by
/// copy_of(const T&). Argument-dependent lookup finds that function for classes without copy(), and it may
/// return null. For classes that are copied as values and have members behind an interface.
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
