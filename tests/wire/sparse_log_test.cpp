// SPDX-License-Identifier: MIT
#include "chicane/wire/endpoint.hpp"
#include "support/chicane_test.hpp"

namespace chicane::wire {
namespace {

TEST(SparseLog, SaysEveryLineAndComplainsOnce) {
  std::vector<std::string> lines;
  SparseLog log{[&](std::string_view line) { lines.emplace_back(line); }};
  for (int i = 0; i < 3; ++i) log.say("connected");
  for (int i = 0; i < 100; ++i) log.complain("not a message");  // takes far less than a second
  EXPECT_EQ(lines, (std::vector<std::string>{"connected", "connected", "connected", "not a message"}));
}

TEST(SparseLog, SaysAnotherReasonAtOnceAndBoundsTheirNumber) {
  std::vector<std::string> lines;
  SparseLog log{[&](std::string_view line) { lines.emplace_back(line); }};
  log.complain("connection refused");
  log.complain("HTTP/1.1 404");
  EXPECT_EQ(lines, (std::vector<std::string>{"connection refused", "HTTP/1.1 404"})) << "within one second";
  for (int i = 0; i < 100; ++i) log.complain("broken " + std::to_string(i));
  EXPECT_EQ(lines.size(), static_cast<std::size_t>(SparseLog::kNewLines));
}

TEST(SparseLog, SaysAReasonOnceWhoeverHasIt) {
  std::vector<std::string> lines;
  SparseLog log{[&](std::string_view line) { lines.emplace_back(line); }};
  log.say_once("polling", "refused 10.0.0.1: polling");
  log.say_once("polling", "refused 10.0.0.2: polling");
  log.say_once("host", "refused 10.0.0.2: host");
  EXPECT_EQ(lines, (std::vector<std::string>{"refused 10.0.0.1: polling", "refused 10.0.0.2: host"}));
  for (int i = 0; i < 100; ++i) log.say_once("host " + std::to_string(i), "refused");
  EXPECT_EQ(lines.size(), SparseLog::kReasons) << "names are a stranger's";
}

TEST(SparseLog, IsQuietWithoutASink) {
  SparseLog log{{}};
  log.say("nobody listens");
  log.complain("nobody listens");
}

}  // namespace
}  // namespace chicane::wire
