// SPDX-License-Identifier: MIT
#include "chicane/base/result.hpp"

#include <gtest/gtest.h>

#include <memory>
#include <string>

namespace chicane {
namespace {

Result<int> half(int number) {
  if (number % 2 != 0)
    return fail(ErrorCode::kInvalidArgument, "number: got " + std::to_string(number) + ", expected even");
  return number / 2;
}

Result<std::string> half_as_text(int number) {
  const Result<int> result = half(number);
  if (!result) return fail(result.error());
  return std::to_string(*result);
}

TEST(Result, HoldsAValue) {
  const Result<int> result = half(8);
  ASSERT_TRUE(result.has_value());
  EXPECT_EQ(*result, 4);
}

TEST(Result, HoldsTheReasonAndPassesItOnUnchanged) {
  const Result<std::string> result = half_as_text(7);
  ASSERT_FALSE(result.has_value());
  EXPECT_EQ(result.error().code, ErrorCode::kInvalidArgument);
  EXPECT_EQ(result.error().message, "number: got 7, expected even");
}

TEST(Result, CarriesWhatCanOnlyBeMoved) {
  Result<std::unique_ptr<int>> result = std::make_unique<int>(3);
  const std::unique_ptr<int> taken = std::move(*result);
  EXPECT_EQ(*taken, 3);
}

TEST(Result, OfNothingIsSuccessOrAReason) {
  const Result<void> good;
  const Result<void> bad = fail(ErrorCode::kIo, "port 4567 is in use");
  EXPECT_TRUE(good.has_value());
  EXPECT_EQ(bad.error().code, ErrorCode::kIo);
}

}  // namespace
}  // namespace chicane
