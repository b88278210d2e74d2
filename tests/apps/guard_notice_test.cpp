// SPDX-License-Identifier: MIT
#include "experiment.hpp"

#include "apps/program_outcome.hpp"
#include "support/chicane_test.hpp"

namespace chicane::apps {
namespace {

using safety::GuardMode;
using ::testing::Eq;

/// Text of a short run on stderr.
std::string said_by_drive(const std::string& options) {
  return test::chicane_program("drive --fast --laps 1 --set time_limit_s=0.2 " + options).err;
}

TEST(GuardNotice, SaysWhatTheOptionsLeaveOpen) {
  EXPECT_EQ(guard_notice({}), "");
  EXPECT_THAT(guard_notice({.mode = GuardMode::kOff}), StartsWith("guard.mode=off: "));
  EXPECT_THAT(guard_notice({.mode = GuardMode::kObserve, .blind_time = 0.0}),
              StartsWith("guard.mode=observe: "));
  EXPECT_THAT(guard_notice({.blind_time = 0.0}), StartsWith("guard.blind_time_s=0: "));
}

TEST(GuardNotice, IsOneLineAtTheStartOfARunButNotBesideJson) {
  EXPECT_THAT(said_by_drive("--set guard.mode=off"), Eq(guard_notice({.mode = GuardMode::kOff}) + "\n"));
  EXPECT_THAT(said_by_drive("--set guard.blind_time_s=0"), Eq(guard_notice({.blind_time = 0.0}) + "\n"));
  EXPECT_EQ(said_by_drive(""), "");
  EXPECT_EQ(said_by_drive("--set guard.mode=off --json"), "");
}

}  // namespace
}  // namespace chicane::apps
