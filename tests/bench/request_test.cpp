// SPDX-License-Identifier: MIT
// What `chicane bench` passes on, and who starts chicane-bench by hand.
#include "program/request.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "problems/structured_solver.hpp"

namespace chicane::bench {
namespace {

using ::testing::ElementsAre;
using ::testing::HasSubstr;

TEST(Request, HasDefaults) {
  const auto request = parse_request({});
  ASSERT_TRUE(request.has_value());
  EXPECT_EQ(request->instances, 100);
  EXPECT_THAT(request->horizons, ElementsAre(10, 20, 50));
  EXPECT_FALSE(request->is_json);
}

TEST(Request, TakesEveryOption) {
  const auto request = parse_request({"--json", "--instances", "7", "--horizons", "2,200"});
  ASSERT_TRUE(request.has_value()) << request.error().message;
  EXPECT_EQ(request->instances, 7);
  EXPECT_THAT(request->horizons, ElementsAre(2, kLongestHorizon));
  EXPECT_TRUE(request->is_json);
}

TEST(Request, RefusesWhatItCannotMeasure) {
  const std::pair<std::vector<std::string>, std::string> cases[] = {
      {{"--instances", "0"}, "--instances: got 0, expected 1 to 100000"},
      {{"--instances", "many"}, "--instances: got many, expected 1 to 100000"},
      {{"--horizons", "10,201"}, "--horizons: got 201, expected 2 to 200"},
      {{"--horizons", "1"}, "--horizons: got 1, expected 2 to 200"},
      {{"--horizons", ""}, "--horizons: got nothing, expected 2 to 200"},
      {{"--horizons", "10,"}, "--horizons: got nothing, expected 2 to 200"},
      {{"--horizons", "10 20"}, "--horizons: got 10 20, expected 2 to 200"},
      {{"--instances"}, "got --instances, expected --instances N, "},
      {{"--tolerance", "1"}, "got --tolerance, expected --instances N, "},
  };
  for (const auto& [words, message] : cases) {
    const auto request = parse_request(words);
    ASSERT_FALSE(request.has_value()) << message;
    EXPECT_EQ(request.error().code, ErrorCode::kInvalidArgument);
    EXPECT_THAT(request.error().message, HasSubstr(message));
  }
}

}  // namespace
}  // namespace chicane::bench
