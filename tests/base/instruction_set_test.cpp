// SPDX-License-Identifier: MIT
#include "chicane/base/instruction_set.hpp"

#include <gtest/gtest.h>

#include <array>
#include <string_view>
#include <type_traits>

namespace chicane {
namespace {

constexpr std::array kAll{InstructionSet::kBaseline, InstructionSet::kAvx2, InstructionSet::kAvx512,
                          InstructionSet::kNeon};

TEST(InstructionSet, IsFoundByItsNameWhereTheProcessorHasIt) {
  for (const InstructionSet set : kAll) {
    const Result<InstructionSet> found = instruction_set_by_name(to_string(set));
    ASSERT_EQ(found.has_value(), is_available(set)) << to_string(set);
    if (found) {
      EXPECT_EQ(*found, set);
    }
  }
  EXPECT_FALSE(instruction_set_by_name("sse9"));
  EXPECT_FALSE(instruction_set_by_name(""));
}

TEST(InstructionSet, BaselineIsEverywhereAndTheBestIsAvailable) {
  EXPECT_TRUE(is_available(InstructionSet::kBaseline));
  EXPECT_TRUE(is_available(detect_instruction_set()));
}

TEST(InstructionSet, ArithmeticIsThatOfItsTag) {
  for (const InstructionSet set : kAll) {
    if (!is_available(set)) continue;
    const bool is_fused = with_instructions(set, [](auto arch) { return decltype(arch)::kFused; });
    EXPECT_EQ(arithmetic(set), is_fused ? "fused" : "plain") << to_string(set);
  }
  EXPECT_TRUE(with_instructions(InstructionSet::kBaseline,
                                [](auto arch) { return std::is_same_v<decltype(arch), arch::Baseline>; }));
}

TEST(InstructionSet, TheChosenOneIsTheLastChoice) {
  const InstructionSet before = chosen_instruction_set();
  choose_instruction_set(InstructionSet::kBaseline);
  EXPECT_EQ(chosen_instruction_set(), InstructionSet::kBaseline);
  choose_instruction_set(before);
  EXPECT_EQ(chosen_instruction_set(), before);
}

}  // namespace
}  // namespace chicane
