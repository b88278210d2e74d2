// SPDX-License-Identifier: MIT
#include "chicane/protocol/data_folders.hpp"

#include <gtest/gtest.h>

namespace chicane::protocol {
namespace {

TEST(BuildIds, AreThoseOfThisProgramAndOfItsLibraries) {
  const std::string ids = build_ids();
  EXPECT_GE(ids.size(), 40U) << "20 bytes each: this program's, and that of the C library";
  EXPECT_EQ(build_ids(), ids);
}

}  // namespace
}  // namespace chicane::protocol
