// SPDX-License-Identifier: MIT
#include "chicane/wire/sparse_log.hpp"

#include <gtest/gtest.h>

#include <string>
#include <vector>

namespace chicane::wire {
namespace {

TEST(SparseLog, SaysEveryLineAndComplainsOnce) {
  std::vector<std::string> lines;
  SparseLog log{[&](std::string_view line) { lines.emplace_back(line); }};
  for (int i = 0; i < 3; ++i) log.say("connected");
  for (int i = 0; i < 100; ++i) log.complain("not a message");  // takes far less than a second
  EXPECT_EQ(lines, (std::vector<std::string>{"connected", "connected", "connected", "not a message"}));
}

TEST(SparseLog, IsQuietWithoutASink) {
  SparseLog log{{}};
  log.say("nobody listens");
  log.complain("nobody listens");
}

}  // namespace
}  // namespace chicane::wire
