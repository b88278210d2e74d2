// SPDX-License-Identifier: MIT
#include "chicane/wire/endpoint.hpp"
#include "support/chicane_test.hpp"

namespace chicane::wire {
namespace {

struct Said {
  std::vector<std::string> lines;
  SparseLog log{[this](std::string_view line) { lines.emplace_back(line); }};
};

TEST(SparseLog, SaysEveryLineAndEachComplaintOnceASecondInBoundedNumber) {
  Said said;
  for (int i = 0; i < 2; ++i) said.log.say("connected");
  for (int i = 0; i < 100; ++i) said.log.complain("not a message");  // takes far less than a second
  said.log.complain("HTTP/1.1 404");
  EXPECT_THAT(said.lines, ElementsAre("connected", "connected", "not a message", "HTTP/1.1 404"));
  for (int i = 0; i < 100; ++i) said.log.complain("broken " + std::to_string(i));
  EXPECT_EQ(said.lines.size(), static_cast<std::size_t>(2 + SparseLog::kNewLines));
  SparseLog quiet{{}};
  quiet.say("nobody listens");
  quiet.complain("nobody listens");
}

TEST(SparseLog, SaysAReasonOnceWhoeverHasIt) {
  Said said;
  said.log.say_once("polling", "refused 10.0.0.1: polling");
  said.log.say_once("polling", "refused 10.0.0.2: polling");
  said.log.say_once("host", "refused 10.0.0.2: host");
  EXPECT_THAT(said.lines, ElementsAre("refused 10.0.0.1: polling", "refused 10.0.0.2: host"));
  for (int i = 0; i < 100; ++i) said.log.say_once("host " + std::to_string(i), "refused");
  EXPECT_EQ(said.lines.size(), SparseLog::kReasons) << "names are a stranger's";
}

}  // namespace
}  // namespace chicane::wire
