// SPDX-License-Identifier: MIT
#include <gtest/gtest.h>

#include <cstdlib>
#include <memory>

#include "support/alloc_guard.hpp"

namespace {

using namespace chicane;

TEST(AllocationGuard, CountsEveryWayToTheHeap) {
  const test::AllocationGuard guard;
  auto number = std::make_unique<double>(1.0);
  EXPECT_EQ(guard.count(), 1);
#if !defined(__SANITIZE_ADDRESS__) && !defined(__SANITIZE_THREAD__)
  void* volatile raw = std::malloc(3);  // volatile: the compiler may not drop the pair
  EXPECT_EQ(guard.count(), 2);
  std::free(raw);
#endif
}

}  // namespace
