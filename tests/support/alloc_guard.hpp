// SPDX-License-Identifier: MIT
#pragma once

#include <cstdint>

namespace chicane::test {

/// Counts the heap allocations of this thread while it lives: malloc, calloc, realloc, aligned ones and
/// operator new (under a sanitizer only operator new). Link the test with `PRIVATE chicane_alloc_guard`.
///
///     const AllocationGuard guard;
///     controller.step(now, deadline);
///     EXPECT_EQ(guard.count(), 0);
class AllocationGuard {
 public:
  AllocationGuard() noexcept;
  ~AllocationGuard() noexcept;
  AllocationGuard(const AllocationGuard&) = delete;
  AllocationGuard& operator=(const AllocationGuard&) = delete;

  /// Allocations since construction.
  [[nodiscard]] std::int64_t count() const noexcept;

 private:
  std::int64_t before_;
};

}  // namespace chicane::test
